#include "formats/preset/preset.h"

#include <set>

#include "base/error.h"
#include "base/registry.h"
#include "formats/preset/day_night_band.h"
#include "formats/preset/preset_texts.h"

namespace suite {

namespace {

// The first line of every text is "# Summary: ...".
std::string summary_of(std::string_view text) {
  constexpr std::string_view kBefore = "# Summary: ";
  return std::string(text.substr(kBefore.size(), text.find('\n') - kBefore.size()));
}

// How often a text has a line (or part of one).
size_t count_of(std::string_view text, std::string_view part) {
  size_t n = 0;
  for (size_t at = text.find(part); at != text.npos; at = text.find(part, at + part.size())) ++n;
  return n;
}

// Arrays of a text that have a published figure of these kinds: lines "#: KIND ARRAY ...".
size_t arrays_with(std::string_view text, std::initializer_list<std::string_view> kinds) {
  std::set<std::string_view> names;
  for (const std::string_view kind : kinds) {
    const std::string before = "\n#: " + std::string(kind) + " ";
    for (size_t at = text.find(before); at != text.npos; at = text.find(before, at + 1)) {
      const size_t name = at + before.size();
      names.insert(text.substr(name, text.find(' ', name) - name));
    }
  }
  return names.size();
}

// What an instrument's text holds beside its geometry: published noise and MTF by arrays, and what its bands are.
std::string held_by(std::string_view text) {
  const size_t arrays = count_of(text, "\n        - {name: ");
  const auto of = [&](size_t n) {
    return n == 0 ? "none" : n == arrays ? "all" : strf("%zu of %zu arrays", n, arrays);
  };
  return strf(" [noise: %s; MTF: %s; bands: %s]", of(arrays_with(text, {"snr", "nedt"})).c_str(),
              of(arrays_with(text, {"mtf"})).c_str(),
              count_of(text, "shape: rectangular") > 0 ? "rectangular" : "Gaussian");
}

std::string list_of(PresetKind kind) {
  std::string list;
  for (const PresetText& p : preset_texts())
    if (p.kind == kind)
      list += strf("%-14s %s%s\n", std::string(p.name).c_str(), summary_of(p.text).c_str(),
                   kind == PresetKind::instrument ? held_by(p.text).c_str() : "");
  return list;
}

}  // namespace

std::string list_presets() {
  return list_of(PresetKind::instrument) + list_day_night_band() + list_of(PresetKind::lidar);
}

std::string list_lidar_presets() { return list_of(PresetKind::lidar); }

std::string preset_text(const std::string& name) {
  if (auto text = find_day_night_band(name)) return *text;
  std::vector<std::string> names{"viirs_dnb_like"};
  for (const PresetText& p : preset_texts()) {
    if (p.name == name) return std::string(p.text);
    names.emplace_back(p.name);
  }
  throw Error("there is no preset '" + name + "'", name_hint(name, names));
}

}  // namespace suite
