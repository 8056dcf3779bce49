#include "base/files.h"
#include "formats/hdf5/h5.h"
#include "formats/scene_hdf/internal.h"
#include "formats/scene_hdf/scene_hdf.h"

namespace suite {

namespace {

using h5::Writer;

// All meshes' arrays of one kind, one behind the other.
template <class T, class Get>
void put_all(Writer& w, const std::string& name, const std::vector<Mesh>& meshes, const char* units, Get get) {
  size_t total = 0;
  for (const Mesh& m : meshes) total += get(m).size();
  auto column = w.column(name, h5::native<T>(), total, units);
  for (const Mesh& m : meshes) column.append(get(m));
}

void write_meshes(Writer& w, const std::vector<Mesh>& meshes) {
  w.put_names("/meshes/name", pick(meshes, [](const Mesh& m) { return m.name; }));
  std::vector<double> origin;
  std::vector<Part> parts;
  for (const Mesh& m : meshes) {
    origin.insert(origin.end(), {m.origin.x, m.origin.y, m.origin.z});
    parts.insert(parts.end(), m.parts.begin(), m.parts.end());
  }
  w.put("/meshes/origin", origin, "m", 3);
  std::vector<double> boxes;
  for (const Mesh& m : meshes)
    if (const Box3 b = mesh_box(m); b.empty())
      boxes.insert(boxes.end(), 6, 0.0);
    else
      boxes.insert(boxes.end(), {b.low.x, b.low.y, b.low.z, b.high.x, b.high.y, b.high.z});
  w.put("/meshes/box", boxes, "m", 6);
  w.put("/meshes/vertices", pick(meshes, [](const Mesh& m) { return uint64_t{m.vertex_count()}; }), "1");
  w.put("/meshes/triangles", pick(meshes, [](const Mesh& m) { return uint64_t{m.triangle_count()}; }), "1");
  w.put("/meshes/has_normals", pick(meshes, [](const Mesh& m) { return uint8_t{!m.normals.empty()}; }), "1");
  w.put("/meshes/has_uvs", pick(meshes, [](const Mesh& m) { return uint8_t{!m.uvs.empty()}; }), "1");
  w.put("/meshes/parts", pick(meshes, [](const Mesh& m) { return static_cast<uint32_t>(m.parts.size()); }), "1");
  w.put_names("/parts/name", pick(parts, [](const Part& p) { return p.name; }));
  w.put("/parts/triangles", pick(parts, [](const Part& p) { return p.triangle_count; }), "1");
  w.put("/parts/material", pick(parts, [](const Part& p) { return p.material; }), "1");
  put_all<float>(w, "/geometry/positions", meshes, "m",
                 [](const Mesh& m) { return std::span<const float>(m.positions.data(), 3 * m.vertex_count()); });
  put_all<uint32_t>(w, "/geometry/indices", meshes, "1",
                    [](const Mesh& m) { return std::span<const uint32_t>(m.indices); });
  put_all<uint32_t>(w, "/geometry/normals", meshes, "1",
                    [](const Mesh& m) { return std::span<const uint32_t>(m.normals); });
  put_all<float>(w, "/geometry/uvs", meshes, "1", [](const Mesh& m) { return std::span<const float>(m.uvs); });
}

void write_hierarchy(Writer& w, const Scene& s) {
  w.put_names("/primitives/name", pick(s.primitives, [](const Primitive& p) { return p.name; }));
  w.put("/primitives/kind", pick(s.primitives, [](const Primitive& p) { return static_cast<uint8_t>(p.kind); }), "1");
  w.put("/primitives/material", pick(s.primitives, [](const Primitive& p) { return p.material; }), "1");
  w.put("/primitives/parameter_count",
        pick(s.primitives, [](const Primitive& p) { return static_cast<uint32_t>(p.parameters.size()); }), "1");
  std::vector<double> parameters;
  for (const Primitive& p : s.primitives) parameters.insert(parameters.end(), p.parameters.begin(), p.parameters.end());
  w.put("/primitives/parameters", parameters, "SI");
  w.put_names("/groups/name", pick(s.groups, [](const Group& g) { return g.name; }));
  w.put("/groups/placements", pick(s.groups, [](const Group& g) { return uint64_t{g.placements.size()}; }), "1");
  std::vector<double> transform;
  std::vector<uint8_t> kind;
  std::vector<uint32_t> target, material, tag, track;
  for (const Group& g : s.groups)
    for (const Placement& p : g.placements) {
      for (int r = 0; r < 3; ++r)
        transform.insert(transform.end(),
                         {p.to_parent.a[3 * r], p.to_parent.a[3 * r + 1], p.to_parent.a[3 * r + 2], p.to_parent.b[r]});
      kind.push_back(static_cast<uint8_t>(p.kind));
      target.push_back(p.target);
      material.push_back(p.material_override);
      tag.push_back(p.tag);
      track.push_back(p.track);
    }
  w.put("/placements/to_parent", transform, "m", 12);
  w.put("/placements/kind", kind, "1");
  w.put("/placements/target", target, "1");
  w.put("/placements/material", material, "1");
  w.put("/placements/tag", tag, "1");
  w.put("/placements/track", track, "1");
  w.put_names("/tags", s.tags);
}

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

void write_materials(Writer& w, const std::vector<Material>& materials) {
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

void write_maps(Writer& w, const Scene& s) {
  const auto& maps = s.class_maps;
  w.put_names("/class_maps/name", pick(maps, [](const ClassMap& m) { return m.name; }));
  std::vector<uint32_t> size, materials, count;
  std::vector<uint8_t> rule;
  std::vector<double> drape;
  for (const ClassMap& m : maps) {
    size.insert(size.end(), {m.width, m.height});
    rule.insert(rule.end(), {static_cast<uint8_t>(m.projection), static_cast<uint8_t>(m.drape.extend)});
    drape.insert(drape.end(), {m.drape.origin_x, m.drape.origin_y, m.drape.gsd_x, m.drape.gsd_y});
    count.push_back(static_cast<uint32_t>(m.materials.size()));
    materials.insert(materials.end(), m.materials.begin(), m.materials.end());
  }
  w.put("/class_maps/size", size, "1", 2);
  w.put("/class_maps/rule", rule, "1", 2);
  w.put("/class_maps/drape", drape, "m", 4);
  w.put("/class_maps/material_count", count, "1");
  w.put("/class_maps/materials", materials, "1");
  size_t total = 0;
  for (const ClassMap& m : maps) total += m.classes.size();
  auto classes = w.column("/class_maps/classes", h5::native<uint16_t>(), total, "1");
  for (const ClassMap& m : maps) classes.append(std::span<const uint16_t>(m.classes));
  w.put("/map_bindings/material", pick(s.map_bindings, [](const MapBinding& b) { return b.material; }), "1");
  w.put("/map_bindings/class_map", pick(s.map_bindings, [](const MapBinding& b) { return b.class_map; }), "1");
  w.put_names("/files/name", pick(s.files, [](const DataFile& f) { return f.name; }));
  w.put("/files/size", pick(s.files, [](const DataFile& f) { return uint64_t{f.bytes.size()}; }), "1");
  size_t bytes = 0;
  for (const DataFile& f : s.files) bytes += f.bytes.size();
  auto column = w.column("/files/bytes", h5::native<std::byte>(), bytes, "1");
  for (const DataFile& f : s.files) column.append(std::span<const std::byte>(f.bytes));
}

}  // namespace

void write_scene(const Scene& s, const Provenance& provenance, const std::string& path,
                 const Compression& compression) {
  AtomicFile file(path);
  std::vector<std::string> names;
  {
    Writer w(file.temporary(), path, [&](const std::string& name) {
      names.push_back(name);
      return compression.of_dataset(name);
    });
    w.attribute("format", h5::kFormat);
    w.attribute("version", h5::kVersionText);
    w.attribute("name", s.name);
    w.attribute("description", s.description);
    w.attribute("author", s.author);
    w.attribute("generator", provenance.generator);
    w.attribute("arguments", provenance.arguments);
    w.attribute("input_sha256", provenance.input_sha256);
    const double box[6] = {s.bounds.low.x,  s.bounds.low.y,  s.bounds.low.z,
                           s.bounds.high.x, s.bounds.high.y, s.bounds.high.z};
    w.attribute("bounds_m", box);
    const double origin[4] = {s.origin.latitude_deg, s.origin.longitude_deg, s.origin.ellipsoid_height_m,
                              s.origin.given ? 1.0 : 0.0};
    w.attribute("origin_latitude_deg_longitude_deg_height_m_given", origin);
    w.attribute("curvature", s.curved ? "wgs84" : "flat");
    write_meshes(w, s.meshes);
    w.attribute("epoch_utc", s.epoch);
    write_hierarchy(w, s);
    write_tracks(w, s);
    write_materials(w, s.materials);
    write_maps(w, s);
    write_property_maps(w, s);
    write_media(w, s);
    write_temperatures(w, s);
    w.put_names("/inputs/name", pick(provenance.inputs, [](const InputFile& f) { return f.name; }));
    w.put_names("/inputs/sha256", pick(provenance.inputs, [](const InputFile& f) { return f.sha256; }));
    w.close();
  }
  compression.check_names(names);
  file.commit();
}

}  // namespace suite
