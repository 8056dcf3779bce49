// Meshes of a prepared scene: a table, and the large arrays behind it.
#include <algorithm>

#include "base/parallel.h"
#include "formats/scene_hdf/mesh_arrays.h"

namespace suite {

namespace {

using h5::Reader;
using h5::Writer;

struct MeshRows {
  std::vector<std::string> names;
  std::vector<double> origin;
  std::vector<uint64_t> vertices, triangles;
  std::vector<uint8_t> normals, uvs;
  std::vector<double> boxes;  // low xyz, high xyz
  Box3 box(size_t k) const {
    const double* b = &boxes[6 * k];
    return {{b[0], b[1], b[2]}, {b[3], b[4], b[5]}};
  }
};

// Lets every mesh of a mapped file check its arrays, which reads them, when it is asked to.
void leave_for_later(const MeshArrays& arrays, const MeshRows& rows, Loading& loading, std::vector<Mesh>& meshes) {
  const auto later = std::make_shared<LaterReads>();
  for (size_t k = 0; k < meshes.size(); ++k) {
    const uint64_t bytes = arrays.starts[k].bytes();
    if (bytes == 0) continue;
    auto stored = std::make_shared<StoredArrays>();
    stored->box = rows.box(k);
    stored->fetch = [path = arrays.path, bytes, later](const Mesh& mesh) {
      check_arrays(mesh, path);
      ++later->meshes_read;
      later->read += bytes;
    };
    meshes[k].stored = std::move(stored);
    ++later->meshes;
    later->stored += bytes;
  }
  loading.row("geometry").why = "each mesh when a ray first comes to its tile";
  loading.report.later = later;
}

// Packed ones, into a file.
void unpack_all(Reader& r, const MeshArrays& arrays, const MeshRows& rows, const SceneNeeds& needs,
                std::vector<Mesh>& meshes) {
  for (size_t k = 0; k < meshes.size(); ++k)
    if (arrays.starts[k].bytes()) {
      meshes[k].stored = std::make_shared<StoredArrays>();
      meshes[k].stored->box = rows.box(k);
      meshes[k].stored->here = true;
    }
  unpack(r, arrays, needs.spill, meshes, [&](const Mesh& mesh) {
    check_arrays(mesh, arrays.path);
    mesh.let_go();
  });
}

// The big arrays of all meshes, several meshes at a time, or each when it is asked for.
void read_mesh_arrays(Reader& r, const std::string& path, const MeshRows& rows, const std::vector<bool>& with_uvs,
                      Loading& loading, std::vector<Mesh>& meshes) {
  const SceneNeeds& needs = loading.needs;
  MeshArrays arrays(r, path, needs.later_from == UINT64_MAX);
  LoadRow &geometry = loading.row("geometry"), &textures = loading.row("texture coordinates");
  for (size_t k = 0; k < meshes.size(); ++k) {
    const uint64_t v = rows.vertices[k], t = rows.triangles[k];
    if (v > kNone || t > kNone) r.fail("mesh '" + rows.names[k] + "' is too large");
    arrays.starts.push_back({arrays.p.take(r, 3 * v), arrays.i.take(r, 3 * t),
                             arrays.nrm.take(r, rows.normals[k] ? v : 0), arrays.uv.take(r, rows.uvs[k] ? 2 * v : 0), v,
                             t, rows.normals[k] != 0, rows.uvs[k] && with_uvs[k]});
    geometry.stored += 12 * v + 12 * t + (rows.normals[k] ? 4 * v : 0);
    if (rows.uvs[k]) textures.stored += 8 * v, textures.read += with_uvs[k] ? 8 * v : 0;
  }
  arrays.p.finish(r), arrays.uv.finish(r), arrays.i.finish(r), arrays.nrm.finish(r);
  const bool large = geometry.stored >= needs.later_from;
  if (large && !arrays.packed() && map_plain(arrays, meshes)) return leave_for_later(arrays, rows, loading, meshes);
  geometry.read = geometry.stored;
  for (const std::string* name : {&arrays.p.name(), &arrays.i.name(), &arrays.nrm.name()}) r.note_read(*name);
  if (textures.read) r.note_read(arrays.uv.name());
  if (large) return unpack_all(r, arrays, rows, needs, meshes);
  const auto read = [&](size_t begin, size_t end) {
    for (size_t k = begin; k < end; ++k) arrays.read(r, arrays.starts[k], meshes[k]);
  };
  if (arrays.packed())
    read(0, meshes.size());
  else
    parallel_for(0, meshes.size(), 1, read);
}

// All meshes' arrays of one kind, one behind the other.
template <class T, class Get>
void put_all(Writer& w, const std::string& name, const std::vector<Mesh>& meshes, const char* units, Get get) {
  size_t total = 0;
  for (const Mesh& m : meshes) total += get(m).size();
  auto column = w.column(name, h5::native<T>(), total, units);
  for (const Mesh& m : meshes) column.append(get(m));
}

}  // namespace

void write_table(Writer& w, const Scene& scene, MeshTable) {
  const std::vector<Mesh>& meshes = scene.meshes;
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
                    [](const Mesh& m) { return std::span(m.indices.data(), m.indices.size()); });
  put_all<uint32_t>(w, "/geometry/normals", meshes, "1",
                    [](const Mesh& m) { return std::span(m.normals.data(), m.normals.size()); });
  put_all<float>(w, "/geometry/uvs", meshes, "1", [](const Mesh& m) { return std::span(m.uvs.data(), m.uvs.size()); });
}

