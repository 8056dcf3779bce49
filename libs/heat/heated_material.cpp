#include "heat/heated_material.h"

#include <algorithm>

#include "base/error.h"

namespace suite {

namespace {

// Nothing may ask for air where there is none.
void refuse_air(const TemperatureSpec& spec, const Where& where) {
  std::vector<std::string> asks{"roughness"};
  for (const ConvectionRow& row : convection_laws())
    for (const Parameter& p : row.parameters) asks.push_back(p.name);
  if (const auto wet = spec.numbers.find("wetness"); wet != spec.numbers.end() && wet->second > 0)
    asks.push_back("wetness");
  for (const std::string& name : asks)
    if (spec.numbers.contains(name) || spec.texts.contains(name))
      throw Error(where, "'" + name + "' asks for air, and 'convection: none' has none", "drop one of them");
}

// The keys that belong to a law of convection, out of all numbers of the material.
std::shared_ptr<const ConvectionLaw> convection_of(const TemperatureSpec& spec, const Where& where) {
  const auto law = spec.texts.find("convection");
  if (law != spec.texts.end() && law->second == "none") {
    refuse_air(spec, where);
    return nullptr;
  }
  ConvectionSpec asked{law == spec.texts.end() ? "mcadams" : law->second, {}, {}};
  if (const auto r = spec.texts.find("roughness"); r != spec.texts.end()) asked.roughness = r->second;
  const ConvectionRow& row = convection_laws().find(asked.law, where);
  for (const ConvectionRow& other : convection_laws())
    for (const Parameter& p : other.parameters) {
      const auto given = spec.numbers.find(p.name);
      if (given == spec.numbers.end()) continue;
      const auto mine = [&](const Parameter& q) { return q.name == p.name; };
      if (std::none_of(row.parameters.begin(), row.parameters.end(), mine))
        throw Error(where, "convection law '" + row.name + "' takes no '" + p.name + "'",
                    "that is for '" + other.name + "'");
      asked.numbers[p.name] = given->second;
    }
  return make_convection(asked, where);
}

// What the numbers of a back are, for those who left one out.
const char* meaning_of(std::string_view name) {
  if (name == "back_flux_w_m2") return "the heat from behind, W/m2";
  return name == "back_k" ? "the temperature behind, K"
                          : "the film coefficient there, W/(m2 K); in rooms 7.7 by ISO 6946";
}

// All numbers that a back needs and has not, in one message.
void need_numbers(const TemperatureSpec& spec, const std::string& back, const std::vector<std::string>& names,
                  const Where& where) {
  std::string missing, hint;
  for (const std::string& name : names)
    if (!spec.numbers.count(name)) {
      missing += (missing.empty() ? "'" : " and '") + name + "'";
      hint += (hint.empty() ? "" : "; ") + name + ": " + meaning_of(name);
    }
  if (!missing.empty()) throw Error(where, "'back: " + back + "' needs " + missing, hint);
}

// What is behind, from `back` and the numbers that go with it.
void set_back(const TemperatureSpec& spec, HeatedMaterial& m, const Where& where) {
  const auto text = spec.texts.find("back");
  const std::string back = text == spec.texts.end() ? "adiabatic" : text->second;
  using Kind = BackCondition::Kind;
  const std::vector<std::pair<std::string, std::vector<std::string>>> known{{"adiabatic", {}},
                                                                            {"flux", {"back_flux_w_m2"}},
                                                                            {"ground", {"back_k"}},
                                                                            {"air", {"back_k", "back_film_w_m2_k"}},
                                                                            {"open", {}}};
  const auto at = std::find_if(known.begin(), known.end(), [&](const auto& k) { return k.first == back; });
  if (at == known.end()) {
    std::vector<std::string> names;
    for (const auto& k : known) names.push_back(k.first);
    throw Error(where, "unknown back '" + back + "'", name_hint(back, names));
  }
  for (const char* name : {"back_flux_w_m2", "back_k", "back_film_w_m2_k"})
    if (spec.numbers.count(name) && std::find(at->second.begin(), at->second.end(), name) == at->second.end())
      throw Error(where, std::string("'") + name + "' says nothing of a back that is '" + back + "'",
                  "leave it out, or 'back: air' (both), 'ground' (back_k), 'flux' (back_flux_w_m2)");
  need_numbers(spec, back, at->second, where);
  const auto number = [&](const char* name) { return spec.numbers.at(name); };
  if (back == "open") m.back_open = true;
  if (back == "flux") m.behind = {Kind::flux, number("back_flux_w_m2"), 0};
  if (back == "ground") m.behind = {Kind::held, number("back_k"), 0};
  if (back == "air") m.behind = {Kind::air, number("back_k"), number("back_film_w_m2_k")};
  if (m.layers.empty() && !m.back_open && back != "adiabatic")
    throw Error(where, "a surface without heat capacity has '" + back + "' behind it",
                "give it layers (thermal: ...), or 'back: open' as of leaves");
}

}  // namespace

HeatedMaterial heated_material(const TemperatureSpec& spec, const Where& where) {
  HeatedMaterial m;
  m.layers = spec.layers;
  const auto of = [&](const char* name) { return spec.numbers.find(name); };
  const auto end = spec.numbers.end();
  if (of("thickness_m") != end || of("density_kg_m3") != end || of("specific_heat_j_kg_k") != end ||
      of("conductivity_w_m_k") != end) {
    for (const char* name : {"thickness_m", "density_kg_m3", "specific_heat_j_kg_k", "conductivity_w_m_k"})
      if (of(name) == end) throw Error(where, std::string("the one layer needs '") + name + "'", "all four, or layers");
    if (!m.layers.empty()) throw Error(where, "there are layers and the numbers of one layer", "give one of them");
    SlabLayer l;
    l.thickness = of("thickness_m")->second, l.density = of("density_kg_m3")->second;
    l.specific_heat = {of("specific_heat_j_kg_k")->second}, l.conductivity = {of("conductivity_w_m_k")->second};
    m.layers = {l};
  }
  if (!m.layers.empty()) try {
      check_slab_layers(m.layers);
    } catch (const Error& e) {
      throw Error(where, e.message(), e.hint());
    }
  set_back(spec, m, where);
  m.front.convection = convection_of(spec, where);
  m.front.wetness = of("wetness") == end ? 0 : of("wetness")->second;
  m.back = m.front;
  m.source = of("source_w_m2") == end ? 0 : of("source_w_m2")->second;
  if (const auto a = of("absorptance"); a != end) m.absorptance = a->second;
  if (const auto e = of("emissivity"); e != end) m.emissivity = e->second;
  return m;
}

}  // namespace suite
