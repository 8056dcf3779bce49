// Parts of the suite that stay outside of a program until they are needed: shared libraries of ours, each around a
// library that takes long to load. A part is made by suite_part() of scripts/cmake/suite.cmake and exports a table of
// functions, whose type the part and its only caller share.
#pragma once
#include <string>

namespace suite {

// What the part `name` exports as `symbol`. The part is loaded at the first call, by any thread, and stays. It is
// looked for in lib/suite beside the folder of the program, where the build and the installation put it. Error: it is
// not there, cannot be loaded, is of another version of the suite, or exports no such symbol.
const void* late_symbol(const std::string& name, const char* symbol);

// Stands once in a part: which version of the suite it is of. suite_part() defines SUITE_VERSION, as a part links
// nothing of ours.
#define SUITE_PART_VERSION                              \
  extern "C" {                                          \
  extern const char* const suite_part_version;          \
  const char* const suite_part_version = SUITE_VERSION; \
  }                                                     \
  static_assert(true)

}  // namespace suite
