#include "base/version.h"

// Programs bring it (apps/start); what is linked without it is not linked anew for every commit.
extern "C" __attribute__((weak)) const char suite_build_commit[];

namespace suite {

const char* const kVersion = SUITE_VERSION;

std::string build_commit() { return suite_build_commit ? suite_build_commit : ""; }

std::string version_text() {
  const std::string commit = build_commit();
  return commit.empty() ? kVersion : kVersion + (" (commit " + commit + ")");
}

}  // namespace suite
