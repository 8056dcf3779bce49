#include <algorithm>

#include "base/files.h"
#include "formats/hdf5/format_version.h"
#include "formats/scene_hdf/columns.h"
#include "formats/scene_hdf/scene_hdf.h"
#include "optics/models.h"
#include "scene/curvature.h"
#include "scene/primitives.h"

namespace suite {

namespace {

using h5::Reader;

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

// Bindings to maps that were left out go with them.
void renumber_bindings(const Reader& r, Scene& s, const std::vector<uint32_t>& number) {
  for (PropertyBinding& b : s.property_bindings) {
    if (b.property_map >= number.size()) r.fail("a map binding names something that is not there");
    b.property_map = number[b.property_map];
  }
  std::erase_if(s.property_bindings, [](const PropertyBinding& b) { return b.property_map == kNone; });
}

void check_kind(const Reader& r) {
  if (r.text("format") != h5::kFormat) r.fail("is not a prepared scene");
  h5::check_version(r, h5::kVersionText);
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
    s.epoch = r.text("epoch_utc");
    for_each_table([&]<class Table>(Table table) {
      if constexpr (requires(ColumnReader<Material> & io) { Table::columns(io); }) {
        ColumnReader io(r, Table::name, s.*Table::rows);
        Table::columns(io);
      } else if constexpr (!std::is_same_v<Table, MeshTable>) {
        read_table(r, s, loading, table);
      }
    });
    renumber_bindings(r, s, loading.property_map);
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
