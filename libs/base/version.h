// Which suite this is. Its only source is project(VERSION) in CMakeLists.txt.
#pragma once
#include <string>

namespace suite {

extern const char* const kVersion;  // "0.9.0"

// The commit whose sources the program was built of, with a + where they were changed since; empty where the build did
// not know it (sources without their history), and in what is no program (tests, the library).
std::string build_commit();

// What --version says after the name: "0.9.0", or "0.9.0 (commit 3d11ea82abcd)".
std::string version_text();

}  // namespace suite
