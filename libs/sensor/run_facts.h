// What is known when a run begins, for sensors that want it.
#pragma once
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>

namespace suite {

struct RunFacts {
  uint64_t seed = 0;
  std::string folder;   // of the results; empty: the run keeps none (a study)
  std::string made_by;  // program, version and command line, as results record them
  // Writes a file into a folder below `folder`, which is made when it is not there: whole or not at all. Located Error.
  // Not set without a folder.
  std::function<void(const std::string& subfolder, const std::string& file, std::string_view bytes)> write;
};

}  // namespace suite
