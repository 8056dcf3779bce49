// The pictures beside the images: colours of temperatures, stretch, what is left out of it, keys.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "base/files.h"
#include "formats/picture/picture.h"
#include "formats/raster/raster.h"
#include "support/run_command.h"

namespace suite::preview_test {
namespace {

using testing::HasSubstr;

// Plates of 8 x 8 m in a void of 20 x 20 m: cold and warm ones, dark and bright ones, and a lamp of a pixel's size.
const char* const kScene =
    "scene: 1\nmaterials:\n"
    "  cold: {model: lambert, reflectance: 0, temperature_k: 290}\n"
    "  warm: {model: lambert, reflectance: 0, temperature_k: 310}\n"
    "  dark: {model: lambert, reflectance: 0.1}\n"
    "  green: {model: lambert, reflectance: {wavelength_um: [0.45, 0.55, 0.65], value: [0.2, 0.8, 0.4], outside: "
    "hold}}\n"
    "  bulb: {model: lambert, reflectance: 0.1}\n"
    "objects:\n"
    "  cold: {plane: {width: 8, depth: 8}, material: cold}\n  warm: {plane: {width: 8, depth: 8}, material: warm}\n"
    "  dark: {plane: {width: 8, depth: 8}, material: dark}\n  green: {plane: {width: 8, depth: 8}, material: green}\n"
    "  bulb: {plane: {width: 1, depth: 1}, material: bulb}\n"
    "world:\n  - {place: cold, translate: [-5, 5, 0]}\n  - {place: warm, translate: [5, 5, 0]}\n"
    "  - {place: dark, translate: [-5, -5, 0]}\n  - {place: green, translate: [5, -5, 0]}\n"
    "  - {place: bulb, translate: [-4.5, -4.5, 1]}\n";

const char* const kSimulation =
    "scene: scene.h5\nsun: {direction: {zenith_deg: 0, azimuth_deg: 0}, collimated: true, irradiance: {wavelength_um: "
    "[0.4, 0.7], value: [1000, 1000], outside: zero}}\n"
    "sensors:\n"
    "  - {kind: orthographic, name: eye, columns: 20, rows: 20, gsd_m: 1, center_m: [0, 0], paths: 16, bands: [\n"
    "      {name: red, center_um: 0.65, fwhm_um: 0.001}, {name: green, center_um: 0.55, fwhm_um: 0.001},\n"
    "      {name: blue, center_um: 0.45, fwhm_um: 0.001}]}\n"
    "  - {kind: orthographic, name: heat, columns: 20, rows: 20, gsd_m: 1, center_m: [0, 0], paths: 16, bands: [\n"
    "      {name: tir, center_um: 10, fwhm_um: 4, shape: rectangular}]}\n";

class PreviewTest : public testing::Test {
 protected:
  void SetUp() override {
    write_file(folder_ / "scene.yaml", std::string_view(kScene));
    write_file(folder_ / "sim.yaml", std::string_view(kSimulation));
    ASSERT_EQ(run("scene-prep scene.yaml -o scene.h5 -q").code, 0);
  }
  CommandResult run(const std::string& command) {
    return run_command("cd '" + folder_.path() + "' && " SUITE_BIN_DIR "/" + command);
  }
  void render(const std::string& options) {
    const CommandResult r = run("dirsig-render sim.yaml -o out -q " + options);
    ASSERT_EQ(r.code, 0) << r.err;
  }
  Raster picture(const char* name) { return read_raster(folder_ / ("out/" + std::string(name) + ".png")); }
  static Rgb at(const Raster& r, uint32_t x, uint32_t y) {
    const float* v = &r.values[(size_t{y} * r.width + x) * r.channels];
    return {static_cast<uint8_t>(std::lround(v[0])), static_cast<uint8_t>(std::lround(v[1])),
            static_cast<uint8_t>(std::lround(v[2]))};
  }
  // A detector of a picture of 20 x 20 of them with a bar: 20 times enlarged, under a title of 16 pixels.
  static Rgb with_bar(const Raster& r, uint32_t column, uint32_t row) {
    return at(r, 20 * column + 10, 16 + 20 * row + 10);
  }
  TempFolder folder_;
};

void expect_near(Rgb got, Rgb wanted, int by, const char* what) {
  EXPECT_NEAR(got.r, wanted.r, by) << what;
  EXPECT_NEAR(got.g, wanted.g, by) << what;
  EXPECT_NEAR(got.b, wanted.b, by) << what;
}

// Black plates show their own temperature, whatever the width of the band; the void is grey.
TEST_F(PreviewTest, ThermalBandsShowKelvin) {
  render("--set 'output={previews: {heat: {range: [280, 320]}}}'");
  const Raster heat = picture("heat");
  ASSERT_GT(heat.width, 400u);
  expect_near(with_bar(heat, 4, 4), inferno(0.25), 1, "290 K");
  expect_near(with_bar(heat, 15, 4), inferno(0.75), 1, "310 K");
  EXPECT_EQ(with_bar(heat, 10, 10), kGrey) << "nothing";
  EXPECT_EQ(at(heat, 3, 3).r, 255) << "beside the title";
  EXPECT_THAT(read_text(folder_ / "out/heat.png"), HasSubstr("linear from 280 to 320 K (as asked), inferno"));
  // The temperature of the band's mean radiance, not that at its centre, which is 288.1 K here.
  render("--set 'output={previews: {heat: {range: [289.9, 290.1], bar: false}}}'");
  const Raster fine = picture("heat");
  EXPECT_EQ(fine.width, 20u);
  expect_near(at(fine, 4, 4), inferno(0.5), 12, "to 0.005 K");
  // Of its own accord the range is that of what is there, without the void.
  render("--set seed=2");
  EXPECT_THAT(read_text(folder_ / "out/heat.png"), HasSubstr("(1 and 99 % of the pixels)"));
  EXPECT_EQ(with_bar(picture("heat"), 10, 10), kGrey);
  for (const char* truth : {"hits", "location", "range", "view_angle"}) {
    render(std::string("--set 'sky={radiance: 0.1}' --set sensors.heat.truth=[") + truth + "]");
    EXPECT_EQ(with_bar(picture("heat"), 10, 10), kGrey) << truth << ": the sky is no object";
  }
  expect_near(with_bar(picture("heat"), 15, 4), inferno(1), 1, "the warmest");
}

// Colours are in proportion, and neither a lamp of one pixel nor the void changes them.
TEST_F(PreviewTest, ColoursKeepAndOneBrightPixelDoesNot) {
  render("");
  const Raster plain = picture("eye");
  EXPECT_EQ(plain.width, 20u);
  render("--set 'lamps=[{kind: surface, material: bulb, radiance: 1e6}]'");
  const Raster lit = picture("eye");
  for (const auto& [x, y] : {std::pair{4u, 15u}, {15u, 15u}, {12u, 12u}})
    expect_near(at(lit, x, y), at(plain, x, y), 3, "under a lamp of one pixel");
  EXPECT_EQ(at(lit, 5, 14), kWhite);
  // L = reflectance 1000 / pi: the brightest band of the green plate is white, the others stand in proportion to it.
  const Rgb green = at(plain, 15, 15);
  EXPECT_EQ(green.g, 255);
  EXPECT_NEAR(green.r, srgb(0.4 / 0.8), 2);
  EXPECT_NEAR(green.b, srgb(0.2 / 0.8), 2);
  EXPECT_EQ(at(plain, 10, 10), kBlack);
}

TEST_F(PreviewTest, KeysDecide) {
  const double white = 1000 * 0.8 / kPi;
  render(
      strf("--set 'output={previews: {eye: {bands: [blue, green, red], range: [0, %.6f], gamma: 1}, heat: {show: "
           "radiance}}}'",
           2 * white));
  const Rgb swapped = at(picture("eye"), 15, 15);
  expect_near(swapped, {32, 128, 64}, 1, "linear, blue for red");
  EXPECT_THAT(read_text(folder_ / "out/eye.png"), HasSubstr("gamma 1"));
  const Rgb grey = with_bar(picture("heat"), 4, 4);
  EXPECT_EQ(grey.r, grey.b) << "radiance is grey";
  render("--set 'output={preview: {show: kelvin}}' --set 'output.previews={eye: [red]}'");
  EXPECT_EQ(at(picture("eye"), 3, 3).r, 255) << "one band has a bar";
  const Rgb red = with_bar(picture("eye"), 15, 15);
  EXPECT_EQ(red.r, red.g);
  const CommandResult unknown = run("dirsig-render sim.yaml -o no --set 'output={previews: {heat: [tri]}}'");
  EXPECT_EQ(unknown.code, 1);
  EXPECT_THAT(unknown.err, HasSubstr("did you mean 'tir'"));
}

// Beside a GeoTIFF stands a style for QGIS: the preview's bands and ends, in the unit of the numbers.
TEST_F(PreviewTest, StylesShowWhatThePreviewShows) {
  const auto number = [](const std::string& text, const std::string& after) {
    const size_t at = text.find(after);
    return at == std::string::npos ? NAN : std::stod(text.substr(at + after.size()));
  };
  render("--set 'output={also: [geotiff]}'");
  const std::string eye = read_text(folder_ / "out/eye.qml"), heat = read_text(folder_ / "out/heat.qml");
  EXPECT_THAT(eye, HasSubstr("redBand=\"1\" greenBand=\"2\" blueBand=\"3\""));
  EXPECT_NEAR(number(eye, "<minValue>"), 0, 1e-6);
  EXPECT_NEAR(number(eye, "<maxValue>"), 0.8 * 1000 / M_PI, 1);
  EXPECT_THAT(eye, HasSubstr("gamma=\"2.2\""));
  const Raster radiance = read_raster(folder_ / "out/heat.tif");
  float low = INFINITY, high = 0;
  for (const float v : radiance.values)
    if (v > 0) low = std::min(low, v), high = std::max(high, v);
  EXPECT_THAT(heat, HasSubstr("singlebandpseudocolor"));
  EXPECT_NEAR(number(heat, "classificationMin=\"") / low, 1, 1e-6);
  EXPECT_NEAR(number(heat, "classificationMax=\"") / high, 1, 1e-6);
  EXPECT_GT(high, 1.1 * low);
  EXPECT_THAT(read_text(folder_ / "out/eye_quality.qml"), HasSubstr("label=\"heavy_tail + failures\""));
  // A range holds where the numbers have its unit.
  render("--set 'output={also: [geotiff], previews: {eye: {range: [10, 20], bands: [green], gamma: 3}}}'");
  EXPECT_EQ(number(read_text(folder_ / "out/eye.qml"), "<maxValue>"), 20);
  EXPECT_THAT(read_text(folder_ / "out/eye.qml"), HasSubstr("gamma=\"3\""));
  render("--set 'output={also: [geotiff], units: W/(cm2 sr um), previews: {eye: {range: [10, 20]}}}'");
  EXPECT_NEAR(number(read_text(folder_ / "out/eye.qml"), "<maxValue>"), 0.8 * 0.1 / M_PI, 1e-4);
}

}  // namespace
}  // namespace suite::preview_test
