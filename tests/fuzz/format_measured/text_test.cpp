#include "formats/brdf_csv/brdf_csv.h"
#include "formats/cornell/cornell.h"
#include "formats/samples/samples.h"
#include "support/fuzz.h"

namespace suite::format_measured_text_test {

namespace {
std::string_view text_of(std::span<const std::byte> b) { return {reinterpret_cast<const char*>(b.data()), b.size()}; }
void check(const sqt::Samples& s) {
  const size_t channels = s.info.wavelength_um.size();
  if (s.out.size() != s.in.size() || s.value.size() != s.in.size() * channels)
    throw std::runtime_error("sizes do not fit");
  for (size_t i = 0; i < s.in.size(); ++i)
    if (!(std::fabs(length(s.in[i]) - 1) < 1e-9 && std::fabs(length(s.out[i]) - 1) < 1e-9))
      throw std::runtime_error("not a unit vector");
}
}  // namespace

TEST(FuzzSamples, Text) {
  test::fuzz(
      test::bytes_of(
          "RAWBS10A a b\n2 0.5 0.6\n2 0 0.5\n0 0 0 1 1 2\n1 0.6 0.64 0.48 nan 3\n1 0.6 -0.64 -0.48 1e-3 3\n"),
      [](std::span<const std::byte> b) { check(parse_samples(text_of(b), "f.txt")); }, 3, test::kMutations);
}
TEST(FuzzCornell, Text) {
  test::fuzz(
      test::bytes_of("# note\n3\n400 500\n600\n0.5 0 0.3 0.7 1 2 3\n0.5 0 0.3 1.5 4 5 6\n"),
      [](std::span<const std::byte> b) { check(parse_cornell(text_of(b), "f.brdf")); }, 4, test::kMutations);
}
TEST(FuzzCsv, Text) {
  test::fuzz(
      test::bytes_of("# name: x\n# quantity: "
                     "bsdf\ntheta_o_deg,phi_o,theta_i,phi_i,wavelength_um,value\n30,0,0.5,3.1,0.5,0.1\n30,0,0.6,3.1,0."
                     "5,0.2\n30,0,0.5,3.1,0.6,0.1\n"),
      [](std::span<const std::byte> b) { check(parse_brdf_csv(text_of(b), "f.csv")); }, 5, test::kMutations);
}

}  // namespace suite::format_measured_text_test
