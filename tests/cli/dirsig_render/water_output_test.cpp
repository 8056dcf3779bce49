// Remote-sensing reflectance and collectors in water, through both programs: a Lambert bed under flat water, sun and an
// even sky, whose closed forms are those of tests/physics/transport/water_parts_test.cpp.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "formats/envi/envi.h"
#include "math/vec.h"
#include "optics/fresnel.h"
#include "support/even_within.h"
#include "support/programs_kit.h"

namespace suite::water_output_test {
namespace {

using testing::HasSubstr;

constexpr double kIndex = 1.33, kBed = 0.3, kSun = 1000, kSky = 50;
const char* const kScene =
    "scene: 1\nmaterials:\n  bed: {model: lambert, reflectance: 0.3}\n  water: {model: dielectric, index: 1.33}\n"
    "objects:\n  bed: {plane: {width: 0, depth: 0}, material: bed}\n  water: {plane: {width: 0, depth: 0}, material: "
    "water}\nworld:\n  - {place: bed, translate: [0, 0, -2]}\n  - {place: water}\n";
const std::string kLit =
    "scene: scene.h5\nsun: {direction: {zenith_deg: 60, azimuth_deg: 120}, irradiance: 1000, collimated: true}\n"
    "sky: {radiance: 50}\n";
const std::string kBands =
    "bands: [{name: a, center_um: 0.5, fwhm_um: 0.02}, {name: b, center_um: 0.6, fwhm_um: 0.02}]";

std::string map(const std::string& more) {
  return "sensors:\n  - {kind: orthographic, columns: 4, rows: 4, gsd_m: 1, center_m: [0, 0], paths: 4096, " + more +
         ", " + kBands + "}\n";
}

class WaterOutput : public ProgramsTest<WaterOutput> {
 protected:
  static void SetUpTestSuite() {
    make_folder();
    prepare(kScene);
  }
  static std::vector<double> values(const std::string& name) { return EnviImage(*folder_ / name).read_all(); }
};

double transmitted(double c) { return fresnel_dielectric(c, kIndex).transmittance; }

// Radiance straight up over the downward irradiance.
double closed_form(double sky) {
  constexpr int n = 20000;
  const double inside = suite::test::reflected_within(kIndex);
  double dome = 0;
  for (int i = 0; i < n; ++i) {
    const double c = (i + 0.5) / n;
    dome += 2 * kPi * c * transmitted(c) / n;
  }
  const double irradiance = kSun * 0.5 * transmitted(0.5) + sky * dome;
  return kBed / kPi * irradiance * transmitted(1) / (kIndex * kIndex * (1 - kBed * inside)) / (kSun * 0.5 + kPi * sky);
}

TEST_F(WaterOutput, RemoteSensingReflectance) {
  const CommandResult r = render(
      kLit + map("units: remote_sensing_reflectance, irradiance_at_m: [3, 3, 0.5], channels: [water_leaving]"), "rrs");
  ASSERT_EQ(r.code, 0) << r.err;
  const EnviHeader h = read_envi_header(*folder_ / "rrs/map.img");
  EXPECT_EQ(h.data_units, "1/sr");
  EXPECT_THAT(h.band_names, testing::ElementsAre("a", "b", "a water_leaving", "b water_leaving"));
  const std::vector<double> v = values("rrs/map.img"), e = values("rrs/map_error.img");
  ASSERT_EQ(v.size(), 64u);
  double mean = 0, error = 0;
  for (size_t i = 2; i < 64; i += 4) mean += v[i] / 16, error += e[i] * e[i] / 256;
  error = std::sqrt(error);
  EXPECT_NEAR(mean, closed_form(kSky), 4 * error + 1e-3 * mean);  // of the light from above 1e-3 at most
  EXPECT_LT(error, 5e-3 * mean);
  const double sun = kSun * 0.5, all = sun + kPi * kSky;
  EXPECT_GT(std::fabs(mean * all / sun - closed_form(kSky)), 10 * error) << "control: over the sun's light alone";
  for (size_t i = 0; i < 64; i += 4) EXPECT_GT(v[i], v[i + 2]) << "the sky in the mirror is in all of the light";
}

TEST_F(WaterOutput, CollectorsInTheWater) {
  const std::string at = "position_m: [0, 0, -1.999]";
  const CommandResult r = render(kLit + "sensors:\n  - {kind: point, name: meters, paths: 16384, " + kBands +
                                     ", collectors: [{name: Ed, quantity: "
                                     "irradiance, normal: [0, 0, 1], " +
                                     at + "}, {name: Eu, quantity: irradiance, normal: [0, 0, -1], " + at +
                                     "}, {name: E0, quantity: actinic_flux, " + at +
                                     "}, {name: Lu, quantity: radiance, look: [0, 0, -1], " + at + "}]}\n",
                                 "meters");
  ASSERT_EQ(r.code, 0) << r.err;
  const std::string csv = read_text(*folder_ / "meters/meters.csv");
  const auto value = [&](const std::string& name, size_t column) {
    size_t from = csv.find("\n" + name + ",");
    EXPECT_NE(from, std::string::npos) << name;
    for (size_t i = 0; i < column; ++i) from = csv.find(',', from + 1);
    return std::stod(csv.substr(from + 1));
  };
  const double down = value("Ed", 5), up = value("Eu", 5), flux = value("E0", 5), nadir = value("Lu", 5);
  const double error = value("Ed", 6);
  // Lu of a Lambert bed is Eu / pi, and its light the same from all directions.
  const double expected = closed_form(kSky) * (kSun * 0.5 + kPi * kSky) * kIndex * kIndex / transmitted(1);
  EXPECT_NEAR(nadir, expected, 4 * value("Lu", 6) + 1e-4 * expected);
  EXPECT_NEAR(up, kPi * nadir, 4 * value("Eu", 6) + 4 * 3.15 * value("Lu", 6));
  EXPECT_NEAR(down, up / kBed, 4 * error + 4 * value("Eu", 6) / kBed);
  EXPECT_GT(flux, down + 2 * up) << "no light is steeper than along the vertical";
  EXPECT_LT(error, 0.01 * down);
}

TEST_F(WaterOutput, WhatCannotBeHadIsRefused) {
  const std::string units = "units: remote_sensing_reflectance, ", at = "irradiance_at_m: [0, 0, 1], ",
                    parts = "channels: [water_leaving]";
  const struct {
    std::string text, expected;
  } cases[] = {{kLit + map(units + parts), "irradiance_at_m"},
               {kLit + map(units + "irradiance_at_m: [0, 0, 1]"), "channels: [water_leaving]"},
               {"scene: scene.h5\nsky: {radiance: 0}\n" + map(units + at + parts), "no light comes down"}};
  for (const auto& c : cases) {
    const CommandResult r = render(c.text, "refused");
    EXPECT_EQ(r.code, 1) << c.text;
    EXPECT_THAT(r.err, HasSubstr(c.expected));
    EXPECT_THAT(r.err, HasSubstr("refused.yaml:")) << "located";
  }
}

}  // namespace
}  // namespace suite::water_output_test
