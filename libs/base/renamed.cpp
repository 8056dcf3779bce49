#include "base/renamed.h"

#include <algorithm>
#include <map>
#include <mutex>
#include <utility>

#include "base/run_app.h"

namespace suite {

namespace {

constexpr auto kKey = RenamedName::Of::key, kOption = RenamedName::Of::option, kPart = RenamedName::Of::part;

constexpr RenamedName kNames[] = {
    {kKey, "guide_to_gloss", "caustic_guiding", "simulation"},
    {kKey, "light_through_refraction", "manifold_nee", "simulation"},
    {kKey, "knots", "hero_wavelengths", "sensor, array"},
    {kKey, "target_k", "target_error_k", "`heat` of a simulation"},
    {kKey, "audit", "random_walks", "`heat` of a simulation"},
    {kKey, "leave_out_k", "influence_cutoff_k", "`heat` of a simulation"},
    {kKey, "intervals", "geometry_intervals", "`heat` of a simulation"},
    {kKey, "ride", "attached_to", "lamp"},
    {kKey, "aerosol_depth_500", "aerosol_optical_depth_500", "sky `clear`"},
    {kKey, "depth_550", "optical_depth_550", "`aerosol` and `clouds` of an atmosphere"},
    {kKey, "column_depth", "column_optical_depth", "`gases` of an atmosphere without profile"},
    {kKey, "layer_depths", "layer_optical_depths", "`gases` of an atmosphere without profile"},
    {kKey, "within_deg", "angle_tolerance_deg", "atmosphere with `tables`"},
    {kKey, "within_m", "height_tolerance_m", "atmosphere with `tables`"},
    {kKey, "longest_m", "max_range_m", "a FourCurve file of an atmosphere with `tables`"},
    {kKey, "longest_m", "max_edge_m", "object `points` of a scene"},
    {kKey, "turn", "random_heading", "`scatter` of a placement"},
    {kOption, "--kit-memory", "--cache-memory", "dirsig-render"},
    {kOption, "--account", "--import-report", "dirsig-render, scene-prep"},
    {kPart, "MNEE", "manifold", "`--explain`"},
    {kPart, "refracted light", "manifold", "`--explain`"},
    {kPart, "multi-vertex NEE", "volume_chains", "`--explain`"},
    {kPart, "splitting", "side_vertex", "`--explain`"},
    {kPart, "caustic guiding", "caustic_guide", "`--explain`"},
    {kPart, "gloss guide", "caustic_guide", "`--explain`"},
};

struct Noted {
  std::mutex mutex;
  std::vector<RenamedUse> uses;
};
Noted& noted() {
  static Noted all;
  return all;
}

// "--name" of "--name=value".
std::string_view name_of(std::string_view argument) { return argument.substr(0, argument.find('=')); }

const char* word_of(RenamedName::Of of) { return of == kKey ? "key" : of == kOption ? "option" : "part"; }

bool has_option(const RenamedName& row, const std::string& program) {
  return row.of == kOption && (", " + std::string(row.where) + ",").find(" " + program + ",") != std::string::npos;
}

}  // namespace

std::span<const RenamedName> renamed_names() { return kNames; }

std::span<const RenamedName* const> old_names_of_key(std::string_view key) {
  static const auto by_new = [] {
    std::map<std::string_view, std::vector<const RenamedName*>> made;
    for (const RenamedName& row : kNames)
      if (row.of == kKey) made[row.new_name].push_back(&row);
    return made;
  }();
  const auto found = by_new.find(key);
  if (found == by_new.end()) return {};
  return found->second;
}

void note_renamed(const RenamedName& name, const Where& where) {
  Noted& all = noted();
  const std::lock_guard lock(all.mutex);
  for (const RenamedUse& use : all.uses)
    if (use.name == &name && use.where.file == where.file) return;
  all.uses.push_back({&name, where});
}

std::vector<RenamedUse> take_renamed_uses() {
  const std::lock_guard lock(noted().mutex);
  return std::exchange(noted().uses, {});
}

std::string text_of(const RenamedUse& use) {
  const std::string place = use.name->of == kKey ? to_text(use.where) + ": " : "";
  return place + strf("the %s '", word_of(use.name->of)) + std::string(use.name->old_name) + "' is now '" +
         std::string(use.name->new_name) + "'; the old name is still read";
}

std::string new_part_name(const std::string& name) {
  for (const RenamedName& row : kNames) {
    if (row.of != kPart || row.old_name != name) continue;
    note_renamed(row, Where{name, 0, 0, {}, -1});
    return std::string(row.new_name);
  }
  return name;
}

Error both_given(const RenamedName& name, const Where& old_place, const Where& new_place) {
  const std::string now(name.new_name);
  return Error(old_place, "'" + std::string(name.old_name) + "' is the old name of '" + now + "', which is given too",
               "keep '" + now + "' (" + to_text(new_place) + ")");
}

std::vector<std::string> with_new_options(const std::string& program, std::vector<std::string> arguments) {
  for (const RenamedName& row : kNames) {
    if (!has_option(row, program)) continue;
    const auto given = [&](std::string_view name) {
      return std::ranges::find(arguments, name, [](const std::string& a) { return name_of(a); });
    };
    if (given(row.old_name) == arguments.end()) continue;
    if (given(row.new_name) != arguments.end())
      throw UsageError("'" + std::string(row.old_name) + "' is the old name of '" + std::string(row.new_name) +
                       "', which is given too; keep one");
    for (std::string& a : arguments)
      if (name_of(a) == row.old_name) a.replace(0, row.old_name.size(), row.new_name);
    note_renamed(row, Where{std::string(row.old_name), 0, 0, {}, -1});
  }
  return arguments;
}

}  // namespace suite
