#include "formats/preset/preset.h"

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

std::string list_of(PresetKind kind) {
  std::string list;
  for (const PresetText& p : preset_texts())
    if (p.kind == kind) list += strf("%-14s %s\n", std::string(p.name).c_str(), summary_of(p.text).c_str());
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