// After everything else: what the materials are decides what is read of the meshes.
void read_meshes(Reader& r, const std::string& path, Scene& scene, Loading& loading) {
  std::vector<Mesh>& meshes = scene.meshes;
  MeshRows rows;
  rows.names = r.get_names("/meshes/name");
  const auto n = static_cast<long long>(rows.names.size());
  rows.origin = r.get<double>("/meshes/origin", "m", 3, n);
  rows.vertices = r.get<uint64_t>("/meshes/vertices", "1", 1, n);
  rows.triangles = r.get<uint64_t>("/meshes/triangles", "1", 1, n);
  rows.normals = r.get<uint8_t>("/meshes/has_normals", "1", 1, n);
  rows.uvs = r.get<uint8_t>("/meshes/has_uvs", "1", 1, n);
  rows.boxes = r.get<double>("/meshes/box", "m", 6, n);
  const auto parts = r.get<uint32_t>("/meshes/parts", "1", 1, n);
  const std::vector<std::string> part_name = r.get_names("/parts/name");
  const auto part_rows = static_cast<long long>(part_name.size());
  const auto part_triangles = r.get<uint32_t>("/parts/triangles", "1", 1, part_rows),
             part_material = r.get<uint32_t>("/parts/material", "1", 1, part_rows);
  meshes.resize(rows.names.size());
  size_t part = 0;
  for (size_t k = 0; k < meshes.size(); ++k) {
    Mesh& m = meshes[k];
    m.name = rows.names[k];
    m.origin = {rows.origin[3 * k], rows.origin[3 * k + 1], rows.origin[3 * k + 2]};
    if (!finite(m.origin)) r.fail("mesh '" + m.name + "' has an origin that is not finite");
    const Box3 box = rows.box(k);
    if (rows.vertices[k] && !(finite(box.low) && finite(box.high) && box.low.x <= box.high.x &&
                              box.low.y <= box.high.y && box.low.z <= box.high.z))
      r.fail("mesh '" + m.name + "' has no sound box");
    if (parts[k] > part_name.size() - part) r.fail("mesh '" + m.name + "' declares more parts than there are");
    uint32_t first = 0;
    for (uint32_t q = 0; q < parts[k]; ++q, ++part) {
      m.parts.push_back({part_name[part], first, part_triangles[part], part_material[part]});
      if (part_triangles[part] > rows.triangles[k] - first)
        r.fail("mesh '" + m.name + "' has parts larger than itself");
      first += part_triangles[part];
    }
  }
  if (part != part_name.size()) r.fail("there are parts of no mesh");
  const std::vector<bool> with_uvs = meshes_with_uvs(scene, loading);
  read_mesh_arrays(r, path, rows, with_uvs, loading, meshes);
}

}  // namespace suite
