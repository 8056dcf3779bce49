// A run of several ranks as a user meets it: the files of one process, whatever the ranks are, one message when one of
// them fails, and runs that go on after a rank was killed. With SUITE_LONG set, at length.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <random>

#include "support/driving_car.h"
#include "support/programs_kit.h"
#include "support/ranks_kit.h"

namespace suite::ranks_test {
namespace {

using testing::AllOf;
using testing::HasSubstr;

bool at_length() { return std::getenv("SUITE_LONG") != nullptr; }

class Ranks : public ProgramsTest<Ranks> {
 protected:
  static void SetUpTestSuite() {
    make_folder();
    prepare(kDrivingCar);
    const std::string three = kDay + camera("a", 40, 27, 2, "32") + camera("small", 5, 3, 8, "2000") +
                              camera("t", 33, 20, 7, "{min: 8, max: 600, relative_error: 0.01}"),
                      longer = kDay + camera("a", 150, 100, 2, at_length() ? "300" : "60") +
                               camera("t", 80, 60, 7, "{min: 32, max: 900, relative_error: 0.005}");
    write_file(*folder_ / "sim.yaml", std::string_view(three));
    write_file(*folder_ / "longer.yaml", std::string_view(longer));
    // Many captures, so that there are always some left to write when one has failed.
    std::string many = kDay;
    for (int i = 0; i < 24; ++i) many += camera(strf("c%d", i), 150, 100, 2, "60");
    write_file(*folder_ / "many.yaml", std::string_view(many));
    write_file(*folder_ / "fixed.yaml",
               std::string_view(kDay + camera("a", 40, 27, 2, "32") + camera("b", 60, 30, 5, "16")));
    write_file(*folder_ / "rank", std::string_view("#!/bin/sh\necho $$ >pid.${OMPI_COMM_WORLD_RANK:-$PMI_RANK}\n"
                                                   "exec " SUITE_BIN_DIR "/dirsig-render \"$@\"\n"));
    std::filesystem::permissions(*folder_ / "rank", std::filesystem::perms::owner_all);
    const CommandResult r = run("dirsig-render sim.yaml -o whole --state -q");
    ASSERT_EQ(r.code, 0) << r.err;
  }
  void SetUp() override {
    if (!has_ranks()) GTEST_SKIP() << kNoRanks;
  }
  static CommandResult shell(const std::string& command) {
    return run_command("cd '" + folder_->path() + "' && " + kRanksAnywhere + command);
  }
  // mpirun of so many ranks, each of which runs `program`.
  static std::string ranks(int n, const std::string& program) { return of_ranks(n) + program; }
  static std::string render(int n, const std::string& arguments) {
    const CommandResult r = shell(ranks(n, SUITE_BIN_DIR "/dirsig-render " + arguments));
    EXPECT_EQ(r.code, 0) << n << " ranks: " << arguments << "\n" << r.err;
    return r.err;
  }
  static void alone(const std::string& arguments) {
    const CommandResult r = run("dirsig-render " + arguments);
    EXPECT_EQ(r.code, 0) << arguments << "\n" << r.err;
  }
  static void expect_same_folders(const std::string& one, const std::string& other, size_t images) {
    suite::expect_same_folders(*folder_ / one, *folder_ / other, images);
  }
  // What stands in `killed` is whole, though a rank died while it wrote.
  static void expect_no_torn_images() {
    if (!std::filesystem::exists(*folder_ / "killed")) return;
    for (const auto& entry : std::filesystem::directory_iterator(*folder_ / "killed")) {
      const std::string name = entry.path().filename().string();
      if (!name.ends_with(".img")) continue;
      EXPECT_EQ(read_bytes(entry.path()), read_bytes(*folder_ / ("whole_longer/" + name))) << "torn: " << name;
    }
  }
  static size_t times(const std::string& text, const std::string& word) {
    size_t n = 0;
    for (size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + 1)) ++n;
    return n;
  }
  // One message, once, the code as ever, and nothing left behind.
  static void refused(const std::string& command, int code, const std::string& message) {
    const CommandResult r = shell(command);
    EXPECT_EQ(r.code, code) << command << "\n" << r.err;
    EXPECT_EQ(times(r.err, message), 1u) << command << "\n" << r.err;
    EXPECT_EQ(times(r.err, "error: ") + times(r.err, "usage: ") + times(r.err, "warning: "), 1u) << r.err;
    EXPECT_FALSE(std::filesystem::exists(*folder_ / "never")) << command;
  }
};

TEST_F(Ranks, write_what_one_process_writes) {
  const std::vector<int> sizes = at_length() ? std::vector<int>{1, 2, 3, 4, 7} : std::vector<int>{2};
  for (const int n : sizes)
    for (const int threads : {1, 2}) {
      if (!at_length() && threads > 1) continue;
      const std::string told = render(n, strf("sim.yaml -o ranks --state -j %d", threads));
      EXPECT_EQ(times(told, "rendering: "), 1u) << told;
      EXPECT_EQ(times(told, "wrote ranks/t.img"), 1u) << told;
      EXPECT_EQ(read_text(*folder_ / "ranks/render.json").find("\"ranks\"") != std::string::npos, n > 1);
      expect_same_folders("whole", "ranks", 10);
      std::filesystem::remove_all(*folder_ / "ranks");
      render(n, strf("sim.yaml -o plain -q -j %d", threads));  // keeps sums only of what has a target
      std::filesystem::remove_all(*folder_ / "plain_whole");
      std::filesystem::copy(*folder_ / "whole", *folder_ / "plain_whole");
      std::filesystem::remove(*folder_ / "plain_whole/result.state.h5");
      expect_same_folders("plain_whole", "plain", 10);
      std::filesystem::remove_all(*folder_ / "plain");
    }
}

// Options that one rank alone cannot have: it says so by itself, as the others wait.
TEST_F(Ranks, started_unlike_are_reported) {
  const std::string program = SUITE_BIN_DIR "/dirsig-render sim.yaml -o never";
  const CommandResult r = shell(ranks(1, program) + " : -n 1 " + program + " --no-such-option");
  EXPECT_NE(r.code, 0) << r.err;
  EXPECT_THAT(r.err, AllOf(HasSubstr("was started with options that cannot be"), HasSubstr("[DR903]")));
}

// A laser has one place, and its pulses run in one process.
TEST_F(Ranks, refuse_laser_radars) {
  write_file(*folder_ / "lidar.yaml",
             std::string_view(std::string(kDay) +
                              "  - {kind: lidar, name: als, position_m: [0, 0, 100], look_at_m: [0, 0, 0], tasks: "
                              "[{start: 0, pulses: 2}],\n     laser: {wavelength_um: 0.55, pulse_energy_j: 1.0e-5, "
                              "rate_hz: 10, beam: {kind: gaussian, full_angle_1_e2_mrad: 1}},\n     receiver: "
                              "{aperture_mm: 100, field_of_view_mrad: 2}, gate: {start_m: 90, stop_m: 110}}\n"));
  refused(ranks(2, SUITE_BIN_DIR "/dirsig-render lidar.yaml -o never"), 2,
          "laser radars run in one process: start it without mpirun");
}

TEST_F(Ranks, go_on_and_add_paths) {
  std::filesystem::copy(*folder_ / "whole", *folder_ / "more");
  render(2, "sim.yaml -o more --more 16 -q -j 1");
  std::filesystem::copy(*folder_ / "whole", *folder_ / "alone");
  alone("sim.yaml -o alone --more 16 -q");
  expect_same_folders("alone", "more", 10);
}

// Time is worth what rank 0 finds, and all ranks plan with it.
TEST_F(Ranks, share_the_worth_of_time) {
  const std::string told = render(3, "fixed.yaml -o timed --time 1s -j 1");
  std::smatch worth;
  ASSERT_TRUE(std::regex_search(told, worth, std::regex("--paths ([0-9]+)"))) << told;
  alone("fixed.yaml -o untimed -q --paths " + worth[1].str());
  for (const char* file : {"a.img", "a_error.img", "a_truth.img", "b.img", "b_error.img"})
    EXPECT_TRUE(read_bytes(*folder_ / ("timed/" + std::string(file))) ==
                read_bytes(*folder_ / ("untimed/" + std::string(file))))
        << file << " " << worth[1];
}

// What rank 0 cannot write ends the others, too, while they work.
TEST_F(Ranks, end_together_when_one_fails_at_work) {
  const CommandResult r =
      shell("true; " + ranks(3, SUITE_BIN_DIR "/dirsig-render many.yaml -o cut -q -j 1") +
            " & m=$!; for i in $(seq 3000); do [ -d cut ] && break; sleep 0.01; done; sleep 0.3; rm -rf cut; wait $m");
  EXPECT_EQ(r.code, 1) << r.err;
  EXPECT_EQ(times(r.err, "error: "), 1u) << r.err;
  // How many of the captures were written by then is left to the machine.
  EXPECT_THAT(r.err, AllOf(HasSubstr("captures are complete"), HasSubstr("without --state the rest is lost")));
}

TEST_F(Ranks, that_differ_or_cannot_run_are_refused) {
  const std::string render = SUITE_BIN_DIR "/dirsig-render ", never = "-o never -q ";
  std::filesystem::create_directory(*folder_ / "other");
  write_file(*folder_ / "other/sim.yaml", std::string_view(kDay + camera("a", 8, 8, 3, "16")));
  const std::string pair = of_ranks(1) + render + "sim.yaml " + never + ": -n 1 ";
  const std::string there = "-wdir '" + (*folder_ / "other") + "' ";
  refused(pair + there + render + "sim.yaml " + never, 1, "scene.h5: error: no such file");
  std::filesystem::copy(*folder_ / "scene.h5", *folder_ / "other/scene.h5");
  refused(pair + there + render + "sim.yaml " + never, 1, "error: ranks differ: rank 1 on host ");
  refused(pair + render + "sim.yaml --seed 3 " + never, 1, "has command line dirsig-render sim.yaml --seed 3");
  refused(pair + render + "sim.yaml --sed 3 " + never, 2, "warning: rank 1 on host ");
  // The same program, but for a byte behind its end.
  std::filesystem::create_directory(*folder_ / "built");
  std::filesystem::copy(SUITE_BIN_DIR "/dirsig-render", *folder_ / "built/dirsig-render");
  std::ofstream(*folder_ / "built/dirsig-render", std::ios::app) << 'x';
  refused(pair + "built/dirsig-render sim.yaml " + never, 1, "rank 1 on host ");
  refused(ranks(2, render + "missing.yaml " + never), 1, "missing.yaml: error: no such file");
  refused(of_ranks(1) + there + render + "missing.yaml " + never + ": -n 1 " + render + "missing.yaml " + never, 1,
          "missing.yaml: error: no such file");
  refused(ranks(2, render + "sim.yaml -q -o /proc/never"), 1, "/proc/never: error: folder cannot be made");
  refused(ranks(3, render + "sim.yaml --nonsense " + never), 2, "unknown option '--nonsense'");
  refused(ranks(2, render + "sim.yaml --state --part 1/2 " + never), 2, "--part is for one process");
  refused(ranks(2, render + "sim.yaml --merge whole " + never), 2, "--merge is for one process");
  refused(ranks(2, render + "sim.yaml --stop change " + never), 2, "start without mpirun");
  refused(ranks(2, render + "sim.yaml --resume " + never), 1, "there is no state to continue");
}

// A rank is killed at moments drawn by lot, and others go on, in other numbers; and again, until the run is whole.
// How long a run takes is found on the way: machines are shared, and a moment that came after the end is drawn anew.
TEST_F(Ranks, are_killed_and_the_run_goes_on) {
  alone("longer.yaml -o whole_longer --state -q");
  const auto begun = std::chrono::steady_clock::now();
  render(3, "longer.yaml -o uninterrupted -q -j 1");
  double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
  std::mt19937 lot(20260);
  std::uniform_real_distribution<double> share(0.2, 1);
  const int asked = at_length() ? 20 : 2;
  int killed = 0, resumed = 0;
  for (int tries = 0; resumed < asked && tries < 20 * asked; ++tries) {
    const int n = 2 + static_cast<int>(lot() % 3), victim = static_cast<int>(lot() % n), others = 1 + (n + resumed) % 4;
    const bool state = file_exists(*folder_ / "killed/result.state.h5");
    const CommandResult r =
        shell("rm -f pid.*; " +
              ranks(n, std::string("./rank longer.yaml -o killed -q -j 1 ") + (state ? "--resume" : "--state")) +
              strf(" & m=$!; for i in $(seq 3000); do [ -s pid.%d ] && break; sleep 0.01; done; sleep %.2f; "
                   "kill -9 $(cat pid.%d); wait $m",
                   victim, share(lot) * seconds, victim));
    ASSERT_TRUE(r.code == 137 || r.code == 0) << r.code << r.err;  // 0: it was over before
    killed += r.code == 137;
    expect_no_torn_images();
    if (r.code == 0) {
      seconds *= 0.7;
      std::filesystem::remove_all(*folder_ / "killed");
      continue;
    }
    if (!file_exists(*folder_ / "killed/result.state.h5")) {
      seconds *= 1.2;
      continue;
    }
    // Every other run is finished by others, the rest is killed again.
    if (++resumed % 2 == 1 && resumed < asked) continue;
    render(others, "longer.yaml -o killed --resume -q -j 1");
    for (const auto& entry : std::filesystem::directory_iterator(*folder_ / "killed"))
      if (!file_exists(*folder_ / ("whole_longer/" + entry.path().filename().string())))
        std::filesystem::remove(entry.path());  // what the killed one was writing, beside its place
    expect_same_folders("whole_longer", "killed", 10);
    std::filesystem::remove_all(*folder_ / "killed");
  }
  EXPECT_EQ(resumed, asked) << killed << " killed, the last within " << seconds << " s";
}

}  // namespace
}  // namespace suite::ranks_test
