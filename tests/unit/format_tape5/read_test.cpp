// Decks of LOWTRAN and MODTRAN: real ones, repetitions, units, and their faults.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/files.h"
#include "formats/tape5/tape5.h"
#include "math/vec.h"
#include "tests/support/message_of.h"

namespace suite::format_tape5_read_test {
namespace {

using testing::HasSubstr;

const std::string kFolder = SUITE_TEST_DATA "/modtran/";

TEST(Tape5, RealDecks) {
  const std::vector<Tape5Run> runs = read_tape5(kFolder + "path1000.tape5");
  ASSERT_EQ(runs.size(), 1u);
  const Tape5Run& r = runs[0];
  EXPECT_EQ(r.model, 1);
  EXPECT_EQ(r.path_type, 2);
  EXPECT_EQ(r.mode, 2);
  EXPECT_TRUE(r.many_scatterings);
  EXPECT_FALSE(r.surface_temperature);
  EXPECT_EQ(r.co2_ppm, 400);
  EXPECT_EQ(r.haze, 1);
  EXPECT_FALSE(r.visibility);
  EXPECT_EQ(r.observer_height, 0);
  EXPECT_NEAR(*r.zenith, 89 * kDegree, 1e-15);
  EXPECT_EQ(r.range, 1000);
  EXPECT_EQ(r.day, 1);
  EXPECT_EQ(*r.hour, 11.55);
  EXPECT_EQ(r.first, 12000);
  EXPECT_EQ(r.last, 14000);
  EXPECT_EQ(r.width, 1);

  const Tape5Run up = read_tape5(kFolder + "targetinimageVISSun.ltn")[0];
  EXPECT_EQ(up.path_type, 3);
  EXPECT_EQ(up.zenith, 0);
  EXPECT_FALSE(up.range);
  EXPECT_EQ(up.first, 13333.333);
  EXPECT_EQ(read_tape5(kFolder + "tape5.VIS")[0].range, 200);
}

// ITYPE 1: H1 and RANGE are the path; what else the cards say is named.
TEST(Tape5, HorizontalPathsAndFieldsThatAreNotRead) {
  const std::string deck =
      "TF  6    1    0    0    0    0    0    0    0    0    0    0    0   0.000   0.00\n"
      "fFF  2   0   400.000     0.800  0.000000F F F F F\n"
      "    1         2    0    0    0     0.000     0.000     0.000     0.000     0.000\n"
      "     0.100     0.500    45.000     5.000     0.000     0.000\n"
      "  2000.000  2100.000     5.000    20.000\n"
      "    3\n"
      "     0.100     0.000    90.000     5.000     0.000     0.000\n"
      "    0\n";
  const std::vector<Tape5Run> runs = parse_tape5(deck, "t5");
  ASSERT_EQ(runs.size(), 2u);
  EXPECT_FALSE(runs[0].zenith);
  EXPECT_EQ(runs[0].end_height, 100);
  EXPECT_EQ(runs[0].range, 5000);
  EXPECT_THAT(runs[0].unread,
              testing::ElementsAre("H2OSTR 0.800 (card 1A, columns 21 to 30)", "IVULCN 2 (card 2, columns 14 to 15)",
                                   "H2 0.500 (card 3, columns 11 to 20)", "ANGLE 45.000 (card 3, columns 21 to 30)"));
  EXPECT_THAT(runs[1].unread,
              testing::ElementsAre("H2OSTR 0.800 (card 1A, columns 21 to 30)", "IVULCN 2 (card 2, columns 14 to 15)"));
  EXPECT_TRUE(read_tape5(kFolder + "path1000.tape5")[0].unread.empty());
}

// LOWTRAN 7 has no card 1A; the deck asks for three runs.
const std::string kLowtran =
    "    6    2    2    0    0    0    0    0    0    0    0    0    0 290.000   0.10\n"
    "    1    0    0    0    0    0    10.000     0.000     0.000     0.000     0.500\n"
    "     2.000    10.000    30.000\n"
    "    2    2  172    0\n"
    "    90.000    45.000     0.000     0.000     0.000\n"
    "  2000.000  2100.000     5.000\n"
    "    3\n"
    "     3.000     0.000   180.000\n"
    "    1    2   10    0\n"
    "    50.000   350.000     0.000     0.000    12.500\n"
    "    4\n"
    "     8.000    12.000     0.100     0.200          M\n";

TEST(Tape5, RepetitionsAndUnits) {
  const std::vector<Tape5Run> runs = parse_tape5(kLowtran, "deck");
  ASSERT_EQ(runs.size(), 3u);
  EXPECT_EQ(runs[0].surface_temperature, 290);
  EXPECT_EQ(runs[0].surface_albedo, 0.1);
  EXPECT_EQ(runs[0].visibility, 10e3);
  EXPECT_EQ(runs[0].ground_height, 500);
  EXPECT_EQ(runs[0].end_height, 10e3);
  EXPECT_NEAR(*runs[0].solar_zenith, 45 * kDegree, 1e-15);
  EXPECT_NEAR(*runs[0].relative_azimuth, 90 * kDegree, 1e-15);
  EXPECT_EQ(runs[0].day, 172);
  EXPECT_EQ(runs[1].observer_height, 3000);
  EXPECT_FALSE(runs[1].solar_zenith);
  EXPECT_NEAR(*runs[1].latitude, 50 * kDegree, 1e-15);
  EXPECT_NEAR(*runs[1].longitude, -350 * kDegree, 1e-15);
  EXPECT_EQ(*runs[1].hour, 12.5);
  EXPECT_EQ(runs[1].first, 2000);
  EXPECT_EQ(runs[2].observer_height, 3000);
  EXPECT_NEAR(runs[2].first, 1e4 / 12, 1e-9);
  EXPECT_NEAR(runs[2].last, 1e4 / 8, 1e-9);
  EXPECT_NEAR(runs[2].width, 0.2 * 100, 1e-9);  // at 10 um
}

TEST(Tape5, Irradiance) {
  std::string deck = kLowtran.substr(0, kLowtran.find("     2.000"));
  deck.replace(deck.find("    2    2    0"), 15, "    3    3    0");
  const Tape5Run r =
      parse_tape5(deck + "     0.000   100.000    60.000   93\n  2000.000  2100.000     5.000\n    0\n", "d")[0];
  EXPECT_EQ(r.mode, 3);
  EXPECT_EQ(r.day, 93);
  EXPECT_NEAR(*r.zenith, 60 * kDegree, 1e-15);
}

TEST(Tape5, Faults) {
  const auto with = [&](const std::string& old, const std::string& replacement) {
    std::string t = kLowtran;
    t.replace(t.find(old), old.size(), replacement);
    return message_of([&] { parse_tape5(t, "deck"); });
  };
  EXPECT_THAT(with("    6    2", "    7    2"), HasSubstr("deck:1:1: error: profile 7 of card 1 is the user's own"));
  EXPECT_THAT(with("    6    2", "    6    9"), HasSubstr("deck:1:6: error: columns 6 to 10 of card 1 hold 9; 1 to 3"));
  EXPECT_THAT(with("    30.000", "    3o.000"),
              HasSubstr("deck:3:21: error: columns 21 to 30 of card 3 hold no number"));
  EXPECT_THAT(with("    30.000", "   230.000"), HasSubstr("hold 230; 0 to 180"));
  EXPECT_THAT(with("    2    2  172", "    2    1  172"),
              HasSubstr("deck:4:6: error: phase functions of the user's own"));
  EXPECT_THAT(with("     5.000\n", "     0.000\n"), HasSubstr("card 4 gives no band"));
  EXPECT_THAT(
      with("    10.000     0.000     0.000     0.000     0.500", "    -0.300     0.000     0.000     0.000     0.500"),
      HasSubstr("deck:2:31: error: a visibility of -0.3 km"));
  EXPECT_THAT(with("\n    3\n", "\n    2\n"), HasSubstr("repetition of kind 2"));
  EXPECT_THAT(with("          M", "          Q"), HasSubstr("the unit of card 4 is 'Q'"));
  EXPECT_THAT(with("    1    0    0    0    0    0", "    1    0    0    0    1    0"), HasSubstr("clouds of card 2"));
  EXPECT_THAT(message_of([&] { parse_tape5(kLowtran.substr(0, 200), "deck"); }),
              HasSubstr("the deck ends before card 3A2"));
  EXPECT_THAT(message_of([&] { parse_tape5("", "deck"); }), HasSubstr("the deck ends before card 1"));
}

}  // namespace
}  // namespace suite::format_tape5_read_test
