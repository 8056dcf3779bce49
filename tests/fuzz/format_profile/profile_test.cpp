#include "formats/profile/profile.h"
#include "support/fuzz.h"

namespace suite::format_profile_profile_test {

namespace {
void check(std::span<const std::byte> b) {
  const ReadProfile r = parse_profile({reinterpret_cast<const char*>(b.data()), b.size()}, "p.csv");
  check_profile(r.profile);
}
}  // namespace

TEST(FuzzProfile, Table) {
  test::fuzz(
      test::bytes_of("height_km,temperature_c,pressure_hpa,relative_humidity_percent,o3_ppmv\n0,20,1013,60,0.02\n"
                     "1, 10, 900,50,0.03 # second\n10,-50,265,20,0.1\n"),
      check, 11, test::kMutations,
      {"height_m", "pressure_pa", "dew_point_c", "h2o_g_per_kg", "n2_fraction", "-273.15", "1e300", "nan", ",", "#"});
}

TEST(FuzzProfile, Sounding) {
  test::fuzz(test::bytes_of("------\n   PRES   HGHT   TEMP   DWPT   RELH\n    hPa     m      C      C      %\n------\n"
                            " 1000.0    113                     \n  925.0    790   12.4    9.4     82\n"
                            "  850.0   1500   10.0    2.0     58\n  500.0   5740  -14.7  -40.7      9\n"
                            "  100.0  16260  -62.1              \n\nStation\n"),
             check, 12, test::kMutations, {"       ", "-243.5 ", "  1e30 ", "\n", "PRES", "----"});
}

}  // namespace suite::format_profile_profile_test
