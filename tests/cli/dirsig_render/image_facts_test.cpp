// What headers tell of an image beside its numbers, as other programs read it, and images in other quantities than
// radiance.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "base/files.h"
#include "formats/envi/envi.h"
#include "formats/raster/raster.h"
#include "spectral/planck.h"
#include "spectral/thermometer.h"
#include "support/programs_kit.h"

namespace suite::image_facts_test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

const char* const kScene =
    "scene: 1\norigin: {latitude_deg: 49, longitude_deg: 8, height_m: 120}\n"
    "materials:\n  grass, wet: {model: lambert, reflectance: 0.25}\n  warm: {model: lambert, reflectance: 0.2, "
    "temperature_k: 310}\nobjects:\n  plane: {plane: {width: 28, depth: 28}, material: \"grass, wet\"}\n  board: {box: "
    "{x0: 0, y0: 0, z0: 0, x1: 4, y1: 4, z1: 0.0005}, material: warm}\nworld:\n  - {place: plane}\n  - {place: board, "
    "tag: target}\n";
const std::string kDay = "scene: scene.h5\nsun: {direction: {time_utc: \"2026-06-21T10:30:00Z\"}}\n";
const std::string kColours =
    "bands: [{name: blue, center_um: 0.47, fwhm_um: 0.03}, {name: green, center_um: 0.56, fwhm_um: 0.03}, {name: red, "
    "center_um: 0.66, fwhm_um: 0.03}, {name: nir, center_um: 0.86, fwhm_um: 0.04}]";
const std::string kThermal =
    "bands: [{name: t11, center_um: 10.9, fwhm_um: 1.2}, {name: t8, center_um: 8.6, fwhm_um: 0.5, "
    "shape: rectangular}]";

std::string map(const std::string& more, int gsd = 2) {
  return strf("  - {kind: orthographic, columns: 20, rows: 10, gsd_m: %d, center_m: [0, 0], paths: 8, ", gsd) + more +
         "}\n";
}

class ImageFacts : public ProgramsTest<ImageFacts> {
 protected:
  static void SetUpTestSuite() {
    make_folder();
    prepare(kScene);
  }
  static EnviHeader header(const std::string& name) { return read_envi_header(*folder_ / name); }
  static std::vector<double> values(const std::string& name) { return EnviImage(*folder_ / name).read_all(); }
};

// The sun: PyEphem 4 (Observer at 49 N 8 E, 120 m, pressure 0; 2026/6/21 10:30:00; Sun.az, Sun.alt).
TEST_F(ImageFacts, EveryHeaderHasTheDateTheSunAndItsBands) {
  ASSERT_EQ(render(kDay + "sensors:\n" + map(kColours), "facts").code, 0);
  for (const char* suffix : {"", "_error", "_quality", "_truth", "_material"}) {
    const EnviHeader h = header("facts/map" + std::string(suffix) + ".img");
    EXPECT_EQ(h.acquisition_time, "2026-06-21T10:30:00.000000Z") << suffix;
    ASSERT_TRUE(h.sun_azimuth_deg && h.sun_elevation_deg) << suffix;
    EXPECT_NEAR(*h.sun_azimuth_deg, 149.8824, 0.005);
    EXPECT_NEAR(*h.sun_elevation_deg, 61.8520, 0.005);
  }
  EXPECT_THAT(header("facts/map.img").default_bands, ElementsAre(3, 2, 1));
  EXPECT_FALSE(header("facts/map.img").ignore_value);
  EXPECT_TRUE(std::isnan(*header("facts/map_truth.img").ignore_value));
}

