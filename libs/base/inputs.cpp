#include "base/inputs.h"

#include <sys/stat.h>

#include <atomic>
#include <filesystem>
#include <map>
#include <mutex>
#include <optional>
#include <utility>

#include "base/error.h"
#include "base/run_app.h"

namespace suite {

namespace {

using Identity = std::pair<dev_t, ino_t>;

struct Inputs {
  std::mutex mutex;
  std::atomic<bool> tracked = false;
  std::map<Identity, std::string> names;
};
Inputs& inputs() {
  static Inputs all;
  return all;
}
thread_local int g_own_results = 0;

std::optional<Identity> identity_of(const std::string& path) {
  struct stat info {};
  if (::stat(path.c_str(), &info) != 0 || !S_ISREG(info.st_mode)) return std::nullopt;
  return Identity{info.st_dev, info.st_ino};
}

// Where a file stands or would stand, seen through links of its folder.
std::string place_of(const std::string& path) {
  std::error_code ignored;
  const std::filesystem::path p(path), folder = p.has_parent_path() ? p.parent_path() : ".";
  const std::filesystem::path real = std::filesystem::weakly_canonical(folder, ignored);
  return ((ignored ? folder : real) / p.filename()).lexically_normal().string();
}

}  // namespace

void track_inputs() { inputs().tracked = true; }

void note_input(const std::string& path) {
  if (g_own_results > 0 || !inputs().tracked) return;
  if (const auto id = identity_of(path)) {
    const std::lock_guard lock(inputs().mutex);
    inputs().names.emplace(*id, path);
  }
}

std::string input_at(const std::string& path) {
  const auto id = identity_of(path);
  const std::lock_guard lock(inputs().mutex);
  if (!id || !inputs().tracked) return {};
  const auto found = inputs().names.find(*id);
  return found == inputs().names.end() ? std::string{} : found->second;
}

void check_outputs(const std::vector<std::string>& outputs) {
  std::map<std::string, std::string> places;
  std::map<Identity, std::string> files;
  for (const std::string& output : outputs) {
    if (output.empty() || output == "-") continue;
    if (const std::string read = input_at(output); !read.empty())
      throw UsageError("'" + output + "' would replace an input" +
                       (read == output ? std::string() : ", which is read as '" + read + "'") +
                       "; give the output another name");
    const auto refuse = [&](const std::string& other) {
      throw UsageError("'" + output + "' is named twice" +
                       (other == output ? std::string() : ", first as '" + other + "'") +
                       "; inputs and outputs must be different files");
    };
    if (const auto [at, fresh] = places.emplace(place_of(output), output); !fresh) refuse(at->second);
    if (const auto id = identity_of(output))
      if (const auto [at, fresh] = files.emplace(*id, output); !fresh) refuse(at->second);
  }
}

OwnResults::OwnResults() { ++g_own_results; }
OwnResults::~OwnResults() { --g_own_results; }

}  // namespace suite
