// Pictures that nobody can use are told: one warning that names the sensor, the cause and the cure; before rendering
// where that can be known. They used to end with exit code 0 and no word.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/error.h"
#include "base/files.h"
#include "support/programs_kit.h"

namespace suite::useless_pictures_test {
namespace {

using testing::HasSubstr;

const char* const kScene = R"(scene: 1
origin: {latitude_deg: 43.1, longitude_deg: -77.6, height_m: 120}
materials:
  ground: {model: lambert, reflectance: {points: [[0.4, 0.2], [1.0, 0.3]], outside: hold}}
  black: {model: lambert, reflectance: {points: [[0.4, 0], [1.0, 0]], outside: hold}}
objects:
  plane: {plane: {width: 400, depth: 400}, material: ground}
  board: {box: {x0: -2, y0: -2, z0: 0, x1: 2, y1: 2, z1: 3}, material: ground}
  hole: {box: {x0: -20, y0: -20, z0: 0, x1: 20, y1: 20, z1: 1}, material: black}
world:
  - {place: plane}
  - {place: board, translate: [4, 0, 0]}
  - {place: hole, translate: [100, 0, 0]}
)";
// A board alone.
const char* const kBoards = R"(scene: 1
origin: {latitude_deg: 43.1, longitude_deg: -77.6, height_m: 120}
materials:
  ground: {model: lambert, reflectance: 0.2}
objects:
  board: {box: {x0: -2, y0: -2, z0: 0, x1: 2, y1: 2, z1: 3}, material: ground}
world:
  - {place: board, translate: [4, 0, 0]}
)";
const std::string kDay = "sun: {direction: {zenith_deg: 45, azimuth_deg: 90}, irradiance: 1000}\n";
const std::string kSky = "sky: {radiance: 50}\n";

std::string camera(const std::string& position, const std::string& look_at, double band_um = 0.6) {
  return strf(
      "sensors:\n  - {kind: frame_camera, name: eye, columns: 8, rows: 6, pitch_um: 100, focal_length_mm: 50, "
      "position_m: "
      "%s, look_at_m: %s, paths: 4, bands: [{name: pan, center_um: %g, fwhm_um: 0.05, shape: rectangular}]}\n",
      position.c_str(), look_at.c_str(), band_um);
}

class UselessPictures : public ProgramsTest<UselessPictures> {
 protected:
  static void SetUpTestSuite() {
    make_folder();
    prepare(kScene);
    prepare(kBoards, "boards");
  }
  // What the renderer says on standard error; it ends well.
  static std::string said(const std::string& text, const std::string& scene = "scene") {
    write_file(*folder_ / "sim.yaml", std::string_view("scene: " + scene + ".h5\n" + text));
    const CommandResult r = run("dirsig-render sim.yaml -o out");
    EXPECT_EQ(r.code, 0) << r.err;
    return r.err;
  }
  static size_t warnings(const std::string& text) {
    size_t n = 0;
    for (size_t at = text.find("warning:"); at != std::string::npos; at = text.find("warning:", at + 1)) ++n;
    return n;
  }
  // One warning, with these words, before or after the rendering.
  static void expect_one(const std::string& text, const std::vector<std::string>& words, bool before,
                         const std::string& scene = "scene") {
    const std::string err = said(text, scene);
    EXPECT_EQ(warnings(err), 1u) << err;
    EXPECT_THAT(err, HasSubstr("warning: sensor 'eye': "));
    for (const std::string& w : words) EXPECT_THAT(err, HasSubstr(w));
    EXPECT_EQ(err.find("warning:") < err.find("wrote out/eye.img"), before) << err;
  }
};

