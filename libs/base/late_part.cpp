#include "base/late_part.h"

#include <dlfcn.h>

#include <filesystem>

#include "base/error.h"
#include "base/version.h"

namespace suite {

const void* late_symbol(const std::string& name, const char* symbol) {
  std::error_code unknown;
  const auto program = std::filesystem::read_symlink("/proc/self/exe", unknown);
  // A relative path would find whatever lies in the folder that the program is started in.
  if (unknown) throw Error("the folder of this program is not known: " + unknown.message(), "is /proc mounted?");
  const std::string path = (program.parent_path().parent_path() / "lib/suite" / (name + ".so")).string();
  const std::string hint =
      "it belongs into lib/suite beside the folder of this program; reinstall or rebuild the suite";
  void* const part = dlopen(path.c_str(), RTLD_LAZY | RTLD_LOCAL);
  if (!part) {
    const char* const why = dlerror();
    throw Error("the part '" + name + "' cannot be loaded: " + (why ? why : "unknown reason"), hint);
  }
  const auto* const version = static_cast<const char* const*>(dlsym(part, "suite_part_version"));
  if (!version || std::string(*version) != kVersion)
    throw Error(
        "the part '" + name + "' is of version " + (version ? *version : "none") + ", the program of " + kVersion,
        hint);
  const void* const found = dlsym(part, symbol);
  if (!found) throw Error("the part '" + name + "' exports no '" + symbol + "'", hint);
  return found;
}

}  // namespace suite
