// A run in parts as a user meets it: the files of one run, two rounds where there are targets, the script that runs
// them, and parts that do not belong together.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <regex>

#include "base/error.h"
#include "support/driving_car.h"
#include "support/programs_kit.h"

namespace suite::parts_test {
namespace {

using testing::HasSubstr;

class Parts : public ProgramsTest<Parts> {
 protected:
  static void SetUpTestSuite() {
    make_folder();
    prepare(kDrivingCar);
    const std::string world = kDay, fixed = camera("a", 40, 27, 2, "32") + camera("small", 5, 3, 8, "16"),
                      target = camera("t", 33, 20, 7, "{min: 8, max: 600, relative_error: 0.01}");
    write_file(*folder_ / "fixed.yaml", std::string_view(world + fixed));
    write_file(*folder_ / "sim.yaml", std::string_view(world + fixed + target));
    for (const char* name : {"fixed", "sim"}) {
      const CommandResult r = run(strf("dirsig-render %s.yaml -o whole_%s --state -q", name, name));
      ASSERT_EQ(r.code, 0) << r.err;
    }
  }
  static std::string render(const std::string& arguments) {
    const CommandResult r = run("dirsig-render " + arguments);
    EXPECT_EQ(r.code, 0) << arguments << "\n" << r.err;
    return r.err;
  }
  static std::string script(const std::string& arguments) {
    const CommandResult r = run_command(
        "cd '" + folder_->path() +
        "' && DIRSIG_RENDER=" SUITE_BIN_DIR "/dirsig-render " SUITE_SOURCE_DIR "/scripts/parts " + arguments);
    EXPECT_EQ(r.code, 0) << arguments << "\n" << r.err;
    return r.out;
  }
  static void expect_same_folders(const std::string& one, const std::string& other) {
    suite::expect_same_folders(*folder_ / one, *folder_ / other, 10);
  }
  static void refused(const std::string& arguments, int code, const std::string& message) {
    const auto before = listing();
    const CommandResult r = run("dirsig-render " + arguments);
    EXPECT_EQ(r.code, code) << arguments << "\n" << r.err;
    EXPECT_THAT(r.err, HasSubstr(message)) << arguments;
    EXPECT_EQ(listing(), before) << arguments << " left something behind";
  }
  static std::vector<std::string> listing() {
    std::vector<std::string> all;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder_->path()))
      all.push_back(entry.path().string());
    std::sort(all.begin(), all.end());
    return all;
  }
};

TEST_F(Parts, of_fixed_counts_are_joined_in_one_round) {
  for (const int parts : {1, 3, 8}) {
    std::string folders;
    for (int k = 1; k <= parts; ++k) {
      const std::string told = render(strf("fixed.yaml -o f%d --state --part %d/%d", k, k, parts));
      EXPECT_THAT(told, HasSubstr(strf("part %d of %d has run ", k, parts)));
      EXPECT_THAT(told, HasSubstr("when all parts have, --merge joins them"));
      EXPECT_FALSE(file_exists(*folder_ / strf("f%d/a.img", k)));
      folders = strf(" f%d", k) + folders;
    }
    const std::string told = render("fixed.yaml -o joined --merge" + folders);
    EXPECT_THAT(told, HasSubstr("every problem ran the paths it was given"));
    expect_same_folders("whole_fixed", "joined");
    std::filesystem::remove_all(*folder_ / "joined");
    for (int k = 1; k <= parts; ++k) std::filesystem::remove_all(*folder_ / strf("f%d", k));
  }
}

TEST_F(Parts, with_targets_take_two_rounds) {
  for (int k = 1; k <= 3; ++k)
    EXPECT_THAT(render(strf("sim.yaml -o p%d --state --part %d/3", k, k)),
                HasSubstr("the plan for the targets of 1 capture follows from the pilots of all parts"));
  EXPECT_THAT(render("sim.yaml -o planned --merge p2 p3 p1"), HasSubstr("1 of 3 captures is planned and waits for "));
  EXPECT_TRUE(file_exists(*folder_ / "planned/a.img"));
  EXPECT_FALSE(file_exists(*folder_ / "planned/t.img"));
  for (int k = 1; k <= 3; ++k) render(strf("sim.yaml -o p%d --state --part %d/3 --plan planned -q", k, k));
  render("sim.yaml -o planned2 --merge p3 p1 p2 -q");
  expect_same_folders("whole_sim", "planned2");
  // Or one process does the second round.
  render("sim.yaml -o planned --resume -q");
  expect_same_folders("whole_sim", "planned");
  // What was joined goes on.
  render("sim.yaml -o planned2 --more 8 -q");
  render("sim.yaml -o whole_sim --more 8 -q");
  expect_same_folders("whole_sim", "planned2");
}

TEST_F(Parts, are_run_by_the_script) {
  script("2 sim.yaml script --seed 5 -q");
  render("sim.yaml -o seeded --state --seed 5 -q");
  expect_same_folders("seeded", "script");
}

