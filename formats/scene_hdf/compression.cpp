// Which datasets of a prepared scene are packed. See scene_hdf.h.
#include <algorithm>

#include "formats/scene_hdf/scene_hdf.h"

namespace suite {

namespace {

// Is it this dataset or below this group?
bool within(const std::string& dataset, const std::string& name) {
  return dataset.compare(0, name.size(), name) == 0 && (dataset.size() == name.size() || dataset[name.size()] == '/');
}

int level_of(const std::string& text, const std::string& all) {
  if (text == "none") return 0;
  if (text == "deflate") return 6;
  if (text.size() == 9 && text.compare(0, 8, "deflate:") == 0 && text[8] >= '1' && text[8] <= '9') return text[8] - '0';
  throw Error("compression '" + all + "' is not known", "none, deflate or deflate:1 to deflate:9, also as DATASET=...");
}

}  // namespace

int Compression::of_dataset(const std::string& name) const {
  int best = level;
  size_t longest = 0;
  for (const auto& [key, value] : of)
    if (key.size() > longest && within(name, key)) longest = key.size(), best = value;
  return best;
}

void Compression::add(const std::string& text) {
  const size_t equals = text.find('=');
  if (equals == std::string::npos) {
    level = level_of(text, text);
    return;
  }
  std::string name = text.substr(0, equals);
  while (name.size() > 1 && name.back() == '/') name.pop_back();
  if (name.empty() || name == "/")
    throw Error("compression '" + text + "' names no dataset", "for example /geometry=deflate");
  if (name.front() != '/') name.insert(0, 1, '/');
  of[name] = level_of(text.substr(equals + 1), text);
}

void Compression::check_names(const std::vector<std::string>& datasets) const {
  for (const auto& [key, value] : of)
    if (std::none_of(datasets.begin(), datasets.end(), [&](const std::string& d) { return within(d, key); }))
      throw Error("the scene has no dataset '" + key + "' to compress", name_hint(key, datasets));
}

}  // namespace suite
