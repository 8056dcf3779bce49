#include <algorithm>
#include <cmath>

#include "base/files.h"
#include "base/parallel.h"
#include "formats/hdf5/h5.h"
#include "formats/scene_hdf/internal.h"
#include "formats/scene_hdf/scene_hdf.h"
#include "optics/models.h"
#include "scene/curvature.h"
#include "scene/primitives.h"

namespace suite {

namespace {

using h5::Reader;

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

void read_hierarchy(Reader& r, Scene& s) {
  const std::vector<std::string> names = r.get_names("/primitives/name");
  const auto n = static_cast<long long>(names.size());
  const auto kind = r.get<uint8_t>("/primitives/kind", "1", 1, n);
  const auto material = r.get<uint32_t>("/primitives/material", "1", 1, n),
             count = r.get<uint32_t>("/primitives/parameter_count", "1", 1, n);
  Stretch<double> parameters(r, "/primitives/parameters", "SI");
  for (size_t k = 0; k < names.size(); ++k)
    s.primitives.push_back({names[k], static_cast<PrimitiveKind>(kind[k]), parameters.next(count[k]), material[k]});
  parameters.finish();

  const std::vector<std::string> groups = r.get_names("/groups/name");
  const auto placements = r.get<uint64_t>("/groups/placements", "1", 1, static_cast<long long>(groups.size()));
  const auto transform = r.get<double>("/placements/to_parent", "m", 12);
  const auto rows = static_cast<long long>(transform.size() / 12);
  const auto what = r.get<uint8_t>("/placements/kind", "1", 1, rows);
  const auto target = r.get<uint32_t>("/placements/target", "1", 1, rows),
             override_ = r.get<uint32_t>("/placements/material", "1", 1, rows);
  const auto tag = r.get<uint32_t>("/placements/tag", "1", 1, rows),
             track = r.get<uint32_t>("/placements/track", "1", 1, rows);
  size_t at = 0;
  for (size_t g = 0; g < groups.size(); ++g) {
    if (placements[g] > target.size() - at) r.fail("group '" + groups[g] + "' declares more placements than there are");
    Group group{groups[g], {}};
    group.placements.reserve(placements[g]);
    for (uint64_t q = 0; q < placements[g]; ++q, ++at) {
      const double* t = transform.data() + 12 * at;
      if (what[at] > static_cast<uint8_t>(TargetKind::primitive)) r.fail("a placement is of an unknown kind");
      group.placements.push_back({{{t[0], t[1], t[2], t[4], t[5], t[6], t[8], t[9], t[10]}, {t[3], t[7], t[11]}},
                                  static_cast<TargetKind>(what[at]),
                                  target[at],
                                  override_[at],
                                  tag[at],
                                  track[at]});
    }
    s.groups.push_back(std::move(group));
  }
  if (at != target.size()) r.fail("there are placements of no group");
  s.tags = r.get_names("/tags");
}

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

void read_materials(Reader& r, std::vector<Material>& materials) {
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

void read_maps(Reader& r, Scene& s) {
  const std::vector<std::string> names = r.get_names("/class_maps/name");
  const auto n = static_cast<long long>(names.size());
  const auto size = r.get<uint32_t>("/class_maps/size", "1", 2, n);
  const auto rule = r.get<uint8_t>("/class_maps/rule", "1", 2, n);
  const auto drape = r.get<double>("/class_maps/drape", "m", 4, n);
  const auto count = r.get<uint32_t>("/class_maps/material_count", "1", 1, n);
  Stretch<uint32_t> materials(r, "/class_maps/materials", "1");
  Stretch<uint16_t> classes(r, "/class_maps/classes", "1");
  for (size_t k = 0; k < names.size(); ++k) {
    ClassMap m;
    m.name = names[k];
    m.width = size[2 * k];
    m.height = size[2 * k + 1];
    if (rule[2 * k] > static_cast<uint8_t>(Projection::uv) ||
        rule[2 * k + 1] > static_cast<uint8_t>(Drape::Extend::none))
      r.fail("class map '" + m.name + "' has an unknown rule");
    m.projection = static_cast<Projection>(rule[2 * k]);
    m.drape = {drape[4 * k], drape[4 * k + 1], drape[4 * k + 2], drape[4 * k + 3],
               static_cast<Drape::Extend>(rule[2 * k + 1])};
    m.materials = materials.next(count[k]);
    m.classes = classes.next(uint64_t{m.width} * m.height);
    s.class_maps.push_back(std::move(m));
  }
  materials.finish(), classes.finish();
  const auto material = r.get<uint32_t>("/map_bindings/material", "1");
  const auto map = r.get<uint32_t>("/map_bindings/class_map", "1", 1, static_cast<long long>(material.size()));
  for (size_t k = 0; k < material.size(); ++k) s.map_bindings.push_back({material[k], map[k]});
  const std::vector<std::string> files = r.get_names("/files/name");
  const auto bytes = r.get<uint64_t>("/files/size", "1", 1, static_cast<long long>(files.size()));
  Stretch<std::byte> data(r, "/files/bytes", "1");
  for (size_t k = 0; k < files.size(); ++k) s.files.push_back({files[k], data.next(bytes[k])});
  data.finish();
}

// Gives every material that names an embedded file its bundle, and lets the table of models check what it was given.
void resolve(Scene& s, const std::string& path, const BundleReader& decode) {
  std::map<std::string, std::shared_ptr<const sqt::Bundle>> bundles;
  const Where where{path, 0, 0, {}, -1};
  const auto load = [&](ModelSpec& spec, const std::string& whose) {
    const auto file = spec.texts.find("file");
    if (file == spec.texts.end()) return;
    const auto found =
        std::find_if(s.files.begin(), s.files.end(), [&](const DataFile& f) { return f.name == file->second; });
    if (found == s.files.end())
      throw Error(where, whose + " names a file that is not in the scene", "prepare the scene again");
    if (decode && !bundles.count(found->name)) bundles[found->name] = decode(found->bytes, path + ":" + found->name);
    if (decode) spec.bundle = bundles[found->name];
  };
  for (Medium& m : s.media) {
    load(m.phase, "medium '" + m.id + "'");
    check_medium(m, where);
  }
  for (Material& m : s.materials) {
    if (m.surface.model.empty()) continue;
    load(m.surface, "material '" + m.id + "'");
    check_model(m.surface, where);
  }
}

void check_kind(const Reader& r) {
  if (r.text("format") != h5::kFormat) r.fail("is not a prepared scene");
  if (const std::string version = r.text("version"); version != h5::kVersionText)
    r.fail("has version '" + version + "', this program reads " + h5::kVersionText);
}

}  // namespace

Provenance read_provenance(const std::string& path) {
  Reader r(path);
  check_kind(r);
  Provenance p{r.text("generator"), r.text("arguments"), r.text("input_sha256"), {}};
  const std::vector<std::string> names = r.get_names("/inputs/name");
  const std::vector<std::string> hashes = r.get_names("/inputs/sha256", static_cast<long long>(names.size()));
  for (size_t k = 0; k < names.size(); ++k) p.inputs.push_back({names[k], hashes[k]});
  return p;
}

SceneOrigin read_scene_origin(const std::string& path) {
  Reader r(path);
  check_kind(r);
  const auto o = r.numbers("origin_latitude_deg_longitude_deg_height_m_given", 4);
  return {{o[0], o[1], o[2], o[3] != 0}, r.text("epoch_utc")};
}

Scene read_scene(const std::string& path, const BundleReader& decode, const SceneNeeds& needs, LoadReport* report) {
  Loading loading;
  loading.needs = needs;
  Reader r(path);
  check_kind(r);
  Scene s;
  s.name = r.text("name");
  s.description = r.text("description");
  s.author = r.text("author");
  const auto box = r.numbers("bounds_m", 6), origin = r.numbers("origin_latitude_deg_longitude_deg_height_m_given", 4);
  s.bounds = {{box[0], box[1], box[2]}, {box[3], box[4], box[5]}};
  s.origin = {origin[0], origin[1], origin[2], origin[3] != 0};
  const std::string curvature = r.text("curvature");
  s.curved = curvature == "wgs84";
  if (!s.curved && curvature != "flat") r.fail("has an unknown curvature '" + curvature + "'");
  if (s.curved && !s.origin.given) r.fail("is curved and has no origin");
  try {
    read_materials(r, s.materials);
    read_maps(r, s);
    read_property_maps(r, s, loading);
    read_temperatures(r, s, loading);
    s.epoch = r.text("epoch_utc");
    read_hierarchy(r, s);
    read_tracks(r, s, loading);
    read_media(r, s);
    set_flat_plane(s);
    resolve(s, path, decode);
    drop_unseen(s, loading);
    read_meshes(r, path, s, loading);
  } catch (const Error& e) {
    // Faults of the values (a curve, say) carry no place of their own.
    if (!e.where().file.empty()) throw;
    throw Error(Where{path, 0, 0, {}, -1}, e.message(), "prepare the scene again");
  }
  for (const Primitive& p : s.primitives) check_primitive(p, Where{path, 0, 0, {}, -1});
  check_scene(s, path);
  loading.report.datasets.assign(r.names_read().begin(), r.names_read().end());
  if (report) *report = std::move(loading.report);
  return s;
}

}  // namespace suite