// What Slurm does with array jobs, a part that was killed and is started again among them.
TEST_F(Parts, are_run_as_array_jobs) {
  write_file(*folder_ / "submit", std::string_view(R"(#!/usr/bin/env bash
echo "$*" >>submitted
array=
for a in "$@"; do case "$a" in --array=1-*) array=${a#--array=1-} ;; esac; command=$a; done
for k in $(seq "${array:-1}"); do
  export SLURM_ARRAY_TASK_ID=$k SLURM_RESTART_COUNT=0
  if [ "$array" ] && [ "$k" = 2 ]; then
    timeout -s KILL 0.2 bash -c "$command" >&2
    SLURM_RESTART_COUNT=1
  fi
  bash -c "$command" >&2 || exit 1
done
echo $$
)"));
  std::filesystem::permissions(*folder_ / "submit", std::filesystem::perms::owner_all);
  const CommandResult r =
      run_command("cd '" + folder_->path() +
                  "' && SUBMIT=./submit DIRSIG_RENDER=" SUITE_BIN_DIR "/dirsig-render " SUITE_SOURCE_DIR
                  "/scripts/parts 3 sim.yaml slurm --paths 16,700 --target-error 1% -q");
  ASSERT_EQ(r.code, 0) << r.err;
  render("sim.yaml -o alone --state --paths 16,700 --target-error 1% -q");
  expect_same_folders("alone", "slurm");
  const std::string submitted = read_text(*folder_ / "submitted");
  EXPECT_EQ(std::ranges::count(submitted, '\n'), 4);
  EXPECT_THAT(submitted, HasSubstr("--dependency=afterok:"));
}

TEST_F(Parts, that_cannot_be_are_refused) {
  for (int k = 1; k <= 3; ++k) render(strf("fixed.yaml -o q%d --state --part %d/3 -q", k, k));
  const std::string join = "fixed.yaml -o never --merge ";
  refused(join + "q1 q3", 1,
          "q1/result.state.h5: error: is one of 3 parts; missing: 2; --merge wants the folders of all parts");
  refused(join + "q1 q2 q3 q2", 1, "q2/result.state.h5: error: is part 2 of 3, and so is q2/result.state.h5");
  refused(join + "q1 q2 q4", 1, "q4/result.state.h5: error: there is no state of a part");
  refused(join + "q1 whole_fixed q3", 1,
          "whole_fixed/result.state.h5: error: is the state of a whole run, not of a part");
  refused("fixed.yaml -o never --seed 9 --merge q1 q2 q3", 1,
          "q1/result.state.h5: error: belongs to another run: its seed is 1");
  refused("sim.yaml -o never --merge q1 q2 q3", 1, "belongs to another run: its simulation is ");
  refused("fixed.yaml -o never --paths 4 --merge q1 q2 q3", 2, "of a run with another budget");
  refused("fixed.yaml -o q2 --merge q1 q2 q3", 2, "--merge into the folder of a part would replace it");
  refused("fixed.yaml -o q1 --state --part 2/3", 1,
          "q1/result.state.h5: error: is the state of part 1 of 3, which part 2 of 3 would replace");
  refused("fixed.yaml -o whole_fixed --state --part 2/3", 1,
          "is the state of the whole of a run, which part 2 of 3 would replace");
  refused("fixed.yaml -o q1 --resume --part 2/3", 1, "is the state of part 1 of 3, not of part 2 of 3");
  refused("fixed.yaml -o q1 --more 4", 1, "is the state of part 1 of 3; join the parts with --merge first");
  refused("fixed.yaml -o q1 --state --part 1/3 --plan q2", 1, "is itself the state of part 2 of 3");
  for (const char* part : {"0/3", "4/3", "2", "2/", "/3", "2/3/4", "-1/3", "2/3x", "1/100001"})
    refused(std::string("fixed.yaml -o never --state --part=") + part, 2, std::string("found '") + part + "'");
  refused("fixed.yaml -o never --part 1/3", 2, "add --state");
  refused("fixed.yaml -o never --part 1/3 --merge q1", 2, "give one of them");
  refused("fixed.yaml -o never --plan q1", 2, "--plan is for parts");
  refused("fixed.yaml -o never --study x --part 1/3", 2, "--study runs whole");
  refused("fixed.yaml -o never --state --part 1/3 --stop change", 2, "cannot be continued");
}

// --time is refused with the number of paths that it is worth, by measurement.
TEST_F(Parts, have_no_time_of_their_own) {
  const CommandResult r = run("dirsig-render fixed.yaml -o never --state --part 1/3 --time 10s -q");
  EXPECT_EQ(r.code, 2);
  std::smatch worth;
  ASSERT_TRUE(std::regex_search(r.err, worth, std::regex("3 parts of 10.0 s each are worth --paths ([0-9]+) at")))
      << r.err;
  EXPECT_GE(std::stoi(worth[1]), 16);
  EXPECT_FALSE(std::filesystem::exists(*folder_ / "never"));
}

TEST_F(Parts, are_forecast) {
  const CommandResult r = run("dirsig-render fixed.yaml --part 2/3 --dry-run");
  EXPECT_EQ(r.code, 0) << r.err;
  EXPECT_THAT(r.out, testing::ContainsRegex("part 2 of 3 runs [67] of 21 blocks of pixels"));
}

}  // namespace
}  // namespace suite::parts_test