// A strip tells the middle, from when to when, and how the sun went.
TEST_F(ImageFacts, AStripTellsFromWhenToWhen) {
  const std::string broom =
      "sensors:\n  - kind: platform\n    name: uas\n    motion: {kind: straight, position_m: [0, -100, 100], "
      "heading_deg: "
      "0, speed_m_s: 1}\n    tasks: [{name: a, start: 100, stop: 300}]\n    instruments:\n      - focal_length_mm: 50\n"
      "        arrays: [{columns: 5, pitch_um: 500, paths: 1, readout: {kind: line, line_rate_hz: 0.2}, " +
      kColours + "}]\n";
  ASSERT_EQ(render(kDay + broom, "strip").code, 0);
  const EnviHeader h = header("strip/uas.img");
  const std::pair<std::string, std::string> range{"acquisition time range",
                                                  "{2026-06-21T10:31:40.000000Z, 2026-06-21T10:34:55.000000Z}"};
  EXPECT_EQ(h.acquisition_time, "2026-06-21T10:33:17.500000Z");
  EXPECT_THAT(h.extra, testing::Contains(range));
  EXPECT_THAT(h.extra, testing::Contains(testing::Key("sun elevation range")));
  // A sun that stands still has no range, and without a date there is no time.
  ASSERT_EQ(render("scene: scene.h5\nsun: {direction: {zenith_deg: 30, azimuth_deg: 250}}\n" + broom, "still").code, 0);
  const EnviHeader still = header("still/uas.img");
  EXPECT_EQ(still.acquisition_time, "");
  EXPECT_NEAR(*still.sun_azimuth_deg, 250, 1e-9);
  EXPECT_NEAR(*still.sun_elevation_deg, 60, 1e-9);
  EXPECT_TRUE(still.extra.empty());
  ASSERT_EQ(render("scene: scene.h5\nsky: {radiance: 1}\n" + broom, "sunless").code, 0);
  EXPECT_FALSE(header("sunless/uas.img").sun_azimuth_deg);
}

TEST_F(ImageFacts, DefaultBandsShowAPicture) {
  const std::string infrared =
      "bands: [{name: g, center_um: 0.56, fwhm_um: 0.03}, {name: r, center_um: 0.66, fwhm_um: 0.03}, {name: n, "
      "center_um: "
      "0.86, fwhm_um: 0.03}]";
  ASSERT_EQ(render(kDay + "sensors:\n" + map("name: cir, " + infrared) + map("name: warm, " + kThermal), "bands").code,
            0);
  EXPECT_THAT(header("bands/cir.img").default_bands, ElementsAre(3, 2, 1));
  EXPECT_THAT(header("bands/warm.img").default_bands, ElementsAre(1));
  ASSERT_EQ(render(kDay + "output: {preview: [nir, red, green]}\nsensors:\n" + map(kColours), "asked").code, 0);
  EXPECT_THAT(header("asked/map.img").default_bands, ElementsAre(4, 3, 2));
}

TEST_F(ImageFacts, ClassesHaveNames) {
  ASSERT_EQ(render(kDay + "sensors:\n" + map("truth: [tag, material], " + kColours), "classes").code, 0);
  const EnviHeader material = header("classes/map_material.img"), tag = header("classes/map_tag.img");
  ASSERT_EQ(material.classes.size(), 3u);
  EXPECT_EQ(material.classes[0].name, "nothing");
  EXPECT_EQ(material.classes[1].name, "grass; wet");
  EXPECT_EQ(material.classes[2].name, "warm");
  ASSERT_EQ(tag.classes.size(), 2u);
  EXPECT_EQ(tag.classes[1].name, "target");
  const std::vector<double> truth = values("classes/map_truth.img"), m = values("classes/map_material.img"),
                            t = values("classes/map_tag.img");
  size_t seen[3] = {};
  for (size_t i = 0; i < m.size(); ++i) {
    EXPECT_EQ(t[i], std::isnan(truth[2 * i]) ? 0 : truth[2 * i] + 1);
    EXPECT_EQ(m[i], std::isnan(truth[2 * i + 1]) ? 0 : truth[2 * i + 1] + 1);
    ++seen[static_cast<size_t>(m[i])];
  }
  for (const size_t n : seen) EXPECT_GT(n, 0u);
  ASSERT_EQ(render(kDay + "sensors:\n" + map("truth: [range], " + kColours), "classless").code, 0);
  EXPECT_FALSE(file_exists(*folder_ / "classless/map_material.img"));
}

// What lies outside the circle of a fisheye is no measurement.
TEST_F(ImageFacts, OutsideTheCircleIsMarked) {
  ASSERT_EQ(render(kDay + "sensors: [{kind: fisheye, size: 8, position_m: [0, 0, 5], look: down, paths: 1, " +
                       kColours + "}]\n",
                   "fish")
                .code,
            0);
  EXPECT_EQ(header("fish/fisheye.img").ignore_value, 0);
  EXPECT_EQ(values("fish/fisheye.img")[0], 0);
  EXPECT_FALSE(header("fish/fisheye_error.img").ignore_value);
}

