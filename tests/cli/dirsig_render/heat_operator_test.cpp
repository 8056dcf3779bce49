// What paths found for temperatures from weather, kept: other weather without new rays, searches that are killed and go
// on, ranks that do not find the same again, and what is refused.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <sstream>

#include "base/error.h"
#include "base/files.h"
#include "support/programs_kit.h"
#include "support/ranks_kit.h"

namespace suite::heat_operator_test {
namespace {

using testing::HasSubstr;
using testing::Not;

// What is asked does not depend on gases, whose bins each run would find anew.
const std::string kFewPaths =
    " --set heat.paths=16 --set heat.step_s=3600 --set heat.keep=operator --set atmosphere.gases=none";
const std::string kFew = " --set heat.elements=150" + kFewPaths;
// As many as a search needs that lives until it is killed: three pieces of the sunlight of each interval of rest.
const std::string kRests =
    " --heat-only --set scene=rests.h5 --set heat.save_every_s=0 --set heat.elements=300" + kFewPaths;

class HeatOperatorRun : public ProgramsTest<HeatOperatorRun> {
 protected:
  static void SetUpTestSuite() {
    make_folder();
    run_command("cp -r " SUITE_SOURCE_DIR "/sample_scenes/summer_street/. " + folder_->path());
    // One camera of the four, which look at the same: bins through the air are found for each.
    std::string sim = read_text(*folder_ / "sim.yaml");
    const std::string camera = "  - kind: frame_camera\n";
    const size_t second = sim.find(camera, sim.find(camera) + 1);
    ASSERT_NE(second, std::string::npos);
    sim.erase(second);
    write_file(*folder_ / "sim.yaml", std::string_view(sim));
    // No car leaves on a date of its own, so that other days have the same scene.
    std::string scene = read_text(*folder_ / "scene.yaml");
    const std::string leaves = ", disappears: 2001-07-14T23:00:00Z";
    ASSERT_NE(scene.find(leaves), std::string::npos);
    write_file(*folder_ / "leaving.yaml", std::string_view(scene));
    scene.erase(scene.find(leaves), leaves.size());
    write_file(*folder_ / "scene.yaml", std::string_view(scene));
    const CommandResult prep = run("scene-prep scene.yaml -o scene.h5 -q");
    ASSERT_EQ(prep.code, 0) << prep.err;
    const CommandResult first = run("dirsig-render sim.yaml -o first --heat-only" + kFew);
    ASSERT_EQ(first.code, 0) << first.err;
    EXPECT_THAT(first.err, HasSubstr("heat: sunlight"));
    // The scene whose car leaves, found once for the tests that ask about it.
    ASSERT_EQ(run("scene-prep leaving.yaml -o rests.h5 -q").code, 0);
    rests_ = run("dirsig-render sim.yaml -o rests" + kRests);
    ASSERT_EQ(rests_.code, 0) << rests_.err;
    write_file(*folder_ / "warmer.epw", std::string_view(warmer(read_text(*folder_ / "denver_july.epw"))));
  }
  // The same days with air 8 degrees warmer and a quarter of the beam (columns 7 and 15 of EPW), after 8 lines of head.
  static std::string warmer(const std::string& epw) {
    std::istringstream in(epw);
    std::string out, line;
    for (int number = 0; std::getline(in, line); ++number) {
      if (number >= 8) {
        std::vector<std::string> words;
        std::istringstream split(line);
        for (std::string word; std::getline(split, word, ',');) words.push_back(word);
        words[6] = strf("%.1f", std::stod(words[6]) + 8), words[14] = strf("%.0f", std::stod(words[14]) / 4);
        line.clear();
        for (size_t k = 0; k < words.size(); ++k) line += (k ? "," : "") + words[k];
      }
      out += line + "\n";
    }
    return out;
  }
  static bool there(const std::string& name) { return file_exists(*folder_ / name); }
  static std::string text(const std::string& name) { return read_text(*folder_ / name); }
  static CommandResult rests_;
};
CommandResult HeatOperatorRun::rests_;

TEST_F(HeatOperatorRun, OtherWeatherIsThatOfAFreshSearch) {
  ASSERT_TRUE(there("first/heat_operator.h5"));
  EXPECT_FALSE(std::filesystem::exists(*folder_ / "first/heat_operator.pieces"));
  const std::string weather = " --set weather.file=warmer.epw --heat-only" + kFew;
  const CommandResult again = run("dirsig-render sim.yaml -o again --heat-operator first/heat_operator.h5" + weather);
  ASSERT_EQ(again.code, 0) << again.err;
  EXPECT_THAT(again.err, HasSubstr("no new rays"));
  EXPECT_THAT(again.err, Not(HasSubstr("heat: sunlight")));
  const CommandResult anew = run("dirsig-render sim.yaml -o anew" + weather);
  ASSERT_EQ(anew.code, 0) << anew.err;
  EXPECT_THAT(anew.err, HasSubstr("heat: sunlight"));
  // Kelvin to 1e-4 there; all that is in the file but its command line is compared by the format's own test.
  EXPECT_EQ(text("again/heat.csv"), text("anew/heat.csv"));
  EXPECT_NE(text("again/heat.csv"), text("first/heat.csv"));
  // The folder's own is found without being named, and gives the same temperatures.
  const CommandResult own = run("dirsig-render sim.yaml -o again" + weather);
  ASSERT_EQ(own.code, 0) << own.err;
  EXPECT_THAT(own.err, HasSubstr("no new rays"));
  EXPECT_EQ(text("again/heat.csv"), text("anew/heat.csv"));
}

// Elements are those of the file, cut by the sun of its day.
TEST_F(HeatOperatorRun, TheNextDayNeedsNoNewRays) {
  const std::string next = "--heat-only --set epoch=2001-07-15T07:00:00Z" + kFew;
  const CommandResult day = run("dirsig-render sim.yaml -o next --heat-operator first/heat_operator.h5 " + next);
  ASSERT_EQ(day.code, 0) << day.err;
  EXPECT_THAT(day.err, HasSubstr("no new rays; the sun is at most 0.1"));
  EXPECT_THAT(day.err, Not(HasSubstr("heat: sunlight")));
  EXPECT_NE(text("next/heat.csv"), text("first/heat.csv"));
}

// A car that leaves on a date is another scene on the next day.
TEST_F(HeatOperatorRun, WhatLeavesOnItsDateIsAnotherScene) {
  const CommandResult day =
      run("dirsig-render sim.yaml -o left --heat-operator rests/heat_operator.h5 --set epoch=2001-07-15T07:00:00Z" +
          kRests);
  EXPECT_EQ(day.code, 1);
  EXPECT_THAT(day.err, HasSubstr("was found with another scene"));
}

// What comes and goes has rows of its own in later intervals of rest: they go on where they were, and are read again.
TEST_F(HeatOperatorRun, IntervalsOfRestGoOnToTheSameBits) {
  const std::string& more = kRests;
  EXPECT_THAT(rests_.err, HasSubstr("2 intervals of rest, which change at 57600 s"));
  const std::string pieces = *folder_ / "part/heat_operator.pieces";
  run_command("cd '" + folder_->path() + "' && { " SUITE_BIN_DIR "/dirsig-render sim.yaml -o part" + more +
              " & pid=$!; while ! ls '" + pieces +
              "' 2>/dev/null | grep -q '^sunlight.*h5$' && kill -0 $pid 2>/dev/null; do sleep 0.01; done; kill -9 "
              "$pid; wait $pid; }");
  EXPECT_FALSE(there("part/heat.h5"));
  const CommandResult rest = run("dirsig-render sim.yaml -o part" + more);
  ASSERT_EQ(rest.code, 0) << rest.err;
  EXPECT_EQ(text("part/heat.csv"), text("rests/heat.csv"));
  const CommandResult again = run("dirsig-render sim.yaml -o rests" + more);
  ASSERT_EQ(again.code, 0) << again.err;
  EXPECT_THAT(again.err, HasSubstr("no new rays"));
  EXPECT_EQ(text("part/heat.csv"), text("rests/heat.csv"));
  const CommandResult read = run("dirsig-render sim.yaml -o read --heat rests/heat.h5" + more);
  EXPECT_EQ(read.code, 0) << read.err;
  // More than are allowed is told; without them it is as before there were any.
  const CommandResult one = run("dirsig-render sim.yaml -o one --set heat.intervals=1" + more);
  ASSERT_EQ(one.code, 0) << one.err;
  EXPECT_THAT(one.err, HasSubstr("for their share of it, evenly"));
  EXPECT_NE(text("one/heat.csv"), text("rests/heat.csv"));
}

TEST_F(HeatOperatorRun, TwoDaysLaterFindsOnlyItsSunlight) {
  const CommandResult day =
      run("dirsig-render sim.yaml -o day --heat-operator first/heat_operator.h5 --heat-only "
          "--set epoch=2001-07-16T07:00:00Z" +
          kFew);
  ASSERT_EQ(day.code, 0) << day.err;
  EXPECT_THAT(day.err, HasSubstr("the sun is elsewhere"));
  EXPECT_THAT(day.err, HasSubstr("heat: sunlight"));
  EXPECT_THAT(day.err, Not(HasSubstr("heat: exchange of infrared")));
  EXPECT_TRUE(there("day/heat_operator.h5"));
}

TEST_F(HeatOperatorRun, AKilledSearchGoesOnToTheSameBits) {
  // Seven pieces of the sunlight.
  const std::string more = " --heat-only --set heat.elements=800 --set heat.save_every_s=0" + kFewPaths;
  const CommandResult whole = run("dirsig-render sim.yaml -o entire" + more);
  ASSERT_EQ(whole.code, 0) << whole.err;
  const std::string pieces = *folder_ / "killed/heat_operator.pieces";
  // Killed when a few pieces of the sunlight are there, and again in the middle of what was left.
  const std::string start =
      "cd '" + folder_->path() + "' && { " SUITE_BIN_DIR "/dirsig-render sim.yaml -o killed" + more;
  const auto killed_at = [&](int count) {
    return run_command(start + " & pid=$!; n=0; while [ $(ls '" + pieces +
                       "' 2>/dev/null | grep -c '^sunlight.*h5$') -lt " + std::to_string(count) +
                       " ] && kill -0 $pid 2>/dev/null; do sleep 0.02; done; kill -9 $pid; wait $pid; }");
  };
  EXPECT_EQ(killed_at(2).code, 137);
  EXPECT_FALSE(there("killed/heat_operator.h5"));
  EXPECT_EQ(killed_at(4).code, 137);
  EXPECT_FALSE(there("killed/heat.h5"));
  const CommandResult rest = run("dirsig-render sim.yaml -o killed" + more);
  ASSERT_EQ(rest.code, 0) << rest.err;
  EXPECT_EQ(text("killed/heat.csv"), text("entire/heat.csv"));
  // The files differ in their command lines alone, which are as long.
  const std::vector<std::byte> a = read_bytes(*folder_ / "killed/heat_operator.h5"),
                               b = read_bytes(*folder_ / "entire/heat_operator.h5");
  EXPECT_GT(a.size(), 100000u);
  size_t differ = 0;
  for (size_t k = 0; k < std::min(a.size(), b.size()); ++k) differ += a[k] != b[k];
  EXPECT_LT(differ, 200u);
  EXPECT_FALSE(std::filesystem::exists(pieces));
}

TEST_F(HeatOperatorRun, WhatDoesNotFitIsRefused) {
  const auto refused = [](const std::string& arguments, const std::string& message, int code = 1) {
    const CommandResult r = run("dirsig-render sim.yaml --heat-only " + arguments);
    EXPECT_EQ(r.code, code) << r.err;
    EXPECT_THAT(r.err, HasSubstr(message)) << arguments;
  };
  const std::string first = "-o refused --heat-operator first/heat_operator.h5" + kFew;
  refused(first + " --set heat.elements=200", "first/heat_operator.h5");
  refused(first + " --set heat.elements=200", "another set of elements");
  refused(first + " --set heat.paths=32", "another number of paths (16, here 32)");
  refused(first + " --seed 5", "another seed");
  refused("-o first --seed 5" + kFew, "another seed");
  refused("-o refused --heat-operator none.h5" + kFew, "none.h5");
  refused("-o refused --heat-operator first/heat.h5" + kFew, "holds no paths");
  refused("-o refused --heat first/heat.h5 --heat-operator first/heat_operator.h5", "give one of both", 2);
  refused("-o refused --set heat.keep=everything", "keep: operator");
  EXPECT_FALSE(there("refused/heat.h5"));
}

TEST_F(HeatOperatorRun, OneRankFindsForAll) {
  if (!has_ranks()) GTEST_SKIP() << kNoRanks;
  const std::string small =
      " -q --set sensors.0.columns=20 --set sensors.0.rows=15 --set sensors.0.pitch_um=600 --set sensors.0.paths=2";
  // The same temperatures as of a search of its own: OtherWeatherIsThatOfAFreshSearch.
  const CommandResult alone =
      run("dirsig-render sim.yaml -o alone --heat-operator first/heat_operator.h5" + kFew + small);
  ASSERT_EQ(alone.code, 0) << alone.err;
  const CommandResult ranks = run_command("cd '" + folder_->path() + "' && " + kRanksAnywhere + of_ranks(2) +
                                          SUITE_BIN_DIR "/dirsig-render sim.yaml -o ranks" + kFew + small);
  ASSERT_EQ(ranks.code, 0) << ranks.err;
  EXPECT_EQ(read_bytes(*folder_ / "ranks/dawn.img"), read_bytes(*folder_ / "alone/dawn.img"));
  EXPECT_EQ(text("ranks/heat.csv"), text("alone/heat.csv"));
}

}  // namespace
}  // namespace suite::heat_operator_test
