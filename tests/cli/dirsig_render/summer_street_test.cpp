// A street whose temperatures follow from weather, through both programs: what is warmer than what at which time of the
// day, a file of temperatures used again, and what is refused.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <sstream>

#include "base/files.h"
#include "formats/envi/envi.h"
#include "support/run_command.h"

namespace suite::summer_street_test {
using testing::HasSubstr;

namespace {

const std::string kBin = SUITE_BIN_DIR "/";
const std::string kFew = " --set heat.elements=800 --set heat.paths=16 --set heat.step_s=1200";

// The cameras that are not looked at, so small.
std::string small_cameras(int first) {
  std::string sets;
  for (int s = first; s < 4; ++s) sets += strf(" --set sensors.%d.columns=20 --set sensors.%d.rows=15", s, s);
  return sets;
}

class SummerStreet : public testing::Test {
 protected:
  SummerStreet() { run_command("cp -r " SUITE_SOURCE_DIR "/sample_scenes/summer_street/. " + folder_.path()); }
  CommandResult run(const std::string& command) {
    return run_command("cd " + folder_.path() + " && " + kBin + command);
  }
  void prepare() {
    const CommandResult prep = run("scene-prep scene.yaml -o scene.h5 -q");
    ASSERT_EQ(prep.code, 0) << prep.err;
  }
  void change(const std::string& file, const std::string& from, const std::string& to) {
    std::string text = read_text(folder_ / file);
    const size_t at = text.find(from);
    ASSERT_NE(at, std::string::npos) << from;
    write_file(folder_ / file, text.replace(at, from.size(), to));
  }
  // Kelvin by material and hour, from heat.csv.
  std::map<std::pair<std::string, int>, double> table(const std::string& file) {
    std::istringstream in(read_text(folder_ / file));
    std::map<std::pair<std::string, int>, double> out;
    std::string line;
    std::getline(in, line);
    while (std::getline(in, line)) {
      std::vector<std::string> words;
      std::istringstream split(line);
      for (std::string word; std::getline(split, word, ',');) words.push_back(word);
      const double hour = std::stod(words[0]) / 3600;
      if (std::fabs(hour - std::round(hour)) < 0.2)
        out[{words[2], static_cast<int>(std::lround(hour))}] = std::stod(words[4]);
    }
    return out;
  }
  TempFolder folder_;
};

TEST_F(SummerStreet, RoofsCrossTheRoadTwiceADay) {
  prepare();
  const CommandResult heat = run("dirsig-render sim.yaml -o out --heat-only" + kFew);
  ASSERT_EQ(heat.code, 0) << heat.err;
  EXPECT_THAT(heat.err, HasSubstr("standard error by the paths"));
  EXPECT_THAT(heat.err, HasSubstr("W/m2: sunlight"));
  EXPECT_THAT(heat.err, testing::Not(HasSubstr("instances move")));
  EXPECT_THAT(heat.err, HasSubstr("48 % of a body's light at 300 K"));
  auto kelvin = table("out/heat.csv");
  std::printf("shingle %.1f %.1f, asphalt %.1f %.1f, lawn %.1f %.1f, leaf %.1f %.1f K at 4 and 12 h\n",
              kelvin[{"shingle", 4}], kelvin[{"shingle", 12}], kelvin[{"asphalt", 4}], kelvin[{"asphalt", 12}],
              kelvin[{"lawn", 4}], kelvin[{"lawn", 12}], kelvin[{"leaf", 4}], kelvin[{"leaf", 12}]);
  EXPECT_GT((kelvin[{"shingle", 12}]), (kelvin[{"asphalt", 12}] + 8));
  EXPECT_LT((kelvin[{"shingle", 4}]), (kelvin[{"asphalt", 4}] - 3));
  EXPECT_GT((kelvin[{"asphalt", 12}]), (kelvin[{"lawn", 12}] + 8));
  // Leaves have no heat capacity: near the air's 288 K before dawn; at noon they evaporate, which cools them below its
  // 302 K.
  EXPECT_GT((kelvin[{"leaf", 12}]), 295);
  EXPECT_LT((kelvin[{"leaf", 12}]), 302.5);
  EXPECT_NEAR((kelvin[{"leaf", 4}]), 288, 4);

  // Another run takes them from the file, and sees what a run that finds them sees.
  const std::string small =
      " -q --set sensors.0.columns=40 --set sensors.0.rows=30 --set sensors.0.pitch_um=300 --set sensors.0.paths=4"
      " --set sensors.1.paths=1 --set sensors.2.paths=1 --set sensors.3.paths=1" +
      small_cameras(1);
  const CommandResult again = run("dirsig-render sim.yaml -o again --heat out/heat.h5" + kFew + small);
  ASSERT_EQ(again.code, 0) << again.err;
  EXPECT_FALSE(file_exists(folder_ / "again/heat.h5"));
  const CommandResult anew = run("dirsig-render sim.yaml -o anew" + kFew + small);
  ASSERT_EQ(anew.code, 0) << anew.err;
  const EnviImage a(folder_ / "again/dawn.img"), b(folder_ / "anew/dawn.img");
  EXPECT_EQ(a.read_lines(0, 30), b.read_lines(0, 30));

  // Truth tells how warm it is, and how well that is known.
  const EnviImage truth(folder_ / "anew/dawn_truth.img");
  const std::vector<double> all = truth.read_lines(0, 30);
  const size_t bands = all.size() / (30 * 40);
  double warmest = 0, worst = 0;
  for (size_t p = 0; p < 30 * 40; ++p)
    warmest = std::fmax(warmest, all[p * bands]), worst = std::fmax(worst, all[p * bands + 1]);
  std::printf("truth before dawn: up to %.1f K, errors up to %.2f K\n", warmest, worst);
  EXPECT_GT(warmest, 285);
  EXPECT_LT(warmest, 300);
  EXPECT_GT(worst, 0.01);
  EXPECT_LT(worst, 3);

  // It belongs to its scene.
  change("scene.yaml", "[24, 15, 0]", "[25, 15, 0]");
  prepare();
  const CommandResult other = run("dirsig-render sim.yaml -o other --heat out/heat.h5 -q" + kFew);
  EXPECT_EQ(other.code, 1);
  EXPECT_THAT(other.err, HasSubstr("is of another scene"));
}

TEST_F(SummerStreet, WhatIsMissingIsToldAtItsPlace) {
  prepare();
  CommandResult r = run("dirsig-render sim.yaml -o out -q --set weather=null");
  EXPECT_EQ(r.code, 1);
  EXPECT_THAT(r.err, HasSubstr("sim.yaml:6:7: error: the balance of heat needs weather"));
  r = run("dirsig-render sim.yaml -o out -q --set weather=null --set heat=null");
  EXPECT_EQ(r.code, 1);
  EXPECT_THAT(r.err, HasSubstr("follows from weather, which is not given"));
  r = run("dirsig-render sim.yaml -o out -q --set epoch=2001-08-14T07:00:00Z");
  EXPECT_EQ(r.code, 1);
  EXPECT_THAT(r.err, HasSubstr("denver_july.epw"));
  r = run("dirsig-render sim.yaml -o out -q --set heat.elements=0");
  EXPECT_EQ(r.code, 1);
  EXPECT_THAT(r.err, HasSubstr("elements"));
  r = run("dirsig-render sim.yaml -o out -q --set sensors.0.time_s=-3600");
  EXPECT_EQ(r.code, 1);
  EXPECT_THAT(r.err, HasSubstr("lie on both sides of one, at 2001-07-14T06:59:00Z"));
  r = run("dirsig-render sim.yaml -o out -q --set sensors.0.time_s=-90000");
  EXPECT_EQ(r.code, 1);
  EXPECT_THAT(r.err, HasSubstr("more than one day of temperatures"));
  EXPECT_THAT(r.err, HasSubstr("'from: 2001-07-12T06:59:00Z, to: "));
  // A material nobody gave a temperature.
  change("scene.yaml",
         "    temperature: {model: heat, convection: tarp, back: air, back_k: 305, back_film_w_m2_k: 1}\n", "");
  prepare();
  r = run("dirsig-render sim.yaml -o out -q" + kFew);
  EXPECT_EQ(r.code, 1);
  EXPECT_THAT(r.err, HasSubstr("material 'shingle' has no temperature, and its surroundings' are to be found"));
}

// Nothing thermal runs where no band sees it.
TEST_F(SummerStreet, LightOfTheDayNeedsNoTemperatures) {
  change("scene.yaml", "windows_um: [[8, 14]]", "windows_um: [[0.5, 0.6]]");
  prepare();
  const CommandResult r = run(
      "dirsig-render sim.yaml -o out --set sensors.0.bands.0.center_um=0.55 --set sensors.0.bands.0.fwhm_um=0.02 "
      "--set sensors.1.bands.0.center_um=0.55 --set sensors.1.bands.0.fwhm_um=0.02 --set "
      "sensors.2.bands.0.center_um=0.55 "
      "--set sensors.2.bands.0.fwhm_um=0.02 --set sensors.3.bands.0.center_um=0.55 --set "
      "sensors.3.bands.0.fwhm_um=0.02 "
      "--set sensors.0.units=null --set sensors.1.units=null --set sensors.2.units=null --set sensors.3.units=null "
      "--set sensors.0.truth=[tag] --set sensors.1.truth=[tag] --set sensors.2.truth=[tag] --set sensors.3.truth=[tag] "
      "--set atmosphere=null --paths 1" +
      small_cameras(0));
  ASSERT_EQ(r.code, 0) << r.err;
  EXPECT_THAT(r.err, testing::Not(HasSubstr("exchange of infrared")));
  EXPECT_FALSE(file_exists(folder_ / "out/heat.h5"));
}

}  // namespace

}  // namespace suite::summer_street_test
