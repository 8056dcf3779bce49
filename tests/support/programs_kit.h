// Tests of the programs that share one folder, with what was prepared in it, through a whole suite.
#pragma once
#include <gtest/gtest.h>

#include <memory>
#include <string>

#include "base/files.h"
#include "support/run_command.h"

namespace suite {

// Suite: the fixture itself, so that each has a folder of its own.
template <class Suite>
class ProgramsTest : public testing::Test {
 protected:
  static void make_folder() { folder_ = std::make_unique<TempFolder>(); }
  static void TearDownTestSuite() { folder_.reset(); }
  // In the folder; `command` begins with the name of a program.
  static CommandResult run(const std::string& command) {
    return run_command("cd '" + folder_->path() + "' && " SUITE_BIN_DIR "/" + command);
  }
  // Makes NAME.h5 of a scene text.
  static void prepare(const std::string& text, const std::string& name = "scene") {
    write_file(*folder_ / (name + ".yaml"), std::string_view(text));
    const CommandResult r = run("scene-prep " + name + ".yaml -o " + name + ".h5 -q");
    ASSERT_EQ(r.code, 0) << r.err;
  }
  // Renders a simulation text into the folder `out`.
  static CommandResult render(const std::string& text, const std::string& out) {
    write_file(*folder_ / (out + ".yaml"), std::string_view(text));
    return run("dirsig-render " + out + ".yaml -o " + out + " -q");
  }
  static inline std::unique_ptr<TempFolder> folder_;
};

}  // namespace suite
