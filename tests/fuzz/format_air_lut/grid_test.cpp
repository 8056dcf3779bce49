#include "formats/air_lut/air_lut.h"
#include "support/fuzz.h"

namespace suite::format_air_lut_grid_test {

namespace {
void check(std::span<const std::byte> b) {
  AirSpec air;
  air.profile = standard_profile("us_standard");
  air.aerosol.emplace();
  const LutRequest request = parse_lut_request({reinterpret_cast<const char*>(b.data()), b.size()}, "grid.yaml");
  located_in(request, [&] {
    const LutTable table = make_lut(air, {Band::gaussian("b", 0.55, 0.01)}, request.axes);
    return air_of_state(air, table, table.states() - 1);
  });
}
}  // namespace

TEST(FuzzAirLut, Grid) {
  test::fuzz(
      test::bytes_of(
          "air_lut: 1\nsensor: eye\nH2OSTR: [0.5, 1.5, 3]\nAOT550: 0.2\nO3: [250, 400]\nsurface_elevation_km: [0, 1]\n"
          "observer_altitude_km: 20\nobserver_zenith: [0, 30]\nsolar_zenith: [20, 40]\nrelative_azimuth: [0, 90]\n"
          "widest_bin_nm: 5\nstreams: 8\ncheck: false\n"),
      check, 21, test::kMutations, {"1e300", "nan", "-1", "[]", "[0, 0]", ": [", "H2OSTR", "solar_zenith", "9.9"});
}

}  // namespace suite::format_air_lut_grid_test
