// Every way out of an executable: what it prints, where, and with which exit code.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/version.h"
#include "support/run_command.h"

namespace suite::run_app_test {
using testing::HasSubstr;
using testing::Not;

namespace {
CommandResult toy(const std::string& arguments) { return run_command(std::string(SUITE_TOY_APP) + " " + arguments); }
}  // namespace

TEST(RunApp, FineIsZeroAndResultsGoToStandardOutput) {
  const CommandResult r = toy("fine --name 'a b' --size=2 -j 3");
  EXPECT_EQ(r.code, 0);
  EXPECT_EQ(r.out, "name=a b size=2 strict=0 given=1 threads=3 command=toy fine --name 'a b' --size=2 -j 3\n");
  EXPECT_EQ(r.err, "a note\nwarning: a warning\n");
  EXPECT_EQ(toy("fine -q").err, "warning: a warning\n");
  EXPECT_THAT(toy("fine").out, HasSubstr("name=unnamed size=1.5 strict=0 given=0"));
}

TEST(RunApp, BadInputIsOneMessageAndOne) {
  const CommandResult r = toy("error -q");
  EXPECT_EQ(r.code, 1);
  EXPECT_EQ(r.err, "warning: a warning\nf.yaml:3:1: error: wrong; do right\n  x: y\n  ^\n");
  EXPECT_EQ(r.out, "");
  EXPECT_EQ(toy("refuse").code, 1);
  EXPECT_EQ(toy("memory").code, 1);
  EXPECT_THAT(toy("memory").err, HasSubstr("toy: error: out of memory"));
}

TEST(RunApp, BadUsageIsTwoWithTheNearestNameAndAPointerToHelp) {
  CommandResult r = toy("fine --sise 2");
  EXPECT_EQ(r.code, 2);
  EXPECT_EQ(r.err, "toy: usage: unknown option '--sise'; did you mean '--size'?\ntoy: see 'toy --help'\n");
  r = toy("fine --sise=2");
  EXPECT_EQ(r.code, 2);
  EXPECT_THAT(r.err, HasSubstr("unknown option '--sise'; did you mean '--size'?"));
  r = toy("fine extra");
  EXPECT_EQ(r.code, 2);
  EXPECT_THAT(r.err, HasSubstr("unexpected argument 'extra'"));
  for (const char* bad : {"", "fine --size", "fine --size two", "fine -j -1", "fine -j 1e9", "usage"}) {
    r = toy(bad);
    EXPECT_EQ(r.code, 2) << bad;
    EXPECT_THAT(r.err, HasSubstr("toy: usage: ")) << bad;
    EXPECT_THAT(r.err, HasSubstr("toy: see 'toy --help'\n")) << bad;
  }
}

TEST(RunApp, OurBugIsThreeAndAsksForAReport) {
  for (const char* what : {"bug", "standard"}) {
    const CommandResult r = toy(what);
    EXPECT_EQ(r.code, 3);
    EXPECT_THAT(r.err, HasSubstr("toy: bug: "));
    EXPECT_THAT(r.err, HasSubstr(std::string("please report it with this command line: toy ") + what));
  }
  EXPECT_THAT(toy("bug").err, HasSubstr("argc == -1: 2 against -1"));
}

TEST(RunApp, HelpAndVersionAreZeroAndDoNoWork) {
  CommandResult r = toy("--help");
  EXPECT_EQ(r.code, 0);
  EXPECT_THAT(r.out, HasSubstr("Does what it is told."));
  EXPECT_THAT(r.out, HasSubstr("--threads"));
  EXPECT_THAT(r.out, HasSubstr("Example: toy fine"));
  EXPECT_EQ(r.err, "");
  r = toy("--version");
  EXPECT_EQ(r.code, 0);
  EXPECT_EQ(r.out, std::string("toy ") + kVersion + "\n");
}

TEST(RunApp, AClosedPipeDoesNotKillTheProgramSilently) {
  const CommandResult r =
      run_command("bash -c '" + std::string(SUITE_TOY_APP) + " fine | true; exit ${PIPESTATUS[0]}'");
  EXPECT_EQ(r.code, 0);
}

namespace {
// Starts the toy, waits until its unfinished file is there, and sends it a signal.
CommandResult signalled(const TempFolder& folder, const std::string& what, const std::string& signal) {
  return run_command("bash -c \"set -m; " + std::string(SUITE_TOY_APP) + " " + what + " --name " + (folder / "x") +
                     " & pid=\\$!; while [ -z \\\"\\$(ls " + folder.path() +
                     ")\\\" ]; do sleep 0.02; done; sleep 0.2; kill -" + signal + " \\$pid; wait \\$pid\"");
}
}  // namespace

TEST(RunApp, ASignalEndsItAtOnceWithoutAPartialFile) {
  for (const auto& [signal, code] : {std::pair<std::string, int>{"INT", 130}, {"TERM", 143}}) {
    const TempFolder folder;
    const CommandResult r = signalled(folder, "write", signal);
    EXPECT_EQ(r.code, code);
    EXPECT_THAT(r.err, HasSubstr("unfinished files were removed"));
    EXPECT_EQ(folder.entries(), 0u);
  }
}

TEST(RunApp, ASignalAsksForAnEndInGoodOrder) {
  const TempFolder folder;
  const CommandResult r = signalled(folder, "stop", "INT");
  EXPECT_EQ(r.code, 130);
  EXPECT_THAT(r.err, HasSubstr("stopping in good order; once more to end at once"));
  EXPECT_EQ(folder.entries(), 1u);  // whole, without its temporary
}

// Loops of the libraries once went on to their end after a signal.
TEST(RunApp, ParallelLoopsStopAtASignalAndFinishWhatHasToBe) {
  const TempFolder folder;
  const CommandResult r = signalled(folder, "loop", "TERM");
  EXPECT_EQ(r.code, 143);
  EXPECT_THAT(r.err, HasSubstr("toy: stopped by signal\n"));
  EXPECT_EQ(folder.entries(), 1u);  // whole
}

// A file that a thread created while another one ended the program would stay.
TEST(RunApp, NoFileAppearsWhileASignalEndsTheProgram) {
  for (int k = 0; k < 20; ++k) {
    const TempFolder folder;
    const CommandResult r = run_command("bash -c \"" + std::string(SUITE_TOY_APP) + " files --name " + folder.path() +
                                        " & pid=\\$!; while [ ! -e " + (folder / "x") +
                                        " ]; do sleep 0.01; done; kill -TERM \\$pid; "
                                        "wait \\$pid\"");
    EXPECT_EQ(r.code, 143);
    EXPECT_EQ(folder.entries(), 1u);  // "x", whole
  }
}

// Three jobs into one folder: the later ones are refused and name the first; a lock whose run has died is none.
TEST(RunApp, AFolderIsLockedForOneRun) {
  const TempFolder folder;
  const std::string run = std::string(SUITE_TOY_APP) + " lock --name " + folder.path(), path = folder / "run.lock";
  const std::string wait = "while [ ! -s " + path + " ]; do sleep 0.01; done; ";
  for (const auto& [signal, code] : {std::pair<std::string, int>{"TERM", 143}, {"HUP", 129}}) {
    const CommandResult r = run_command("bash -c \"" + run + " -s 60 & pid=\\$!; " + wait + run +
                                        " -s 0; echo second \\$?; kill -" + signal + " \\$pid; wait \\$pid\"");
    EXPECT_EQ(r.code, code) << r.err;
    EXPECT_THAT(r.out, HasSubstr("second 1"));
    EXPECT_THAT(r.err, HasSubstr("another run writes here: process "));
    EXPECT_THAT(r.err, HasSubstr("(toy lock --name "));
    EXPECT_EQ(folder.entries(), 0u) << "the lock goes with the run";
  }
  EXPECT_EQ(run_command(run + " -s 0").code, 0);
  EXPECT_EQ(folder.entries(), 0u);
  // Killed, it stays, and the next run takes it.
  run_command("bash -c \"" + run + " -s 60 & pid=\\$!; " + wait + "kill -KILL \\$pid; wait \\$pid\"");
  EXPECT_EQ(folder.entries(), 1u);
  EXPECT_EQ(run_command(run + " -s 0").code, 0);
  EXPECT_EQ(folder.entries(), 0u);
  // Somebody's own file of that name is left alone.
  std::ofstream(path) << "mine\n";
  const CommandResult r = run_command(run + " -s 0");
  EXPECT_EQ(r.code, 1);
  EXPECT_THAT(r.err, HasSubstr("is no lock file, and stands where a run puts one"));
  EXPECT_EQ(folder.entries(), 1u);
}

// Escape sequences of an input once reached the terminal as they were.
TEST(RunApp, ControlCharactersOfArgumentsAreShown) {
  const CommandResult r = toy("echo --name \"$(printf 'a\\033[31mb')\"");
  EXPECT_EQ(r.code, 1);
  EXPECT_THAT(r.err, HasSubstr("error: a\\x1b[31mb\n"));
  EXPECT_EQ(r.err.find('\x1b'), std::string::npos);
}

}  // namespace suite::run_app_test
