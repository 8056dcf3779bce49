// A crater whose floor the sun never reaches, through both programs: the closed form of expect.md, from pictures taken
// all day with temperatures that were found once.
#include <cmath>

#include "base/files.h"
#include "motion/ephemeris.h"
#include "motion/scene_frame.h"
#include "spectral/planck.h"
#include "support/sample_kit.h"

namespace suite::polar_crater_test {
namespace {

constexpr int kPictures = 8, kSide = 40;
constexpr double kAlbedo = 0.12, kEmissivity = 0.95;

class PolarCrater : public SampleScene {
 protected:
  PolarCrater() : SampleScene("polar_crater") {}
};

// K^4. Source: A. P. Ingersoll, T. Svitek, B. C. Murray, Icarus 100, 40-47, 1992.
double shadow_fourth(double sine) {
  const double rim = 2 * std::atan(0.4), s = (1 - std::cos(rim)) / 2;
  const double P = 1361 * sine * std::pow(std::sin(rim), 2) / 4, taken = P * (1 - kAlbedo) / (1 - kAlbedo * s);
  return taken * (kAlbedo + kEmissivity / (1 - s)) / (kEmissivity * kStefanBoltzmann);
}

TEST_F(PolarCrater, TheShadowIsAsWarmAsItsWallMakesIt) {
  const std::string small =
      strf(" --set sensors.0.columns=%d --set sensors.0.rows=%d --set sensors.0.gsd_m=6 --set sensors.0.paths=1", kSide,
           kSide);
  const std::string few = " --set heat.elements=1200 --set heat.paths=256 --set heat.step_s=1800";
  render("out", "--heat-only" + few);
  const SceneFrame frame({88, 0, 0});
  const Clock clock(parse_iso8601("2020-03-28T00:00:00Z"));
  double found = 0, exact = 0, sunlit = 0, hours = 0, light = 0, pixels = 0;
  for (int k = 0; k < kPictures; ++k) {
    const double t = 86400.0 * k / kPictures;
    render("at", strf("--heat out/heat.h5 --set sensors.0.time_s=%g", t) + few + small);
    exact += shadow_fourth(sun_at(frame, {}, clock.at(t)).direction.z) / kPictures;
    const EnviImage image(folder_ / "at/above_truth.img");
    const std::vector<double> all = image.read_lines(0, kSide);
    const size_t bands = image.header().bands;
    ASSERT_EQ(bands, 8u);
    for (size_t p = 0; p < all.size(); p += bands) {
      const double kelvin = all[p], from_middle = std::hypot(all[p + 5], all[p + 6]);
      sunlit = std::fmax(sunlit, kelvin);
      if (from_middle > 40) continue;
      found += std::pow(kelvin, 4), ++pixels;
      hours = std::fmax(hours, all[p + 2]), light += all[p + 3];
      EXPECT_GT(all[p + 4], 1) << "the wall's infrared";
    }
  }
  const double kelvin = std::pow(found / pixels, 0.25), expected = std::pow(exact, 0.25);
  std::printf("shadow: %.2f K of %.2f K, lit ground up to %.0f K\n", kelvin, expected, sunlit);
  EXPECT_NEAR(expected, 117.1, 0.3);
  EXPECT_NEAR(kelvin, expected, 1.5);
  EXPECT_EQ(hours, 0);
  EXPECT_GT(light / pixels, 0.2) << "sunlight that the wall scatters";
  EXPECT_GT(sunlit, 300);
}

// Two millimetres of dust alone, at a latitude where the sun sets steeply: within a step of an hour they would lose
// more heat than they hold, and the search ended with an element that emits 0 W/m2.
TEST_F(PolarCrater, ASkinOfDustLosesItsSun) {
  std::string weather = read_text(folder_ / "space.csv");
  weather.replace(weather.find("site: 88"), 8, "site: 20");
  write_file(folder_ / "space.csv", std::string_view(weather));
  const CommandResult r =
      run("scene-prep scene.yaml -o scene.h5 --set 'materials.regolith.thermal={layers: [{thickness_m: 0.002, "
          "density_kg_m3: 1100, specific_heat_j_kg_k: 400, conductivity_w_m_k: 0.001}]}' --set origin.latitude_deg=20");
  ASSERT_EQ(r.code, 0) << r.err;
  render("skin", "--heat-only --set heat.elements=60 --set heat.paths=64 --set heat.step_s=3600");
  EXPECT_TRUE(file_exists(folder_ / "skin/heat.h5"));
}

}  // namespace
}  // namespace suite::polar_crater_test
