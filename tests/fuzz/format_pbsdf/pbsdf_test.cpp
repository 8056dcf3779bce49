#include "formats/pbsdf/pbsdf.h"
#include "sqt_fit/mueller_fit.h"
#include "support/fuzz.h"
#include "support/mueller_formula.h"

namespace suite::format_pbsdf_pbsdf_test {

namespace {
void parse_and_fit(std::span<const std::byte> bytes) {
  const auto brdf = parse_pbsdf(bytes, "x.pbsdf");
  if (!(sqt::fit_mueller(*brdf, 0.1).table->least() >= -1e-9)) throw std::runtime_error("a matrix that cannot exist");
}
}  // namespace

TEST(FuzzPbsdf, Small) {
  test::MuellerFormula formula;
  formula.theta_h_deg = {0, 30, 90};
  formula.theta_d_deg = {0, 60};
  formula.phi_d_deg = {0, 90, 180};
  formula.wavelength_nm = {500};
  test::fuzz(formula.pbsdf().build(), parse_and_fit, 1, test::kMutations);
}

}  // namespace suite::format_pbsdf_pbsdf_test