TEST_F(UselessPictures, GoodOnesAreNotDoubted) {
  EXPECT_EQ(warnings(said(kDay + kSky + camera("[0, -20, 30]", "[0, 0, 0]"))), 0u);
  // On the ground, under a roof, looking at the sky, at dawn under a sky, and a board that fills a tenth of a pixel.
  EXPECT_EQ(warnings(said(kDay + kSky + camera("[0, -20, 0.1]", "[0, 0, 1]"))), 0u);
  EXPECT_EQ(warnings(said(kDay + kSky + camera("[0, -20, 1]", "[0, -25, 30]"))), 0u);
  EXPECT_EQ(warnings(said("sun: {direction: {zenith_deg: 95, azimuth_deg: 90}, irradiance: 1000}\n" + kSky +
                          camera("[0, -20, 30]", "[0, 0, 0]"))),
            0u);
  EXPECT_EQ(warnings(said(kDay + kSky + camera("[4, 0.001, 2000]", "[4, 0, 0]"), "boards")), 0u);
}

TEST_F(UselessPictures, UnderTheGround) {
  expect_one(kDay + camera("[0, -20, -30]", "[0, 0, -10]"),
             {"(0, -20, -30) m, 30 m under the surface 'ground'", "raise it", "[DR107]"}, true);
  // In a solid.
  expect_one(kDay + kSky + camera("[4, 0, 1]", "[4, 1, 1]"), {"2 m under the surface 'ground'"}, true, "boards");
  expect_one(kDay + kSky + "earth: {material: ground}\n" + camera("[0, -20, -30]", "[0, 0, -10]"),
             {"29 m inside the Earth"}, true);
}

TEST_F(UselessPictures, NothingIsHit) {
  expect_one(kDay + kSky + camera("[0, 3000, 300]", "[0, 3400, 100]"),
             {"looks past the scene", "(2, -2, 0) m", "[DR108]"}, true, "boards");
  // Beside the scene, so near that rays have to tell.
  expect_one(kDay + kSky + camera("[-20, 0, 30]", "[1, 0, 0]"),
             {"none of its paths met anything", "picture is black", "[DR109]"}, false, "boards");
  expect_one(kDay + "sky: {radiance: 50, full_sphere: true}\n" + camera("[-20, 0, 30]", "[1, 0, 0]"),
             {"none of its paths met anything: the picture shows the sky alone"}, false, "boards");
}

TEST_F(UselessPictures, NightWithoutASky) {
  expect_one(
      "sun: {direction: {zenith_deg: 100, azimuth_deg: 90}, irradiance: 1000}\n" + camera("[0, -20, 30]", "[0, 0, 0]"),
      {"the sun is 10.0 degrees below the horizon and nothing else shines", "give a time of day", "[DR101]"}, true);
  expect_one("sun: {direction: {time_utc: \"2026-06-21T05:00:00Z\"}, irradiance: 1000}\n" +
                 camera("[0, -20, 30]", "[0, 0, 0]"),
             {"degrees below the horizon at 2026-06-21T05:00:00Z"}, true);
}

// With air the Sun lights it from below the horizon, unless an endless plane is in between: that was noise about 0.
TEST_F(UselessPictures, TwilightOverAnEndlessPlane) {
  std::string endless = kScene;
  endless.replace(endless.find("width: 400, depth: 400"), 22, "width: 0, depth: 0");
  prepare(endless, "endless");
  const std::string dusk =
      "sun: {direction: {zenith_deg: 93, azimuth_deg: 90}}\natmosphere: {profile: us_standard, gases: none}\n" +
      camera("[0, -20, 30]", "[0, 0, 0]");
  expect_one(
      dusk,
      {"3.0 degrees below the horizon", "the endless plane 'plane' shades all air", "give the plane a size", "[DR102]"},
      true, "endless");
  EXPECT_EQ(warnings(said(dusk)), 0u);
  std::string night = dusk;
  expect_one(night.replace(night.find("zenith_deg: 93"), 14, "zenith_deg: 97"),
             {"7.0 degrees below the horizon", "band 'pan' gets what is left of twilight", "[DR101]"}, true);
}

