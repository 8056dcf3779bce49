// Seeded mutations of JSON of MODTRAN 6: runs, or one Error with a place.
#include <gtest/gtest.h>

#include "formats/tape7/modtran6.h"
#include "tests/support/fuzz.h"

namespace suite::format_tape7_modtran6_test {
namespace {

TEST(Modtran6Fuzz, Cases) {
  test::fuzz(
      test::bytes_of(
          R"({"MODTRAN": [{"MODTRANINPUT": {"SPECTRAL": {"V1": 1000, "V2": 1002, "DV": 2}, "GEOMETRY": {"ITYPE": 2,
"H1ALT": 3, "H2ALT": 1, "OBSZEN": 120, "HRANGE": 4, "IPARM": 12, "PARM1": 90, "PARM2": 40}}, "MODTRANOUTPUT": {"SPECTRA":
{"RADIANCE": {"TOT_TRANS": [0.5, 0.6], "THRML_EM": [1, 2], "MULT_SCAT": [1, 1], "TOTAL_RAD": [3, 4]}}}}]})"),
      [](std::span<const std::byte> b) {
        for (const Tape7Block& run : parse_modtran6({reinterpret_cast<const char*>(b.data()), b.size()}, "f.json"))
          for (const Tape7Column& c : run.columns) ASSERT_EQ(c.values.size(), run.wavenumber.size());
      },
      14, test::kMutations,
      {"FREQ", "1e300", "-1", "[", "{", "null", "IRRADIANCE", "TRANSMITTANCE", "\"DV\": 1e-9", "nan"});
}

}  // namespace
}  // namespace suite::format_tape7_modtran6_test
