#include "base/outputs.h"

#include <filesystem>

#include "base/error.h"
#include "base/files.h"

namespace suite {

void make_folders_of(const std::vector<std::string>& files) {
  for (const std::string& file : files) {
    if (file.empty() || file == "-") continue;
    const std::filesystem::path folder = std::filesystem::path(file).parent_path();
    if (folder.empty()) continue;
    try {
      make_folder(folder.string());
    } catch (const Error& e) {
      throw Error(Where{file, 0, 0, {}, -1}, "cannot be written: " + folder.string() + ": " + e.message(), e.hint());
    }
  }
}

std::string in_folder(const std::string& folder, const std::string& name) {
  size_t end = folder.size();
  while (end > 0 && folder[end - 1] == '/') --end;
  if (end == 0 && folder.empty()) return name;
  return folder.substr(0, end) + "/" + name;
}

}  // namespace suite
