// Meshes of a prepared scene: a table, and the large arrays behind it.
#include <algorithm>

#include "base/files.h"
#include "base/parallel.h"
#include "formats/scene_hdf/internal.h"

namespace suite {

namespace {

using h5::Reader;
using h5::Writer;

// One of the large arrays, read past the HDF5 library by several threads: contiguous and little-endian, as this machine
// is. A packed one is read by the library, which knows one thread only.
template <class T>
class Stored {
 public:
  Stored(Reader& r, const std::string& name, const char* units) : name_(name) {
    opened_ = r.open(name, h5::native<T>(), units, 1, -1);
    count_ = opened_.count;
    if (opened_.packed) return;
    offset_ = r.file_offset(name, opened_);
    opened_.dataset = h5::Handle();  // not needed, and it would keep the file open
  }
  // Sets aside the next n values; where they start.
  uint64_t take(Reader& r, uint64_t n) {
    if (n > count_ - at_) r.fail("dataset '" + name_ + "' is shorter than its table says");
    at_ += n;
    return at_ - n;
  }
  void finish(Reader& r) const {
    if (at_ != count_) r.fail("dataset '" + name_ + "' is longer than its table says");
  }
  const std::string& name() const { return name_; }
  bool packed() const { return opened_.packed; }
  // r: for a packed one.
  std::vector<T> values(Reader* r, const RandomAccessFile& file, uint64_t first, uint64_t n, size_t pad = 0) const {
    std::vector<T> out(n + pad);
    if (opened_.packed) {
      r->read(name_, opened_, h5::native<T>(), out.data(), first, n);
      return out;
    }
    file.read_at(offset_ + first * sizeof(T), std::as_writable_bytes(std::span(out.data(), n)));
    return out;
  }

 private:
  std::string name_;
  Reader::Opened opened_;
  uint64_t count_ = 0, offset_ = 0, at_ = 0;
};

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

// Where the arrays of all meshes are; outlives the HDF5 library's view of the file when they are read later.
struct MeshArrays {
  MeshArrays(Reader& r, const std::string& file)
      : path(file),
        raw(file),
        p(r, "/geometry/positions", "m"),
        uv(r, "/geometry/uvs", "1"),
        i(r, "/geometry/indices", "1"),
        nrm(r, "/geometry/normals", "1") {}
  struct Start {
    uint64_t p, i, n, uv;
    uint64_t vertices, triangles;
    bool normals, uvs;  // read them
    uint64_t bytes() const {
      return 12 * vertices + 12 * triangles + (normals ? 4 : 0) * vertices + (uvs ? 8 : 0) * vertices;
    }
  };
  void fill(Reader* r, const Start& s, const Mesh& mesh) const {
    mesh.indices = i.values(r, raw, s.i, 3 * s.triangles);
    if (s.normals) mesh.normals = nrm.values(r, raw, s.n, s.vertices);
    if (s.uvs) mesh.uvs = uv.values(r, raw, s.uv, 2 * s.vertices);
    mesh.positions = p.values(r, raw, s.p, 3 * s.vertices, s.vertices ? 1 : 0);
  }
  bool packed() const { return p.packed() || uv.packed() || i.packed() || nrm.packed(); }

  std::string path;
  RandomAccessFile raw;
  Stored<float> p, uv;
  Stored<uint32_t> i, nrm;
  std::vector<Start> starts;
};

// Lets every mesh fetch its own arrays.
void leave_for_later(const std::shared_ptr<const MeshArrays>& arrays, const MeshRows& rows, Loading& loading,
                     std::vector<Mesh>& meshes) {
  const auto later = std::make_shared<LaterReads>();
  for (size_t k = 0; k < meshes.size(); ++k) {
    const MeshArrays::Start& start = arrays->starts[k];
    if (start.vertices == 0 && start.triangles == 0) continue;
    auto stored = std::make_shared<StoredArrays>();
    stored->vertices = start.vertices, stored->triangles = start.triangles;
    stored->box = rows.box(k);
    stored->fill = [arrays, k, later](const Mesh& mesh) {
      arrays->fill(nullptr, arrays->starts[k], mesh);
      check_arrays(mesh, arrays->path);
      ++later->meshes_read;
      later->read += arrays->starts[k].bytes();
    };
    meshes[k].stored = std::move(stored);
    ++later->meshes;
    later->stored += start.bytes();
  }
  loading.row("geometry").why = "each mesh when a ray first comes to its tile";
  loading.report.later = later;
}

// The big arrays of all meshes, several meshes at a time, or each when it is asked for.
void read_mesh_arrays(Reader& r, const std::string& path, const MeshRows& rows, const std::vector<bool>& with_uvs,
                      Loading& loading, std::vector<Mesh>& meshes) {
  const auto arrays = std::make_shared<MeshArrays>(r, path);
  LoadRow &geometry = loading.row("geometry"), &textures = loading.row("texture coordinates");
  for (size_t k = 0; k < meshes.size(); ++k) {
    const uint64_t v = rows.vertices[k], t = rows.triangles[k];
    if (v > kNone || t > kNone) r.fail("mesh '" + rows.names[k] + "' is too large");
    arrays->starts.push_back({arrays->p.take(r, 3 * v), arrays->i.take(r, 3 * t),
                              arrays->nrm.take(r, rows.normals[k] ? v : 0), arrays->uv.take(r, rows.uvs[k] ? 2 * v : 0),
                              v, t, rows.normals[k] != 0, rows.uvs[k] && with_uvs[k]});
    geometry.stored += 12 * v + 12 * t + (rows.normals[k] ? 4 * v : 0);
    if (rows.uvs[k]) textures.stored += 8 * v, textures.read += with_uvs[k] ? 8 * v : 0;
  }
  arrays->p.finish(r), arrays->uv.finish(r), arrays->i.finish(r), arrays->nrm.finish(r);
  if (geometry.stored >= loading.needs.later_from && !arrays->packed())
    return leave_for_later(arrays, rows, loading, meshes);
  geometry.read = geometry.stored;
  for (const std::string* name : {&arrays->p.name(), &arrays->i.name(), &arrays->nrm.name()}) r.note_read(*name);
  if (textures.read) r.note_read(arrays->uv.name());
  const auto read = [&](size_t begin, size_t end) {
    for (size_t k = begin; k < end; ++k) arrays->fill(&r, arrays->starts[k], meshes[k]);
  };
  if (arrays->packed())
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
                    [](const Mesh& m) { return std::span<const uint32_t>(m.indices); });
  put_all<uint32_t>(w, "/geometry/normals", meshes, "1",
                    [](const Mesh& m) { return std::span<const uint32_t>(m.normals); });
  put_all<float>(w, "/geometry/uvs", meshes, "1", [](const Mesh& m) { return std::span<const float>(m.uvs); });
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
