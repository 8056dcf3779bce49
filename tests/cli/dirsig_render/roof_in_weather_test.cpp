// A roof and a yard under weather, through both programs: the table of expect.md, points against elements, the bands of
// the mid-wave infrared, and what is refused.
#include <gmock/gmock.h>

#include <cmath>

#include "base/files.h"
#include "formats/picture/picture.h"
#include "formats/raster/raster.h"
#include "support/sample_kit.h"

namespace suite::roof_in_weather_test {
namespace {

using testing::HasSubstr;

// Where temperatures are compared with each other: the gases' bins would be found anew by each run, and steps cost
// alike.
const std::string kPlain = " --set atmosphere.gases=none --set heat.step_s=1800 ";

class RoofInWeather : public SampleScene {
 protected:
  RoofInWeather() : SampleScene("roof_in_weather") {
    // What the text names beside its own folder.
    run_command("mkdir -p " + folder_.path() +
                "/in && cp " SUITE_SOURCE_DIR "/sample_scenes/summer_street/denver_july.epw " + folder_.path());
  }
  void SetUp() override {
    SampleScene::SetUp();
    std::string text = read_text(folder_ / "sim.yaml");
    const std::string from = "../summer_street/";
    text.erase(text.find(from), from.size());
    write_file(folder_ / "sim.yaml", text);
  }
};

TEST_F(RoofInWeather, ShowsWhatIsExpected) {
  std::string few = "--paths 2";
  for (int s = 0; s < 3; ++s) few += strf(" --set sensors.%d.truth=[temperature,temperature_error,sun_hours]", s);
  render("out", few);
  struct Place {
    size_t column, row;
  };
  constexpr Place kRoof{40, 36}, kYard{10, 10}, kShade{68, 36};
  const auto expect = [&](const char* picture, size_t band, std::array<double, 3> kelvin) {
    for (const auto& [place, wanted] : {std::pair{kRoof, kelvin[0]}, {kYard, kelvin[1]}, {kShade, kelvin[2]}})
      EXPECT_NEAR(value(picture, place.column, place.row, band), wanted, 1) << picture << band << " " << place.column;
  };
  expect("out/night.img", 0, {281.8, 289.9, 290.3});
  expect("out/afternoon.img", 0, {312.6, 310.6, 304.3});
  expect("out/midwave.img", 0, {317.0, 315.4, 303.7});
  expect("out/midwave.img", 1, {312.3, 310.3, 303.4});

  // Truth as pictures: the colour of a pixel is that of its number on the bar, whose ends the file says.
  const Raster shown = read_raster(folder_ / "out/afternoon_sun_hours.png");
  const std::string text = read_text(folder_ / "out/afternoon_sun_hours.png");
  const size_t said = text.find("sun hours, linear from ");
  ASSERT_NE(said, std::string::npos);
  double low = 0, high = 0;
  ASSERT_EQ(std::sscanf(&text[said], "sun hours, linear from %lf to %lf h", &low, &high), 2);
  constexpr size_t kEnlarged = 6, kTop = 32;  // 96 x 72 detectors
  for (const Place place : {kRoof, kYard, kShade}) {
    const double hours = value("out/afternoon_truth.img", place.column, place.row, 2);
    const Rgb colour = inferno((hours - low) / (high - low));
    const size_t x = place.column * kEnlarged + 2, y = place.row * kEnlarged + 2 + kTop;
    const float* at = &shown.values[(y * shown.width + x) * shown.channels];
    std::printf("%.2f h of sun at column %zu: %.0f %.0f %.0f\n", hours, place.column, double{at[0]}, double{at[1]},
                double{at[2]});
    EXPECT_NEAR(double{at[0]}, colour.r, 2) << hours;
    EXPECT_NEAR(double{at[1]}, colour.g, 2);
    EXPECT_NEAR(double{at[2]}, colour.b, 2);
  }
  EXPECT_GT(value("out/afternoon_truth.img", kYard.column, kYard.row, 2),
            value("out/afternoon_truth.img", kShade.column, kShade.row, 2) + 1);
  for (const char* other : {"temperature", "temperature_error"})
    EXPECT_TRUE(file_exists(folder_ / (std::string("out/night_") + other + ".png"))) << other;

  // The same temperatures, of elements alone: the edge of the shadow lies where they have theirs.
  render("elements", "--heat out/heat.h5 --set heat.final_gather=false " + few);
  double sharpest[2] = {0, 0}, most = 0;
  for (size_t column = 70; column < 78; ++column)
    for (int k = 0; k < 2; ++k) {
      const char* picture = k == 0 ? "out/afternoon_truth.img" : "elements/afternoon_truth.img";
      sharpest[k] = std::fmax(sharpest[k], value(picture, column + 1, 36, 0) - value(picture, column, 36, 0));
      most = std::fmax(most, std::fabs(value("out/afternoon_truth.img", column, 36, 0) -
                                       value("elements/afternoon_truth.img", column, 36, 0)));
    }
  std::printf("points differ from elements by up to %.2f K at the shadow's edge\n", most);
  EXPECT_GT(most, 1);
  // Both know as little of the rest; points do not suffer from the size of elements.
  EXPECT_LT(value("out/afternoon_truth.img", 72, 36, 1), value("elements/afternoon_truth.img", 72, 36, 1));
}

// A job in parts that are given the temperatures has the bytes of one run that finds them, points included.
TEST_F(RoofInWeather, PartsTakeTheTemperaturesOfAFile) {
  std::string few = "--paths 2 --set heat.elements=100" + kPlain;
  for (int s = 0; s < 3; ++s) few += strf(" --set sensors.%d.columns=12 --set sensors.%d.rows=9", s, s);
  render("out", few);
  for (const char* part : {"1", "2"})
    render(std::string("p") + part, strf("--part %s/2 --state --heat out/heat.h5 ", part) + few);
  render("joined", "--merge p1 p2 --heat out/heat.h5 " + few);
  for (const char* image : {"night", "afternoon", "midwave", "afternoon_truth"}) {
    const std::string name = std::string("/") + image + ".img";
    EXPECT_EQ(read_bytes(folder_ / ("out" + name)), read_bytes(folder_ / ("joined" + name))) << image;
  }
}

TEST_F(RoofInWeather, PointsNeedWhatElementsWereFoundWith) {
  render("out", "--heat-only --set heat.final_gather=false --set heat.elements=50 --set heat.paths=8" + kPlain);
  const CommandResult r = run("dirsig-render sim.yaml -o again --heat out/heat.h5");
  EXPECT_EQ(r.code, 1);
  EXPECT_THAT(r.err, HasSubstr("holds temperatures of elements alone, and `final_gather` asks for points"));
  const CommandResult twice = run("dirsig-render sim.yaml -o again --set heat.repeats=false");
  EXPECT_EQ(twice.code, 1);
  EXPECT_THAT(twice.err, HasSubstr("points differ from their elements in a span that repeats alone"));
}

// Conduction along the surface changes temperatures; what follows each element for itself does not know it.
TEST_F(RoofInWeather, HeatGoesAlongTheSurfaceOnRequest) {
  const std::string few = "dirsig-render sim.yaml --heat-only --paths 2 --set heat.elements=60" + kPlain + "-o ";
  const std::string alone = " --set heat.final_gather=false", lateral = " --set heat.lateral_conduction=true";
  const CommandResult refused = run(few + "never" + lateral);
  EXPECT_EQ(refused.code, 1);
  EXPECT_THAT(refused.err, HasSubstr("'final_gather'"));
  const CommandResult off = run(few + "off" + alone), on = run(few + "on" + alone + lateral);
  ASSERT_EQ(off.code, 0) << off.err;
  ASSERT_EQ(on.code, 0) << on.err;
  EXPECT_NE(read_text(folder_ / "on/heat.csv"), read_text(folder_ / "off/heat.csv"));
}

// Elements that the cameras do not see, and that matter less than a hundredth of a kelvin, are left out; the file
// knows, and refuses those who look elsewhere.
TEST_F(RoofInWeather, WhatDoesNotMatterIsLeftOut) {
  const std::string narrow =
      " --set heat.final_gather=false --set heat.elements=600 --set sensors.0.columns=12 --set sensors.0.rows=12 "
      "--set sensors.1.columns=12 "
      "--set sensors.1.rows=12 --set sensors.2.columns=12 --set sensors.2.rows=12 --paths 2" +
      kPlain;
  const CommandResult r =
      run_command("cd '" + folder_.path() +
                  "' && " SUITE_BIN_DIR "/dirsig-render sim.yaml -o out --set heat.influence_cutoff_k=0.01" + narrow);
  ASSERT_EQ(r.code, 0) << r.err;
  EXPECT_THAT(r.err, HasSubstr("elements are left out"));
  const size_t at = r.err.find("elements are left out");
  if (at != std::string::npos) std::printf("%s\n", r.err.substr(at - 20, 220).c_str());
  EXPECT_THAT(r.err, testing::Not(HasSubstr("of influence_cutoff_k")));
  // With all elements, along the same paths, what is in view is the same to the bound; with other paths it is not.
  render("whole", narrow);
  render("other", "--set heat.paths=8" + narrow);
  const auto off_whole = [&](const std::string& folder) {
    double off = 0;
    for (const char* sensor : {"night", "afternoon", "midwave"})
      for (size_t row = 0; row < 12; ++row)
        for (size_t column = 0; column < 12; ++column) {
          const std::string picture = std::string("/") + sensor + "_truth.img";
          const double all = value("whole" + picture, column, row, 0);
          EXPECT_GT(all, 250) << sensor;
          off = std::fmax(off, std::fabs(value(folder + picture, column, row, 0) - all));
        }
    return off;
  };
  const double off = off_whole("out"), off_other = off_whole("other");
  std::printf("in view, off what it is with all elements: %.2g K at most; %.2g K with other paths\n", off, off_other);
  EXPECT_LT(off, 0.01);
  EXPECT_GT(off_other, 0.01);
  render("again", "--heat out/heat.h5" + narrow);
  EXPECT_EQ(read_text(folder_ / "again/afternoon.img"), read_text(folder_ / "out/afternoon.img"));
  const CommandResult wide = run("dirsig-render sim.yaml -o wide --heat out/heat.h5 --set heat.final_gather=false");
  EXPECT_EQ(wide.code, 1);
  EXPECT_THAT(wide.err, HasSubstr("elements that the sensors may see were left out"));
}

}  // namespace
}  // namespace suite::roof_in_weather_test