TEST_F(UselessPictures, DegreesForMetres) {
  expect_one(
      kDay + kSky + camera("[43.101, -77.602, 300]", "[0, 0, 0]"),
      {"(43.101, -77.602, 300) m", "latitude and longitude (43.1000, -77.6000 degrees)", "latitude_deg", "[DR106]"},
      true);
  expect_one(kDay + kSky + camera("[-77.602, 43.101, 300]", "[0, 0, 0]"), {"longitude and latitude"}, true);
  expect_one(
      kDay + kSky +
          "sensors:\n  - kind: platform\n    name: eye\n    motion: {kind: straight, position_m: [43.1, -77.6, 90], "
          "heading_deg: 0, speed_m_s: 10}\n    tasks: [{start: 0}]\n    instruments:\n      - {focal_length_mm: 50, "
          "arrays: [{columns: 6, rows: 4, pitch_um: 50, paths: 1, bands: [{name: pan, center_um: 0.6, fwhm_um: "
          "0.1}]}]}\n",
      {"latitude and longitude"}, true);
}

TEST_F(UselessPictures, BandsOutside) {
  // No light there, nothing warm; and light, but no spectrum of a surface.
  expect_one(
      "sun: {direction: {zenith_deg: 45, azimuth_deg: 90}, irradiance: {wavelength_um: [0.3, 2], value: [1000, "
      "1000], outside: zero}}\n" +
          camera("[0, -20, 30]", "[0, 0, 0]", 10),
      {"no source sends light in band 'pan' (10 um)", "[DR103]"}, true);
  expect_one(kDay + camera("[0, -20, 30]", "[0, 0, 0]", 1.6),
             {"band 'pan' (1.6 um) lies beyond the ends of all spectra of the scene, of which the nearest is at 1 um",
              "[DR104]"},
             true);
}

// A display colour says nothing beyond the visible.
TEST_F(UselessPictures, BandsBeyondUpliftedColours) {
  std::string scene = kBoards;
  scene.replace(scene.find("reflectance: 0.2"), 16,
                "reflectance: {points: [[0.38, 0.2], [0.78, 0.3]], outside: hold}, "
                "description: uplifted from a display colour 0.2 0.2 0.3");
  prepare(scene.c_str(), "guess");
  const auto told = [&](double um) { return said(kDay + camera("[4, -1, 50]", "[4, 0, 1]", um), "guess"); };
  EXPECT_THAT(told(0.8), HasSubstr("band 'pan' (0.8 um) reaches beyond 0.38 to 0.78 um, where 1 materials have "
                                   "reflectances uplifted from display colours (the first is 'ground')"));
  EXPECT_THAT(told(0.8), HasSubstr("[DR114]"));
  EXPECT_THAT(told(0.6), testing::Not(HasSubstr("uplifted")));
}

TEST_F(UselessPictures, AllZero) {
  // It sees black boards only.
  expect_one(kDay + kSky + camera("[100, -1, 30]", "[100, 0, 1]"),
             {"every pixel of every band is zero", "check the sources", "[DR110]"}, false);
}

// --dry-run refuses what the run refuses: here a curve that ends before the band, with the sensor's line and the band.
TEST_F(UselessPictures, DryRunsRefuseWhatRunsRefuse) {
  std::string scene = kBoards;
  scene.replace(scene.find("reflectance: 0.2"), 16, "reflectance: {points: [[0.4, 0.2], [0.7, 0.3]], outside: error}");
  prepare(scene.c_str(), "short");
  const std::string text = "scene: short.h5\n" + kDay + camera("[0, 0, 50]", "[0, 1, 0]", 1.6);
  write_file(*folder_ / "sim.yaml", std::string_view(text));
  const CommandResult dry = run("dirsig-render sim.yaml --dry-run"), real = run("dirsig-render sim.yaml -o none");
  EXPECT_EQ(real.code, 1);
  EXPECT_EQ(dry.code, 1) << dry.out;
  ASSERT_THAT(real.err, HasSubstr("sim.yaml:4:"));
  EXPECT_THAT(dry.err, testing::EndsWith(real.err.substr(real.err.find("sim.yaml:4:")))) << "the same message";
  EXPECT_THAT(dry.err, HasSubstr("sim.yaml:4:"));
  EXPECT_THAT(dry.err, HasSubstr("band 'pan' of sensor 'eye' reaches from 1.575 to 1.625 um; material 'ground' has"));
}

}  // namespace
}  // namespace suite::useless_pictures_test
