#include <algorithm>
#include <cstring>
#include <filesystem>

#include "base/files.h"
#include "base/required.h"
#include "formats/scene_text/reader.h"
#include "formats/sqt/sqt.h"
#include "optics/models.h"
#include "optics/models/sea.h"

namespace suite::scene_text {

namespace {
// 'outside' of a material is the medium there, or what a fitted quad-tree is worth outside its wavelengths.
bool is_rule(const Params& p) {
  if (p.kind() == Params::Kind::map || p.kind() == Params::Kind::list) return false;
  const std::string text = p.as_text();
  return text == "error" || text == "hold" || text == "zero";
}

// Up to here a temperature may be meant in degrees Celsius.
constexpr double kWarmestCelsius = 80;

// Refuses what is no fit where it is named: measured files have to be fitted first.
void require_fit(const Params& named, const std::string& path) {
  const RandomAccessFile file(path);
  char head[7] = {};
  if (file.size() >= sizeof head) file.read_at(0, std::as_writable_bytes(std::span(head)));
  if (std::memcmp(head, "SQTbund", sizeof head) != 0)
    throw named.error("'" + named.as_text() + "' is no SQT file",
                      "fit it first: sqt-fit " + named.as_text() + " -o " +
                          std::filesystem::path(named.as_text()).stem().string() + ".sqt");
}
}  // namespace

// {file, column, scale, outside}, {points: [[um, value], ...], outside}, {wavelength_um: [...], value: [...], outside}
// or {constant}.
Curve Reader::read_curve_map(const Params& p) {
  if (const auto c = p.find("constant")) return Curve::constant(c->as_number());
  if (const auto points = p.find("points")) {
    std::vector<double> x, y;
    for (const Params& row : points->items()) {
      const std::vector<double> pair = row.as_numbers();
      if (pair.size() != 2) throw row.error("a point is [wavelength_um, value]");
      x.push_back(pair[0]);
      y.push_back(pair[1]);
    }
    return Curve(std::move(x), std::move(y), read_outside(p), points->where());
  }
  if (const auto x = p.find("wavelength_um"))
    return Curve(x->as_numbers(), p.at("value").as_numbers(), read_outside(p), p.where());
  CurveOptions options = curve_options();
  options.outside = read_outside(p);
  options.column = static_cast<int>(p.integer("column", 1, 100000, 1));
  options.scale = p.number("scale", 1);
  options.spectrum = p.text("spectrum", "");
  return read_curve(input(p.at("file")), options);
}

// A number, the name of a curve of `curves`, the name of a file, a map, or a list of curves to be joined.
Curve Reader::read_curve_value(const Params& p) {
  if (p.kind() == Params::Kind::list || (p.kind() == Params::Kind::map && p.has("join")))
    return read_joined(p, [this](const Params& one) { return read_curve_value(one); });
  if (p.kind() == Params::Kind::map) return read_curve_map(p);
  const std::string text = p.as_text();
  if (text.find_first_not_of("0123456789+-.eE") == std::string::npos) return Curve::constant(p.as_number());
  if (const auto known = curves_.find(text); known != curves_.end()) return known->second;
  return read_curve(input(p), curve_options());
}

CurveOptions Reader::curve_options() {
  CurveOptions options;
  options.on_warning = [this](const std::string& path, const std::string& what) {
    report_.add("SP109", path, {Where{path, 0, 0, {}, -1}, what});
  };
  return options;
}

std::string Reader::embed(const Params& p) {
  const std::string path = input(p);
  if (const auto known = embedded_.find(path); known != embedded_.end()) return known->second;
  std::string name = std::filesystem::path(path).filename().string();
  const auto taken = [&](const std::string& n) {
    return std::any_of(draft_.files.begin(), draft_.files.end(), [&](const DataFile& f) { return f.name == n; });
  };
  for (int k = 2; taken(name); ++k) name = strf("%d-", k) + std::filesystem::path(path).filename().string();
  draft_.files.push_back({name, read_bytes(path)});
  return embedded_[path] = name;
}

void Reader::read_stored(const Params& p, ModelSpec& spec) {
  const bool with_rule = p.kind() == Params::Kind::map;
  const Params file = with_rule ? p.at("file") : p;
  require_fit(file, input(file));
  spec.texts["file"] = embed(file);
  if (with_rule && p.has("outside")) spec.texts["outside"] = to_text(read_outside(p));
  auto& bundle = stored_[spec.texts["file"]];
  if (!bundle) bundle = read_sqt(input(file)).bundle;
  spec.bundle = bundle;
}

void Reader::read_model(const Params& p, ModelSpec& spec) {
  const Params model = required(p, "model", models().names());
  spec.model = model.as_text();
  const ModelRow& row = models().find(spec.model, model.where());
  for (const Parameter& parameter : row.parameters) {
    const auto value = p.find(parameter.name);
    if (!value) continue;
    switch (parameter.kind) {
      case Parameter::Kind::number:
        spec.numbers[parameter.name] = value->as_number();
        break;
      case Parameter::Kind::curve:
        spec.curves[parameter.name] = read_curve_value(*value);
        break;
      case Parameter::Kind::text:
        if (parameter.name == "file")
          read_stored(*value, spec);
        else if (parameter.name != "outside" || is_rule(*value))
          spec.texts[parameter.name] = value->as_text();
        break;
    }
  }
  if (const bool wants = std::any_of(row.parameters.begin(), row.parameters.end(),
                                     [](const Parameter& q) { return q.name == "index"; });
      wants && !spec.curves.count("index"))
    if (const auto index = relative_index(p)) spec.curves["index"] = *index;
  for (const Parameter& q : row.parameters)
    if (q.required && !spec.numbers.count(q.name) && !spec.curves.count(q.name) && !spec.texts.count(q.name))
      if (const auto near = p.misspelt(q.name)) throw *near;
  check_model(spec, model.where());
  if (spec.model == "sea")
    for (const std::string& note : sea_notes(spec.numbers.at("wind_m_s"), spec.numbers.at("directed") > 0.5))
      report_.add("SP108", draft_.file, {model.where(), "model 'sea': " + note});
}

void Reader::read_material(const std::string& id, const Params& p) {
  DraftMaterial m;
  m.where = p.where();
  m.material.id = id;
  // The name is known from here on, so that one wrong value does not bring a second error per use of the material.
  const size_t slot = draft_.materials.size();
  draft_.materials.push_back(m);
  m.material.description = p.text("description", "");
  if (const auto map = p.find("map")) m.map = reference(*map);
  if (const auto maps = p.find("maps"))
    for (const Params& map : maps->items()) m.property_maps.push_back(reference(map));
  if (const auto inside = p.find("inside")) m.inside = reference(*inside);
  const bool stored = p.has("model") && p.text("model", "") == "sqt";
  if (const auto outside = p.find("outside"); outside && !(stored && is_rule(*outside)))
    m.outside = reference(*outside);
  const bool boundary = m.inside.given() || m.outside.given();
  if (p.has("model") || (!m.map.given() && !boundary)) {
    read_model(p, m.material.surface);
    m.has_model = true;
  }
  m.material.temperature_k = p.has("temperature_k") ? p.number_in("temperature_k", 1, 1e5, "K") : 0;
  if (m.material.temperature_k > 0 && m.material.temperature_k <= kWarmestCelsius)
    report_.add("SP107", draft_.file,
                {p.at("temperature_k").where(),
                 strf("material '%s' has %g K; %g degrees Celsius are %g K", id.c_str(), m.material.temperature_k,
                      m.material.temperature_k, m.material.temperature_k + 273.15)});
  if (const auto thermal = p.find("thermal")) read_thermal(*thermal, m);
  if (const auto temperature = p.find("temperature")) {
    if (p.has("temperature_k")) throw temperature->error("a material has either 'temperature' or 'temperature_k'");
    read_temperature(*temperature, m);
  }
  draft_.materials[slot] = std::move(m);
}

}  // namespace suite::scene_text
