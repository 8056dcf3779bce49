// Materials of a prepared scene.
#include <cmath>

#include "formats/scene_hdf/internal.h"

namespace suite {

namespace {

using h5::Reader;
using h5::Writer;

// Every material's table of one kind, as rows (material, name, value).
template <class Value, class Get>
struct Rows {
  std::vector<uint32_t> material;
  std::vector<std::string> name;
  std::vector<Value> value;
  Rows(const std::vector<Material>& materials, Get get) {
    for (size_t m = 0; m < materials.size(); ++m)
      for (const auto& [key, v] : get(materials[m]))
        material.push_back(static_cast<uint32_t>(m)), name.push_back(key), value.push_back(v);
  }
};

// Calls visit(material, name, row) for the rows of a per-material table.
template <class Visit>
void each_row(Reader& r, const std::string& table, std::vector<Material>& materials, const Visit& visit) {
  const std::vector<std::string> names = r.get_names(table + "/name");
  const auto owner = r.get<uint32_t>(table + "/material", "1", 1, static_cast<long long>(names.size()));
  for (size_t k = 0; k < names.size(); ++k) {
    if (owner[k] >= materials.size()) r.fail("'" + table + "' names a material that is not there");
    visit(materials[owner[k]], names[k], k);
  }
}

void read_material_curves(Reader& r, std::vector<Material>& materials) {
  const std::string t = "/materials/curves";
  const std::vector<Curve> curves = read_curves(r, t);
  each_row(r, t, materials, [&](Material& m, const std::string& name, size_t k) {
    if (k >= curves.size()) r.fail("a curve is missing");
    m.surface.curves[name] = curves[k];
  });
}

}  // namespace

void write_table(Writer& w, const Scene& scene, MaterialTable) {
  const std::vector<Material>& materials = scene.materials;
  w.put_names("/materials/id", pick(materials, [](const Material& m) { return m.id; }));
  w.put_names("/materials/description", pick(materials, [](const Material& m) { return m.description; }));
  w.put_names("/materials/model", pick(materials, [](const Material& m) { return m.surface.model; }));
  w.put("/materials/temperature", pick(materials, [](const Material& m) { return m.temperature_k; }), "K");
  const auto put_rows = [&](const std::string& table, auto get, auto put_value) {
    const Rows<std::decay_t<decltype(get(materials.front()).begin()->second)>, decltype(get)> rows(materials, get);
    w.put(table + "/material", rows.material, "1");
    w.put_names(table + "/name", rows.name);
    put_value(table, rows.value);
  };
  put_rows(
      "/materials/numbers", [](const Material& m) -> const auto& { return m.surface.numbers; },
      [&](const std::string& t, const std::vector<double>& v) { w.put(t + "/value", v, "SI"); });
  put_rows(
      "/materials/thermal", [](const Material& m) -> const auto& { return m.thermal; },
      [&](const std::string& t, const std::vector<double>& v) { w.put(t + "/value", v, "SI"); });
  put_rows(
      "/materials/texts", [](const Material& m) -> const auto& { return m.surface.texts; },
      [&](const std::string& t, const std::vector<std::string>& v) { w.put_names(t + "/value", v); });
  put_rows(
      "/materials/curves", [](const Material& m) -> const auto& { return m.surface.curves; },
      [&](const std::string& t, const std::vector<Curve>& curves) { write_curves(w, t, curves); });
}

void read_table(Reader& r, Scene& scene, Loading&, MaterialTable) {
  std::vector<Material>& materials = scene.materials;
  const std::vector<std::string> ids = r.get_names("/materials/id");
  const auto n = static_cast<long long>(ids.size());
  const std::vector<std::string> descriptions = r.get_names("/materials/description", n),
                                 models = r.get_names("/materials/model", n);
  const auto temperature = r.get<double>("/materials/temperature", "K", 1, n);
  for (size_t k = 0; k < ids.size(); ++k) {
    Material m;
    m.id = ids[k];
    m.description = descriptions[k];
    m.surface.model = models[k];
    m.temperature_k = temperature[k];
    if (!(m.temperature_k >= 0 && m.temperature_k <= 1e5)) r.fail("material '" + m.id + "' has an absurd temperature");
    materials.push_back(std::move(m));
  }
  const auto numbers = r.get<double>("/materials/numbers/value", "SI"),
             thermal = r.get<double>("/materials/thermal/value", "SI");
  const std::vector<std::string> texts = r.get_names("/materials/texts/value");
  each_row(r, "/materials/numbers", materials, [&](Material& m, const std::string& name, size_t k) {
    m.surface.numbers[name] = k < numbers.size() ? numbers[k] : NAN;
  });
  each_row(r, "/materials/thermal", materials, [&](Material& m, const std::string& name, size_t k) {
    m.thermal[name] = k < thermal.size() ? thermal[k] : NAN;
  });
  each_row(r, "/materials/texts", materials, [&](Material& m, const std::string& name, size_t k) {
    if (k >= texts.size()) r.fail("a text of a material is missing");
    m.surface.texts[name] = texts[k];
  });
  read_material_curves(r, materials);
}

}  // namespace suite
