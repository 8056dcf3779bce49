#include <algorithm>

#include "base/files.h"
#include "base/yaml_text.h"
#include "formats/preset/preset.h"

namespace suite {

namespace {

using Kind = Params::Kind;

std::optional<std::string> text_of(const Params& map, std::string_view key) {
  if (map.kind() != Kind::map) return std::nullopt;
  const auto value = map.find(key);
  if (!value || value->kind() != Kind::scalar) return std::nullopt;
  return value->as_text();
}

// Writes trees as YAML, a key or a scalar a line, each with its place.
class Writer {
 public:
  ExpandedText text;

  // where: of the key or the dash that it follows.
  void value(const Params& own, const Params* base, const Where& where, int depth) {
    if (own.kind() == Kind::map && !(base && base->kind() == Kind::list))
      map(own, completed(own, base), where, depth);
    else if (own.kind() == Kind::map || own.kind() == Kind::list)
      list(own, base, where, depth);
    else
      line(" " + scalar(own), own.where());
  }
  // The simulation itself; its sensors are written by `sensors`.
  template <class Sensors>
  void root(const Params& simulation, Sensors&& sensors) {
    for (const std::string& key : simulation.keys()) {
      open(key, 0);
      if (key == "sensors")
        sensors(*this, simulation.at(key));
      else
        value(simulation.at(key), nullptr, simulation.where(key), 1);
    }
  }
  void item(const Params& own, const Params* base, int depth) {
    text.yaml += std::string(2 * static_cast<size_t>(depth), ' ') + "-";
    value(own, base, own.where(), depth + 1);
  }
  void line(const std::string& rest, const Where& where) {
    text.yaml += rest + "\n";
    text.origins.push_back(where);
  }

 private:
  static std::string scalar(const Params& p) { return p.kind() == Kind::null ? "null" : yaml_quoted(p.as_text()); }
  void open(const std::string& key, int depth) {
    text.yaml += std::string(2 * static_cast<size_t>(depth), ' ') + yaml_quoted(key) + ":";
  }
  // The map of a preset that a map of the same kind completes.
  static const Params* completed(const Params& own, const Params* base) {
    if (!base || base->kind() != Kind::map) return nullptr;
    const auto mine = text_of(own, "kind"), theirs = text_of(*base, "kind");
    return mine && theirs && *mine != *theirs ? nullptr : base;
  }
  void map(const Params& own, const Params* base, const Where& where, int depth) {
    std::vector<std::string> keys = base ? base->keys() : std::vector<std::string>();
    for (const std::string& key : own.keys())
      if (std::ranges::find(keys, key) == keys.end()) keys.push_back(key);
    const auto is_left_out = [&](const std::string& key) {
      return base && own.has(key) && (key == "preset" || own.at(key).kind() == Kind::null);
    };
    std::erase_if(keys, is_left_out);
    line(keys.empty() ? " {}" : "", where);
    for (const std::string& key : keys) {
      const auto theirs = base ? base->find(key) : std::nullopt;
      const bool mine = own.has(key);
      open(key, depth);
      value(mine ? own.at(key) : *theirs, mine && theirs ? &*theirs : nullptr, mine ? own.where(key) : base->where(key),
            depth + 1);
    }
  }
  void list(const Params& own, const Params* base, const Where& where, int depth) {
    const std::vector<Params> items = own.items();
    line(items.empty() ? " []" : "", where);
    for (const Params& each : items) {
      std::optional<Params> same;
      if (const auto name = text_of(each, "name"); name && base && base->kind() == Kind::list)
        for (const Params& theirs : base->items())
          if (text_of(theirs, "name") == name) same = theirs;
      item(each, same ? &*same : nullptr, depth);
    }
  }
};

// The preset that a sensor names, parsed.
Params preset_of(const Params& sensor) {
  const Params named = sensor.at("preset");
  const std::string name = named.as_text();
  std::string text;
  try {
    text = preset_text(name);
  } catch (const Error& e) {
    throw named.error(e.message(), e.hint());
  }
  const Params preset = Params::parse_text(text, "preset " + name).items().at(0);
  const auto mine = text_of(sensor, "kind"), theirs = text_of(preset, "kind");
  if (mine && mine != theirs)
    throw sensor.at("kind").error("the preset '" + name + "' is a sensor of kind '" + *theirs + "'",
                                  "write kind: " + *theirs + ", or leave it out");
  return preset;
}

bool names_one(const Params& sensor) { return sensor.kind() == Kind::map && sensor.has("preset"); }

bool is_of_preset(const std::string& setting) { return setting.substr(0, setting.find('=')).ends_with(".preset"); }

}  // namespace

std::optional<ExpandedText> expand_presets(const Params& simulation) {
  if (simulation.kind() != Kind::map) return std::nullopt;
  const auto sensors = simulation.find("sensors");
  if (!sensors || (sensors->kind() != Kind::list && sensors->kind() != Kind::map)) return std::nullopt;
  if (std::ranges::none_of(sensors->items(), names_one)) return std::nullopt;
  Writer writer;
  writer.root(simulation, [](Writer& to, const Params& list) {
    to.line("", list.where());
    for (const Params& sensor : list.items()) {
      std::optional<Params> preset;
      if (names_one(sensor)) preset = preset_of(sensor);
      to.item(sensor, preset ? &*preset : nullptr, 1);
    }
  });
  return std::move(writer.text);
}

Params parse_simulation(const std::string& path, std::span<const std::string> settings) {
  // Texts that cannot name a preset, nearly all, are parsed once.
  const auto may_name = [](const std::string& text) { return text.find("preset") != std::string::npos; };
  if (!may_name(read_text(path, size_t{256} << 20)) && std::ranges::none_of(settings, may_name))
    return Params::parse_file(path, settings);
  std::vector<std::string> first, others;
  for (const std::string& s : settings) (is_of_preset(s) ? first : others).push_back(s);
  const auto expanded = expand_presets(Params::parse_file(path, first));
  if (!expanded) return Params::parse_file(path, settings);
  return Params::parse_made(expanded->yaml, path, expanded->origins, others);
}

}  // namespace suite
