// Runs a command through the shell and keeps what it says: for tests of executables.
#pragma once
#include <sys/wait.h>

#include <cstdio>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>

#include "support/temp_folder.h"

namespace suite {

struct CommandResult {
  int code = -1;  // exit code; 128 + signal when it was killed, as the shell has it
  std::string out, err;
};

inline CommandResult run_command(const std::string& command) {
  const TempFolder folder;
  const std::string wrapped = "( " + command + " ) >'" + (folder / "out") + "' 2>'" + (folder / "err") + "' </dev/null";
  const int status = std::system(wrapped.c_str());
  const auto text = [](const std::string& path) {
    std::ifstream in(path, std::ios::binary);
    std::ostringstream all;
    all << in.rdbuf();
    return all.str();
  };
  return {WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status), text(folder / "out"), text(folder / "err")};
}

}  // namespace suite
