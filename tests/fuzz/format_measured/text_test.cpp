#include "formats/brdf_csv/brdf_csv.h"
#include "formats/cornell/cornell.h"
#include "formats/mueller_csv/mueller_csv.h"
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
TEST(FuzzMuellerCsv, Text) {
  std::string text = "# convention: mitsuba\ntheta_h_deg,theta_d_deg,phi_d_deg,wavelength_um";
  for (int i = 1; i <= 4; ++i)
    for (int j = 1; j <= 4; ++j) text += strf(",m%d%d", i, j);
  for (const char* at : {"0,0,0", "0,50,0", "40,0,0", "40,50,0", "0,0,180", "0,50,180", "40,0,180", "40,50,180"})
    text += std::string("\n") + at + ",0.5,0.3,0.1,0,0,0.1,0.2,0,0,0,0,0.2,0,0,0,0,0.1";
  text += "\n80,0,0,0.5,nan,0.1,0,0,0.1,0.2,0,0,0,0,0.2,0,0,0,0,0.1";
  test::fuzz(
      test::bytes_of(text),
      [](std::span<const std::byte> b) {
        const auto brdf = parse_mueller_csv(text_of(b), "f.csv");
        std::vector<double> f(brdf->info().wavelength_um.size());
        brdf->value(dir_from_angles(0.4, 0.1), dir_from_angles(1.1, -2), f);
        for (const double x : f)
          if (!(x >= 0)) throw std::runtime_error("a value that is negative or not a number came out");
      },
      6, test::kMutations);
}
TEST(FuzzCsv, Text) {
  test::fuzz(
      test::bytes_of("# name: x\n# quantity: "
                     "bsdf\ntheta_o_deg,phi_o,theta_i,phi_i,wavelength_um,value\n30,0,0.5,3.1,0.5,0.1\n30,0,0.6,3.1,0."
                     "5,0.2\n30,0,0.5,3.1,0.6,0.1\n"),
      [](std::span<const std::byte> b) { check(parse_brdf_csv(text_of(b), "f.csv")); }, 5, test::kMutations);
}

}  // namespace suite::format_measured_text_test
