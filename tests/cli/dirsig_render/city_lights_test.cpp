// City lights from a radiance map: seen from above pixel by pixel, as light by a closed form, from a GeoTIFF as from
// the scene's own axes; what is refused.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "base/files.h"
#include "formats/envi/envi.h"
#include "formats/raster/raster_write.h"
#include "support/run_command.h"

namespace suite::city_lights_test {
namespace {

using testing::AllOf;
using testing::HasSubstr;

constexpr const char* kSensors = R"(sensors:
  - {kind: orthographic, name: map, columns: 4, rows: 4, gsd_m: 10, center_m: [0, 0], paths: 4, bands: [&b {name: dnb, center_um: 0.7, fwhm_um: 0.4, shape: rectangular}]}
  - {kind: point, name: meter, bands: [*b], paths: 16384, collectors: [{name: Eu, quantity: irradiance, position_m: [0, 0, 10], normal: [0, 0, -1]}]}
)";

class CityLights : public testing::Test {
 protected:
  CityLights() {
    write_file(folder_ / "scene.yaml",
               "scene: 1\norigin: {latitude_deg: 50.005, longitude_deg: 8.005}\nmaterials: {town: {model: lambert, "
               "reflectance: 0}}\nobjects: {town: {plane: {width: 40, depth: 40}, material: town}}\nworld: [{place: "
               "town}]\n");
    run_command("cd '" + folder_.path() + "' && " SUITE_BIN_DIR "/scene-prep scene.yaml -o scene.h5 -q");
    write_file(folder_ / "m.pgm", "P2\n4 4\n255\n0 0 0 0\n0 100 0 0\n0 0 0 50\n0 0 0 0\n");
  }
  CommandResult render(const std::string& map, const std::string& more = {}) {
    write_file(folder_ / "sim.yaml",
               "scene: scene.h5\nlamps: [{kind: surface, material: town, radiance: {lamp: led_4000}, map: {" + map +
                   "}}]\n" + kSensors + more);
    return run_command("cd '" + folder_.path() + "' && " SUITE_BIN_DIR "/dirsig-render sim.yaml -o out");
  }
  std::vector<double> seen() { return EnviImage(folder_ / "out/map.img").read_all(); }
  double irradiance() {
    const std::string csv = read_text(folder_ / "out/meter.csv");
    return std::stod(csv.substr(csv.find("0.7,", csv.find("Eu,")) + 4));
  }
  TempFolder folder_;
};

// Light of a square of even radiance on a level plane above it, by the midpoint rule over its area.
double from_square(double x0, double y0, double radiance) {
  constexpr int n = 200;
  constexpr double height = 10, side = 10;
  double sum = 0;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      const double x = x0 + (i + 0.5) * side / n, y = y0 + (j + 0.5) * side / n, r2 = x * x + y * y + height * height;
      sum += radiance * height * height / (r2 * r2) * (side / n) * (side / n);
    }
  return sum;
}

// 100 and 50 units of 0.01 W/(m2 sr) within 0.5 to 0.9 um: 2.5 and 1.25 W/(m2 sr um) in that band.
TEST_F(CityLights, AreSeenAndShine) {
  const CommandResult r = render("file: m.pgm, scale: 0.01, local: {origin: [-20, 20], gsd: 10}");
  ASSERT_EQ(r.code, 0) << r.err;
  const std::vector<double> expected{0, 0, 0, 0, 0, 2.5, 0, 0, 0, 0, 0, 1.25, 0, 0, 0, 0}, found = seen();
  ASSERT_EQ(found.size(), expected.size());
  for (size_t i = 0; i < found.size(); ++i) EXPECT_NEAR(found[i], expected[i], 1e-4 * 2.5) << i;
  const double e = from_square(-10, 0, 2.5) + from_square(10, -10, 1.25);
  EXPECT_NEAR(irradiance(), e, 0.005 * e);  // five standard errors
}

// One pixel of 0.01 degrees with -9, then one of 4e6 nW/(cm2 sr): the second holds the scene, 0.04 W/(m2 sr) by the
// units of VIIRS.
TEST_F(CityLights, FromAGeoTiff) {
  FloatRaster raster;
  raster.width = 2, raster.height = 1;
  raster.bands = {{"radiance"}};
  raster.placement = RasterPlacement{7.99, 50.01, 0.01, 0.01, std::nullopt, 4326, true};
  write_float_tiff(folder_ / "m.tif", raster, std::vector<float>{-9, 4000});
  const CommandResult r = render("file: m.tif");
  ASSERT_EQ(r.code, 0) << r.err;
  EXPECT_THAT(r.err, HasSubstr("1 of 2 values are negative"));
  for (const double v : seen()) EXPECT_NEAR(v, 0.04 / 0.4, 1e-5);
}

TEST_F(CityLights, Refused) {
  const std::pair<const char*, const char*> faults[] = {
      {"file: no.pgm, local: {origin: [-20, 20], gsd: 10}", "no.pgm"},
      {"file: m.pgm", "GeoTIFF"},
      {"file: m.pgm, local: {origin: [-20, 20], gsd: 0}", "no size"},
      {"file: m.pgm, local: {origin: [-20], gsd: 1}", "two numbers"},
      {"file: m.pgm, band_um: [0.9, 0.5], local: {origin: [-20, 20], gsd: 10}", "lower one first"},
      {"file: m.pgm, scale: -1, local: {origin: [-20, 20], gsd: 10}", "scale"},
      {"file: m.pgm, no_data: 0, gsd: 1, local: {origin: [-20, 20], gsd: 10}", "gsd"},
  };
  for (const auto& [map, expected] : faults) {
    const CommandResult r = render(map);
    EXPECT_NE(r.code, 0) << map;
    EXPECT_THAT(r.err, AllOf(HasSubstr("sim.yaml:2"), HasSubstr(expected))) << map;
  }
  write_file(folder_ / "m.pgm", "P2\n2 1\n255\n0 0\n");
  EXPECT_THAT(render("file: m.pgm, local: {origin: [-20, 20], gsd: 10}").err, HasSubstr("nothing glows"));
  write_file(folder_ / "m.pgm", "P2\n2 1\n255\n0 9\n");
  EXPECT_THAT(
      render("file: m.pgm, local: {origin: [-20, 20], gsd: 10}", "periodic: {origin_m: [-20, -20], size_m: [40, 40]}\n")
          .err,
      HasSubstr("repeats itself"));
}

// A glow of far cities is light of air: beside the simulation's own air it is refused, not dimmed twice.
TEST_F(CityLights, AirBesideTheGlowOfCitiesIsRefused) {
  const std::string map = "file: m.pgm, local: {origin: [-20, 20], gsd: 10}",
                    glow =
                        "night_sky: {time_utc: 2026-03-20T22:00:00Z, city_glow: [{azimuth_deg: 90, spectrum: {lamp: "
                        "sodium}, population: 1e5, distance_km: 20}]}\n";
  EXPECT_EQ(render(map, glow).code, 0);
  const CommandResult r = render(map, glow + "atmosphere: {}\n");
  EXPECT_NE(r.code, 0);
  EXPECT_THAT(r.err, AllOf(HasSubstr("sim.yaml:"), HasSubstr("city_glow is the light of air itself")));
}

}  // namespace
}  // namespace suite::city_lights_test
