// Temperatures of materials and what a simulation of them needs.
#include "formats/scene_text/reader.h"
#include "heat/heated_material.h"
#include "thermal/models.h"

namespace suite::scene_text {

namespace {

// A number, or the coefficients of 1, T, T^2, ...
template <size_t N>
std::array<double, N> polynomial(const Params& p) {
  const std::vector<double> given =
      p.kind() == Params::Kind::list ? p.as_numbers() : std::vector<double>{p.as_number()};
  if (given.empty() || given.size() > N)
    throw p.error(strf("one to %zu coefficients of 1, T, T^2, ... are expected", N));
  std::array<double, N> c{};
  std::copy(given.begin(), given.end(), c.begin());
  return c;
}

SlabLayer read_layer(const Params& p) {
  SlabLayer l;
  l.thickness = p.number_in("thickness_m", 1e-9, 1e6, "m");
  l.density = p.number_in("density_kg_m3", 1e-6, 1e5, "kg/m3");
  l.specific_heat = polynomial<5>(p.at("specific_heat_j_kg_k"));
  l.conductivity = polynomial<4>(p.at("conductivity_w_m_k"));
  l.heat_generation = p.number_in("heat_generation_w_m3", -1e12, 1e12, "W/m3", 0);
  l.contact_resistance = p.number_in("contact_resistance_m2_k_w", 0, 1e6, "m2 K/W", 0);
  return l;
}

}  // namespace

void Reader::read_thermal(const Params& p, DraftMaterial& m) {
  for (const char* name : {"conductivity_w_m_k", "density_kg_m3", "specific_heat_j_kg_k", "thickness_m"})
    if (const auto value = p.find(name)) m.material.thermal[name] = value->as_number_in(1e-12, 1e12, "SI");
  const auto layers = p.find("layers");
  if (!layers) return;
  if (!m.temperature) m.temperature.emplace();
  for (const Params& layer : layers->items()) m.temperature->layers.push_back(read_layer(layer));
}

// {table: [[s, K], ...], repeat} or {model, ...}; layers have been read before.
void Reader::read_temperature(const Params& p, DraftMaterial& m) {
  if (!m.temperature) m.temperature.emplace();
  TemperatureSpec& spec = *m.temperature;
  spec.model = p.text("model", p.has("table") ? "tabulated" : "");
  const TemperatureRow& row = temperature_models().find(spec.model, p.where());
  if (const auto table = p.find("table"))
    for (const Params& pair : table->items()) {
      const std::vector<double> v = pair.as_numbers();
      if (v.size() != 2) throw pair.error("a point is [seconds, kelvin]");
      spec.times.push_back(v[0]);
      spec.kelvins.push_back(v[1]);
    }
  spec.repeat = p.boolean("repeat", false);
  if (const auto loads = p.find("loads")) {
    for (const Params& line : loads->at("table").items()) {
      const std::vector<double> v = line.as_numbers();
      if (v.size() < 3 || v.size() > 5)
        throw line.error("a row of loads is [seconds, absorbed sunlight W/m2, sky W/m2, air K, wind m/s]",
                         "air and wind may be left out");
      spec.load_times.push_back(v[0]);
      spec.loads.push_back({v[1], v[2], v.size() > 3 ? v[3] : 0, v.size() > 4 ? v[4] : 0});
    }
    if (spec.loads.empty()) throw loads->error("the table of loads is empty");
    spec.loads_repeat = loads->boolean("repeat", false);
  }
  for (const Parameter& parameter : row.parameters)
    if (const auto value = p.find(parameter.name)) {
      if (parameter.kind == Parameter::Kind::text)
        spec.texts[parameter.name] = value->as_text();
      else
        spec.numbers[parameter.name] = value->as_number();
    }
  // What the material says of itself holds unless the model says otherwise.
  if (spec.layers.empty())
    for (const auto& [name, value] : m.material.thermal) {
      const auto known = [&](const Parameter& q) { return q.name == name; };
      if (std::any_of(row.parameters.begin(), row.parameters.end(), known)) spec.numbers.try_emplace(name, value);
    }
  if (!row.takes_layers && !spec.layers.empty())
    throw p.error("temperature model '" + spec.model + "' takes no layers");
  check_temperature(spec, p.where());
  make_temperature_model(spec, p.where());
  if (spec.model == "heat") heated_material(spec, p.where());
}

}  // namespace suite::scene_text
