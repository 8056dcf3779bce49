#include "base/tracked_inputs.h"

#include <algorithm>
#include <cstring>

#include "base/files.h"

namespace suite {

namespace {

constexpr size_t kLargest = size_t{64} << 30;
constexpr const char* kBrings = " -> ";  // in the name of an input that another one brings along

std::string hash_at(const std::string& path) { return sha256(read_bytes(path, kLargest)); }

std::string find(const std::string& file, const std::vector<std::string>& search, const std::string& name) {
  const std::string beside = resolve_path(file, name);
  if (file_exists(beside)) return beside;
  for (const std::string& folder : search)
    if (const std::string other = resolve_path(folder + "/.", name); file_exists(other)) return other;
  return beside;
}

}  // namespace

TrackedInputs::TrackedInputs(std::string file, std::vector<std::string> search)
    : file_(std::move(file)), search_(std::move(search)) {
  all_.push_back({"", sha256(read_bytes(file_))});
}

std::string TrackedInputs::path_of(const std::string& name) const { return find(file_, search_, name); }

TrackedInputs::Added TrackedInputs::add(const std::string& name) {
  const std::string path = path_of(name);
  if (hashes_.count(path)) return {path, false};
  hashes_[path] = hash_at(path);
  all_.push_back({name, hashes_[path]});
  return {path, true};
}

void TrackedInputs::add_companion(const std::string& name, const std::string& other) {
  const std::string whole = name + kBrings + other, at = resolve_path(path_of(name), other);
  if (std::any_of(all_.begin(), all_.end(), [&](const InputFile& known) { return known.name == whole; })) return;
  all_.push_back({whole, file_exists(at) ? hash_at(at) : ""});
}

bool inputs_unchanged(const std::string& file, const std::vector<std::string>& search,
                      std::span<const InputFile> inputs) {
  for (const InputFile& f : inputs) {
    const size_t brings = f.name.find(kBrings);
    std::string at = f.name.empty() ? file : find(file, search, f.name.substr(0, brings));
    if (brings != std::string::npos) at = resolve_path(at, f.name.substr(brings + std::strlen(kBrings)));
    const bool there = file_exists(at);
    if (there != !f.sha256.empty() || (there && hash_at(at) != f.sha256)) return false;
  }
  return !inputs.empty();
}

std::string input_hash(std::span<const InputFile> inputs) {
  std::vector<std::string> lines;
  for (const InputFile& f : inputs) lines.push_back(f.name + '\0' + f.sha256 + '\n');
  std::sort(lines.begin(), lines.end());
  std::string all;
  for (const std::string& line : lines) all += line;
  return sha256(all);
}

}  // namespace suite
