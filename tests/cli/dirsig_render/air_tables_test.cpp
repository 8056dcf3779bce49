// Spectra of another program as the air of a simulation, and decks of it in our air, through the programs.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "formats/envi/envi.h"
#include "math/vec.h"
#include "support/programs_kit.h"
#include "support/tape7_kit.h"

namespace suite::air_tables_test {
namespace {

using test::MadeRow;
using test::MadeRun;
using testing::HasSubstr;

constexpr double kPasses = 0.6, kBothWays = 0.42, kPath = 2.4e-8, kSun = 5e-6;  // per 1/cm

MadeRun view(double zenith_deg) {
  MadeRun run;
  run.zenith_deg = zenith_deg;
  run.range_km = -3 / std::cos(zenith_deg * kDegree);
  run.row = [](double) { return MadeRow{kPasses, 0, kPath, kBothWays, kSun}; };
  return run;
}

const char* const kScene = R"(scene: 1
materials:
  ground: {model: lambert, reflectance: 0.3}
objects:
  plane: {plane: {width: 4000, depth: 4000}, material: ground}
world:
  - {place: plane}
)";

class AirTablesOfOthers : public ProgramsTest<AirTablesOfOthers> {
 protected:
  static void SetUpTestSuite() {
    make_folder();
    prepare(kScene);
    write("run.tp7", test::tape7_text({view(170), view(180)}));
  }
  static void write(const std::string& name, const std::string& text) {
    write_file(*folder_ / name, std::string_view(text));
  }
  static CommandResult run_deck(const std::string& deck) { return run("dirsig-render --air " + deck); }
  static CommandResult look(const std::string& tables, const std::string& out, const std::string& more = {},
                            const std::string& look_at = "[0, 0, 0]") {
    write("sim.yaml",
          "scene: scene.h5\nsun: {direction: {zenith_deg: 40, azimuth_deg: 90}, irradiance: 1800, collimated: true}\n"
          "atmosphere: {tables: " +
              tables +
              "}\nsensors:\n  - {kind: frame_camera, name: eye, columns: 6, rows: 4, "
              "pitch_um: 100, focal_length_mm: 50, position_m: [0, 0, 3000], look_at_m: " +
              look_at + ", paths: 4, bands: [{name: green, center_um: 0.55, fwhm_um: 0.02, shape: rectangular}]}\n" +
              more);
    return run("dirsig-render sim.yaml -o " + out);
  }
};

TEST_F(AirTablesOfOthers, AreTheAirOfAPicture) {
  const CommandResult r = look("[run.tp7], angle_tolerance_deg: 2", "out");
  ASSERT_EQ(r.code, 0) << r.err;
  const double square = 1e8 / (0.55 * 0.55);  // wavenumbers squared: W/(m2 sr um) of the files' unit
  const double expected = kPath * square + 0.3 / kPi * 1800 * std::cos(40 * kDegree) * kBothWays;
  const EnviImage image(*folder_ / "out/eye.img");
  for (const double v : image.read_lines(0, 4)) EXPECT_NEAR(v / expected, 1, 1e-3);
  // What it stands for and leaves out.
  for (const char* words :
       {"lines of sight: 2 runs over view zenith angle 170 to 180 degrees", "two-way column", "adjacency",
        "the runs have one ground", "changes of the air from place to place", "no run is of the sky"})
    EXPECT_THAT(r.err, HasSubstr(words));
}

TEST_F(AirTablesOfOthers, BadInputIsTold) {
  const auto told = [&](const std::string& tables, const std::string& more = {},
                        const std::string& look_at = "[0, 0, 0]") {
    const CommandResult r = look(tables, "bad", more, look_at);
    EXPECT_EQ(r.code, 1) << r.err;
    EXPECT_FALSE(file_exists(*folder_ / "bad/eye.img"));
    return r.err;
  };
  const std::string whole = test::run_text(view(180));
  write("cut.tp7", whole.substr(0, whole.size() / 2));
  EXPECT_THAT(told("[cut.tp7]"), AllOf(HasSubstr("cut.tp7:"), HasSubstr("error:")));
  MadeRun dark = view(180);
  dark.mode = 0;
  write("dark.tp7", test::run_text(dark));
  EXPECT_THAT(told("[dark.tp7]"), HasSubstr("has no path radiance"));
  MadeRun red = view(180);
  red.first = 10000, red.last = 15000;
  write("red.tp7", test::run_text(red));
  EXPECT_THAT(told("[red.tp7]"),
              AllOf(HasSubstr("sim.yaml:3:"), HasSubstr("the tables of the atmosphere reach from 0.666667 to 1 um, and "
                                                        "band 'green' of sensor 'eye'")));
  EXPECT_THAT(told("[run.tp7]", "", "[3000, 0, 0]"),
              AllOf(HasSubstr("sim.yaml:3:"), HasSubstr("and the runs have 170 to 180 degrees"),
                    HasSubstr("angle_tolerance_deg")));
  EXPECT_THAT(told("[run.tp7]", "moon: {direction: {zenith_deg: 10, azimuth_deg: 0}, phase_deg: 0}\n"),
              HasSubstr("a further moon"));
}

// A deck of a path to the ground in our air, beside what made-up air sends.
TEST_F(AirTablesOfOthers, DecksAreComputedInOurAir) {
  MadeRun made;
  made.mode = 1, made.first = 2060, made.last = 2120, made.step = 1;
  made.row = [](double) { return MadeRow{0.5, 1e-7, 0, 1, 0}; };
  write("slant.tp7", test::run_text(made));
  write("slant.tp5",
        "    6    2    1    0    0    0    0    0    0    0    0    0    0   0.000   0.00\n"
        "    0    0    0    0    0    0     0.000     0.000     0.000     0.000     0.000\n"
        "     3.000     0.000   180.000     3.000\n"
        "    2060.0    2120.0       1.0       1.0\n    0\n");
  const CommandResult alone = run_deck("slant.tp5");
  ASSERT_EQ(alone.code, 0) << alone.err;
  EXPECT_THAT(alone.out, AllOf(HasSubstr("run 1: us_standard, no haze, from 3000 m at 180 degrees from the zenith over "
                                         "3000 m; scattered once"),
                               HasSubstr("2060.0 to 2080.0")));
  EXPECT_EQ(alone.out.find("difference"), std::string::npos);
  const CommandResult both = run_deck("slant.tp5 --against slant.tp7");
  ASSERT_EQ(both.code, 0) << both.err;
  double ours = 0, theirs = 0, off = 0;
  const size_t at = both.out.find("2060.0 to 2080.0");
  ASSERT_NE(at, std::string::npos) << both.out;
  ASSERT_EQ(std::sscanf(both.out.c_str() + at, "2060.0 to 2080.0 %lg %lg %lg", &ours, &theirs, &off), 3);
  EXPECT_GT(ours, 0.2);
  EXPECT_LT(ours, 0.95);
  EXPECT_NEAR(theirs, 0.5, 1e-6);
  EXPECT_NEAR(off, ours - theirs, 1e-4);
  EXPECT_THAT(both.out, HasSubstr("difference: rms"));

  MadeRun other = made;
  other.first = 2070;
  write("other.tp7", test::run_text(other));
  const CommandResult wrong = run_deck("slant.tp5 --against other.tp7");
  EXPECT_EQ(wrong.code, 1);
  EXPECT_THAT(wrong.err, HasSubstr("this run reaches from 2070 to 2120 1/cm, the deck's from 2060 to 2120"));
  EXPECT_EQ(run_deck("slant.tp5 --against run.tp7").code, 1);

  // A run whose last row is one step short of card 4's end.
  other = made;
  other.last = 2119;
  write("short.tp7", test::run_text(other));
  const CommandResult one_short = run_deck("slant.tp5 --against short.tp7");
  EXPECT_EQ(one_short.code, 0) << one_short.err;
  EXPECT_EQ(run("dirsig-render sim.yaml --against slant.tp7").code, 2);
}

// ITYPE 1: the level of H1 over RANGE, whatever ANGLE and H2 say.
TEST_F(AirTablesOfOthers, HorizontalPathsStayLevel) {
  const auto path = [&](const char* card_3, double& transmittance) {
    write("level.tp5",
          std::string("    6    1    0    0    0    0    0    0    0    0    0    0    0   0.000   0.00\n"
                      "    0    0    0    0    0    0     0.000     0.000     0.000     0.000     0.000\n") +
              card_3 + "    2060.0    2080.0       1.0       1.0\n    0\n");
    const CommandResult said = run_deck("level.tp5");
    EXPECT_EQ(said.code, 0) << said.err;
    const size_t at = said.out.find("2060.0 to 2080.0");
    if (at != std::string::npos) std::sscanf(said.out.c_str() + at, "2060.0 to 2080.0 %lg", &transmittance);
    return said.out;
  };
  double level = 0, tilted = 0, half = 0;
  path("     1.000     0.000    90.000     1.000\n", level);
  const std::string said = path("     1.000     3.000    45.000     1.000\n", tilted);
  path("     1.000     0.000     0.000     0.500\n", half);
  EXPECT_GT(level, 0.05);
  EXPECT_LT(level, 0.95);
  EXPECT_EQ(level, tilted);
  EXPECT_GT(half, level);
  EXPECT_THAT(said, HasSubstr("from 1000 m along its level (ITYPE 1) over 1000 m; scattered once"));
  EXPECT_THAT(
      said,
      HasSubstr("not followed here: H2 3.000 (card 3, columns 11 to 20), ANGLE 45.000 (card 3, columns 21 to 30)"));
}

}  // namespace
}  // namespace suite::air_tables_test
