// Objects that are meshes in files of modelling tools.
#include <algorithm>
#include <filesystem>
#include <iterator>

#include "base/files.h"
#include "formats/assimp/assimp.h"
#include "formats/city/city.h"
#include "formats/dirsig/dirsig.h"
#include "formats/gltf/gltf.h"
#include "formats/obj/mtl.h"
#include "formats/ply/ply.h"
#include "formats/scene_text/reader.h"
#include "formats/stl/stl.h"

namespace suite::scene_text {

// What holds for a mesh whatever file it comes from.
void Reader::read_mesh_rules(const Params& p, DraftGeometry& g) {
  g.kind = DraftGeometry::Kind::mesh;
  if (const auto materials = p.find("materials"))
    for (const std::string& name : materials->keys()) g.materials[name] = reference(materials->at(name));
  constexpr NormalRule rules[] = {NormalRule::file, NormalRule::facet, NormalRule::smooth};
  if (const auto normals = p.find("normals")) g.normals = rules[normals->as_choice({"file", "facet", "smooth"})];
  if (const auto crease = p.find("crease_deg")) {
    if (g.normals != NormalRule::smooth) throw crease->error("'crease_deg' goes with 'normals: smooth'");
    g.crease_rad = p.number_in("crease_deg", 0, 180, "degrees") * kPi / 180;
  }
  if (p.has("fill_holes")) g.fill_holes = static_cast<size_t>(p.integer("fill_holes", 3, 1000));
  if (const auto decimate = p.find("decimate")) {
    if (!decimate->has("to") && !decimate->has("error_m"))
      throw decimate->error("'decimate' says neither how far nor how exactly", "give 'to', 'error_m' or both");
    g.decimate = DecimationRule{};
    if (decimate->has("to")) g.decimate->to = decimate->number_in("to", 0, 1, "of the triangles");
    if (decimate->has("error_m")) g.decimate->error_m = decimate->number_in("error_m", 1e-9, 1e9, "m");
  }
}

namespace {

double unit_of(const Params& p) { return p.number_in("unit_m", 1e-9, 1e9, "m", 1); }

bool y_up(const Params& p, bool otherwise) {
  const auto up = p.find("up");
  return up ? up->as_choice({"z", "y"}) == 1 : otherwise;
}

}  // namespace

void Reader::read_mesh(const Params& p, const std::string& kind, DraftGeometry& g) {
  read_mesh_rules(p, g);
  if (kind == "city") return read_city_mesh(p, g);
  const double unit = unit_of(p);
  g.to_local = scaling({unit, unit, unit});
  if (y_up(p, false)) g.to_local = g.to_local * kFromYUp;
  if (kind == "obj") {
    read_obj_mesh(p, g);
  } else if (kind == "ply") {
    g.mesh = of_file([&] { return read_ply(input(p.at("ply")), report_); });
  } else if (kind == "stl") {
    g.mesh = of_file([&] { return read_stl(input(p.at("stl")), report_); });
  } else if (kind == "gdb") {
    const std::string path = input(p.at("gdb"));
    g.mesh = parse_obj(dirsig::obj_of_gdb(read_text(path), path), path, report_);
    forget_temperatures(p, g.mesh);
  } else {
    ObjLook look;
    g.mesh = parse_obj(p.at("obj_text").as_text(), g.name + " (obj_text)", report_, &look);
    report_left_out(look, g.mesh.file, report_);
  }
}

// Files that a model names, by its own place.
std::function<std::string(const std::string&)> Reader::beside(const Params& file) {
  return [this, file, folder = std::filesystem::path(file.as_text()).parent_path()](const std::string& name) {
    try {
      return inputs_.add((folder / name).string()).path;
    } catch (const Error& e) {
      throw Error(file.where(), "its file '" + printable(name) + "': " + e.message(), e.hint(), "SP003");
    }
  };
}

// With `textures` the colours of its materials, as a model's.
void Reader::read_obj_mesh(const Params& p, DraftGeometry& g) {
  const Params file = p.at("obj");
  ObjLook look;
  g.mesh = read_obj(input(file), report_, &look);
  const auto textures = p.find("textures");
  if (!textures) return report_left_out(look, g.mesh.file, report_);
  if (look.libraries.empty())
    throw textures->error("'" + file.as_text() + "' names no library of materials (mtllib)", "leave 'textures' out");
  SourceModel model;
  model.materials = of_file([&] { return read_mtl(g.mesh, look, beside(file), report_); });
  of_file([&] { read_textures(*textures, model, g); });
}

// Facets with temperatures of their own have materials ID@-23.15C; where the text has none of that name they are as the
// others of their ID.
void Reader::forget_temperatures(const Params& p, SourceMesh& mesh) {
  const auto named = p.find("materials");
  size_t lost = 0;
  for (SourceMesh::Run& run : mesh.runs) {
    const size_t at = run.material.rfind('@');
    if (at == run.material.npos || !run.material.ends_with('C') || (named && named->has(run.material))) continue;
    run.material.resize(at);
    ++lost;
  }
  if (lost)
    report_.add(
        "SP705", mesh.file,
        {Where{mesh.file, 0, 0, {}, -1},
         strf("%zu runs of facets have temperatures of their own, which 'materials: {ID@CELSIUSC: ...}' keeps", lost)});
}

// Where a city is: on the Earth by the file's reference system (or the one that is given in its place), or as if its
// map were flat, around a place of it.
void Reader::read_city_mesh(const Params& p, DraftGeometry& g) {
  const Params file = p.at("city");
  std::optional<std::string> lod;
  if (const auto given = p.find("lod")) {
    lod = given->as_text();
    given->as_number_in(0, 9.9, "");
  }
  const std::string path = input(file);
  const CityModel city = of_file([&] { return read_city(path, lod, report_); });
  g.mesh = of_file([&] { return mesh_of(city, map_place(p, city.system, file, false), report_); });
}

// The model becomes a group of the object's name; its meshes are objects of their own. slot: where the object's name
// stands among the geometry until then.
void Reader::read_model(const Params& p, const std::string& kind, DraftGeometry g, size_t slot) {
  read_mesh_rules(p, g);
  SourceModelOptions options;
  options.name = g.name;
  options.where = g.where;
  options.unit_m = unit_of(p);
  options.y_up = y_up(p, true);
  if (kind == "gltf") options.animation = p.text("animation", "");
  const auto textures = kind == "gltf" ? p.find("textures") : std::nullopt;
  options.textures = textures.has_value();
  const Params file = p.at(kind);
  options.resolve = beside(file);
  SourceModel model = of_file([&] {
    if (kind == "gltf") return read_gltf(input(file), options, report_);
    return read_assimp(input(file), options, p.has("up") ? &options.y_up : nullptr, report_);
  });
  if (textures) of_file([&] { read_textures(*textures, model, g); });
  draft_.geometry.erase(draft_.geometry.begin() + static_cast<std::ptrdiff_t>(slot));
  for (SourceModel::Part& part : model.meshes) {
    DraftGeometry& made = draft_.geometry.emplace_back(g);
    made.name = part.name;
    made.mesh = std::move(part.mesh);
  }
  std::move(model.groups.begin(), model.groups.end(), std::back_inserter(models_));
}

}  // namespace suite::scene_text