// Runs with and without units take the same samples.
TEST_F(ImageFacts, ReflectanceAboveTheAir) {
  ASSERT_EQ(render(kDay + "sensors:\n" + map("units: toa_reflectance, " + kColours), "rho").code, 0);
  ASSERT_EQ(render(kDay + "sensors:\n" + map(kColours), "rho_rad").code, 0);
  const EnviHeader h = header("rho/map.img");
  EXPECT_EQ(h.data_units, "reflectance");
  EXPECT_THAT(h.description, HasSubstr("top-of-atmosphere reflectance of sensor 'map'"));
  EXPECT_EQ(header("rho_rad/map.img").data_units, "W/(m2 sr um)");
  const std::vector<double> rho = values("rho/map.img"), rad = values("rho_rad/map.img"),
                            error = values("rho/map_error.img"), rad_error = values("rho_rad/map_error.img"),
                            where = values("rho/map_material.img");
  size_t ground = 0;
  double mean = 0, variance = 0;
  for (size_t i = 0; i < rho.size(); ++i) {
    // In a vacuum it is the Lambertian reflectance; the standard errors keep their ratio to the values.
    if (where[i / 4] == 1) {
      EXPECT_NEAR(rho[i], 0.25, 1e-3);
      mean += rho[i], variance += error[i] * error[i];
      ++ground;
    }
    if (rad[i] > 0) {
      EXPECT_NEAR(error[i] / rho[i], rad_error[i] / rad[i], 1e-5);
    }
  }
  EXPECT_GT(ground, 400u);
  const double n = static_cast<double>(ground);
  // Four bands share their paths, which at most doubles the error of the mean; the bins are good to 0.1 % of a band.
  EXPECT_NEAR(mean / n, 0.25, 8 * std::sqrt(variance) / n + 0.25e-3);
}

TEST_F(ImageFacts, BrightnessTemperatureOfTheBand) {
  const std::string light =
      "scene: scene.h5\noutput: {type: float64, also: [geotiff]}\nsky: {radiance: 0.5}\nsensors:\n";
  const CommandResult r = render(light + map("units: brightness_temperature, " + kThermal, 3), "warm");
  ASSERT_EQ(r.code, 0) << r.err;
  ASSERT_EQ(render(light + map(kThermal, 3), "warm_rad").code, 0);
  const EnviHeader h = header("warm/map.img");
  EXPECT_EQ(h.data_units, "K");
  EXPECT_TRUE(std::isnan(*h.ignore_value));
  const std::vector<double> kelvin = values("warm/map.img"), error = values("warm/map_error.img"),
                            rad = values("warm_rad/map.img"), rad_error = values("warm_rad/map_error.img");
  const BandThermometer bands[] = {BandThermometer(Band::gaussian("t11", 10.9, 1.2)),
                                   BandThermometer(Band::rectangular("t8", 8.6, 0.5))};
  size_t known = 0, none = 0;
  for (size_t i = 0; i < kelvin.size(); ++i) {
    const BandThermometer& band = bands[i % 2];
    if (!(rad[i] > 0)) {
      EXPECT_TRUE(std::isnan(kelvin[i]) && std::isnan(error[i]));
      ++none;
      continue;
    }
    ++known;
    EXPECT_NEAR(band.radiance(kelvin[i]) / rad[i], 1, 1e-7);
    // One standard error up and down in radiance is one up and down in temperature, for small ones.
    const double up = band.read(rad[i] + 1e-3 * rad_error[i]).kelvin,
                 down = band.read(rad[i] - 1e-3 * rad_error[i]).kelvin;
    EXPECT_NEAR((up - down) / 2e-3, error[i], 1e-3 * error[i] + 1e-6);
  }
  EXPECT_GT(known, 100u);
  EXPECT_GT(none, 20u);
  EXPECT_THAT(r.err,
              AllOf(HasSubstr(strf("warning: 'warm/map.img': %zu of 400 values have no brightness temperature", none)),
                    HasSubstr("[DR804]")));
  const Raster tiff = read_raster(*folder_ / "warm/map.tif");
  for (size_t i = 0; i < kelvin.size(); ++i)
    ASSERT_TRUE(std::isnan(kelvin[i]) ? std::isnan(tiff.values[i]) : tiff.values[i] == static_cast<float>(kelvin[i]));
}

// Counts cannot hold NaN: 0 stands for it, and the header says so.
TEST_F(ImageFacts, TemperaturesAsCounts) {
  ASSERT_EQ(render("scene: scene.h5\noutput: {type: uint16, scale: 0.01}\nsky: {radiance: 0.5}\nsensors:\n" +
                       map("units: brightness_temperature, geolocation: true, " + kThermal, 3),
                   "counts")
                .code,
            0);
  EXPECT_EQ(header("counts/map.img").ignore_value, 0);
  const std::vector<double> v = values("counts/map.img");
  EXPECT_GT(std::count(v.begin(), v.end(), 0), 20);
  EXPECT_GT(std::count_if(v.begin(), v.end(), [](double x) { return x > 15000 && x < 32000; }), 20);
  EXPECT_THAT(read_text(*folder_ / "counts/map_geo.vrt"), HasSubstr("<Scale>0.01"));
}

// Chips that see with other responses are turned by these.
TEST_F(ImageFacts, ChipsHaveTheirOwnTemperatures) {
  const std::string head =
      "scene: scene.h5\nsensors:\n  - kind: platform\n    name: two\n    motion: {kind: straight, position_m: [2.5, "
      "2.5, 100], "
      "heading_deg: 0, speed_m_s: 0.1}\n    tasks: [{start: 0}]\n    units: brightness_temperature\n    instruments:\n "
      "     - focal_length_mm: 100\n        arrays: [{rows: 4, pitch_um: 100, paths: 16, ";
  const std::string chips =
      "bands: [{name: t, center_um: 10.9, fwhm_um: 1.2}], chips: [{columns: 6, offset_mm: [-0.3, 0]}, "
      "{columns: 6, offset_mm: [0.3, 0], bands: [{name: t, center_um: 4, fwhm_um: 0.5}]}]}]\n";
  ASSERT_EQ(render(head + chips, "chips").code, 0);
  // A grey body of emissivity 0.8 at 310 K: colder in the longer band.
  const double at11 = BandThermometer(Band::gaussian("t", 10.9, 1.2))
                          .read(0.8 * BandThermometer(Band::gaussian("t", 10.9, 1.2)).radiance(310))
                          .kelvin;
  const double at4 = BandThermometer(Band::gaussian("t", 4, 0.5))
                         .read(0.8 * BandThermometer(Band::gaussian("t", 4, 0.5)).radiance(310))
                         .kelvin;
  EXPECT_GT(at4 - at11, 5);
  const std::vector<double> v = values("chips/two.img");
  ASSERT_EQ(v.size(), 48u);
  for (size_t row = 0; row < 4; ++row)
    for (size_t c = 0; c < 12; ++c) EXPECT_NEAR(v[12 * row + c], c < 6 ? at11 : at4, 0.05) << row << " " << c;
}

TEST_F(ImageFacts, WhatCannotBeHadIsRefused) {
  const std::string rho = "sensors:\n" + map("units: toa_reflectance, " + kColours);
  const struct {
    std::string text, expected;
  } cases[] = {
      {"scene: scene.h5\nsky: {radiance: 1}\n" + rho, "there is no sun; give the simulation a `sun`"},
      {"scene: scene.h5\nsun: {direction: {time_utc: \"2026-06-21T23:30:00Z\"}}\n" + rho,
       "needs the sun above the horizon; at 0 s, when 'map' of sensor 'map' is taken, it stands 17.57 degrees below"},
      {"scene: scene.h5\nsun: {direction: {zenith_deg: 20, azimuth_deg: 0}, irradiance: {wavelength_um: [0.4, 0.7], "
       "value: [1, 1], outside: zero}}\n" +
           rho,
       "the sun has no light in the band 'nir'"},
      {kDay + "sensors:\n" + map("units: reflectance, " + kColours), "'reflectance' is none of the choices here"},
      {kDay + "sensors:\n" + map("geolocation: {pixel: 2}, " + kColours), "pixel"},
      {kDay + "sensors:\n" + map("geolocation: {pixel_m: -2}, " + kColours), "pixel_m"}};
  for (const auto& c : cases) {
    const CommandResult r = render(c.text, "refused");
    EXPECT_EQ(r.code, 1) << c.text;
    EXPECT_THAT(r.err, HasSubstr(c.expected));
    EXPECT_THAT(r.err, HasSubstr("refused.yaml:")) << "located";
    EXPECT_FALSE(file_exists(*folder_ / "refused/map.img"));
  }
}

}  // namespace
}  // namespace suite::image_facts_test
