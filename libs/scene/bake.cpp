#include "scene/bake.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <set>

#include "motion/track.h"

namespace suite {

namespace {

template <class Table, class Name>
std::vector<std::string> names_of(const Table& table, Name name) {
  std::vector<std::string> names;
  for (const auto& row : table) names.push_back(name(row));
  return names;
}

class Baker {
 public:
  Baker(const Draft& draft, Report& report) : draft_(draft), report_(report) {}

  Scene run() {
    scene_.name = draft_.name;
    scene_.description = draft_.description;
    scene_.author = draft_.author;
    scene_.origin = draft_.origin;
    scene_.files = draft_.files;
    materials();
    bake_media(draft_, report_, scene_, motion_where_);
    class_maps();
    property_maps();
    geometry();
    groups();
    unused();
    scene_.epoch = draft_.epoch;
    const TimeSpan times = time_window();
    if (report_.count(Severity::error) == 0) scene_.bounds = scene_bounds(scene_, times.begin, times.end);
    return std::move(scene_);
  }

 private:
  // What a geometry became: the targets a placement of it places.
  struct Built {
    TargetKind kind;
    uint32_t first, count;
    const TerrainGrid* terrain = nullptr;
  };

  void add(const char* code, const Where& where, const std::string& message) {
    report_.add(code, draft_.file, {where, message});
  }

  uint32_t material_id(const Reference& ref) {
    if (const auto found = material_ids_.find(ref.name); found != material_ids_.end()) {
      used_materials_.insert(ref.name);
      return found->second;
    }
    const auto known = names_of(draft_.materials, [](const DraftMaterial& m) { return m.material.id; });
    add("SP102", ref.where, "unknown material '" + ref.name + "'; " + name_hint(ref.name, known));
    return kNone;
  }

  void materials();
  void check_coverage(const DraftMaterial& m);
  void class_maps();
  void property_maps();
  void check_parts(const PropertyMap& map, const Where& where);
  void geometry();
  Built build_mesh(const DraftGeometry& g);
  Built build_terrain(const DraftGeometry& g);
  Built build_primitive(const DraftGeometry& g);
  void groups();
  std::vector<size_t> group_order();
  std::optional<Built> target(const Reference& ref);
  std::vector<Affine3> transforms(const DraftPlacement& p);
  bool put_on(const DraftPlacement& p, bool world, std::vector<Affine3>& all);
  void place(const DraftPlacement& p, Group& group, bool world);
  TimeSpan time_window();
  void unused();

  const Draft& draft_;
  Report& report_;
  Scene scene_;
  std::map<std::string, uint32_t> material_ids_, map_ids_, tag_ids_, group_ids_;
  std::map<std::string, Built> built_;
  std::vector<std::unique_ptr<TerrainGrid>> terrains_;
  std::vector<Where> motion_where_;  // of scene_.tracks
  std::set<std::string> used_materials_, used_maps_, used_targets_;
};

void Baker::check_coverage(const DraftMaterial& m) {
  const auto check = [&](const std::string& what, const Curve& curve) {
    for (const SpectralWindow& w : draft_.windows)
      if (!curve.covers(w.low_um, w.high_um))
        add("SP104", m.where,
            strf("material '%s': %s is given from %g to %g um, the window is %g to %g um", m.material.id.c_str(),
                 what.c_str(), curve.low_um(), curve.high_um(), w.low_um, w.high_um));
  };
  for (const auto& [name, curve] : m.material.surface.curves) check(name, curve);
  for (const DraftPropertyMap& map : draft_.property_maps)
    for (const Reference& r : m.property_maps)
      if (r.name == map.map.name)
        for (const Curve& curve : map.map.family) check("a curve of map '" + r.name + "'", curve);
}

void Baker::materials() {
  for (const DraftMaterial& m : draft_.materials) {
    material_ids_[m.material.id] = static_cast<uint32_t>(scene_.materials.size());
    scene_.materials.push_back(m.material);
    if (m.temperature) scene_.temperatures.push_back({material_ids_[m.material.id], *m.temperature});
    if (m.has_model) check_coverage(m);
    // The sum over both sides' shares must stay below 1 wherever either curve has a knot.
    const auto& curves = m.material.surface.curves;
    const auto rho = curves.find("reflectance"), tau = curves.find("transmittance");
    if (rho == curves.end() || tau == curves.end()) continue;
    for (const Curve* c : {&rho->second, &tau->second})
      for (const double w : c->wavelength_um())
        if (rho->second.covers(w, w) && tau->second.covers(w, w) && rho->second.at(w) + tau->second.at(w) > 1 + 1e-9) {
          add("SP105", m.where,
              strf("material '%s': reflectance %g + transmittance %g at %g um", m.material.id.c_str(),
                   rho->second.at(w), tau->second.at(w), w));
          goto next;
        }
  next:;
  }
}

void Baker::class_maps() {
  for (const DraftClassMap& d : draft_.class_maps) {
    ClassMap map = d.map;
    map_ids_[map.name] = static_cast<uint32_t>(scene_.class_maps.size());
    // Renumber the raster's values to 0, 1, ... in the order of the values.
    std::map<uint16_t, uint16_t> index;
    for (const auto& [value, ref] : d.materials) {
      index[value] = static_cast<uint16_t>(map.materials.size());
      map.materials.push_back(material_id(ref));
    }
    std::map<uint16_t, size_t> missing;
    for (uint16_t& c : map.classes) {
      const auto found = index.find(c);
      if (found == index.end())
        ++missing[c];
      else
        c = found->second;
    }
    for (const auto& [value, count] : missing)
      report_.add("SP502", map.name, {d.where, strf("class %u (%zu pixels) has no material", value, count)}, count);
    scene_.class_maps.push_back(std::move(map));
  }
  for (size_t m = 0; m < draft_.materials.size(); ++m) {
    const DraftMaterial& d = draft_.materials[m];
    if (!d.map.given()) continue;
    const auto found = map_ids_.find(d.map.name);
    if (found == map_ids_.end()) {
      const auto known = names_of(draft_.class_maps, [](const DraftClassMap& c) { return c.map.name; });
      add("SP501", d.map.where, "unknown map '" + d.map.name + "'; " + name_hint(d.map.name, known));
      continue;
    }
    used_maps_.insert(d.map.name);
    const ClassMap& map = scene_.class_maps[found->second];
    scene_.map_bindings.push_back({static_cast<uint32_t>(m), found->second});
    for (const uint32_t id : map.materials)
      if (id == m || (id != kNone && draft_.materials[id].map.given()))
        add("SP501", d.map.where,
            "map '" + d.map.name + "' leads to material '" + draft_.materials[id].material.id +
                "', which a map decides again");
    if (!d.has_model && !map.materials.empty() && map.materials.front() != kNone)
      scene_.materials[m].surface = draft_.materials[map.materials.front()].material.surface;
  }
}

// A mixture puts whole materials side by side, which cannot be mixtures or bend the surface themselves.
void Baker::check_parts(const PropertyMap& map, const Where& where) {
  for (const uint32_t id : map.materials) {
    if (id == kNone) continue;
    const DraftMaterial& part = draft_.materials[id];
    bool fits = part.has_model && !part.map.given();
    for (const Reference& r : part.property_maps)
      for (const DraftPropertyMap& m : draft_.property_maps)
        if (m.map.name == r.name && (m.map.kind == MapKind::mixture || m.map.kind >= MapKind::bump)) fits = false;
    if (!fits)
      add("SP501", where,
          "material '" + part.material.id + "' cannot be part of mixture '" + map.name +
              "': a part has a model and at most curve index, texture, cube and temperature maps");
  }
}

void Baker::property_maps() {
  std::map<std::string, uint32_t> ids;
  for (const DraftPropertyMap& d : draft_.property_maps) {
    PropertyMap map = d.map;
    for (const Reference& r : d.materials) map.materials.push_back(material_id(r));
    ids[map.name] = static_cast<uint32_t>(scene_.property_maps.size());
    scene_.property_maps.push_back(std::move(map));
  }
  for (size_t m = 0; m < draft_.materials.size(); ++m) {
    std::set<MapKind> kinds;
    for (const Reference& r : draft_.materials[m].property_maps) {
      const auto found = ids.find(r.name);
      if (found == ids.end()) {
        add("SP501", r.where,
            "unknown map '" + r.name + "'; " +
                name_hint(r.name, names_of(draft_.property_maps, [](const auto& p) { return p.map.name; })));
        continue;
      }
      used_maps_.insert(r.name);
      const PropertyMap& map = scene_.property_maps[found->second];
      check_parts(map, r.where);
      if (!kinds.insert(map.kind).second)
        add("SP501", r.where,
            "material '" + draft_.materials[m].material.id + "' has two maps of the kind of '" + r.name + "'");
      if (!map.parameter.empty() && !scene_.materials[m].surface.curves.count(map.parameter))
        add("SP501", r.where,
            "the model of material '" + draft_.materials[m].material.id + "' has no curve '" + map.parameter +
                "' for map '" + r.name + "'");
      scene_.property_bindings.push_back({static_cast<uint32_t>(m), found->second});
    }
  }
}

Baker::Built Baker::build_mesh(const DraftGeometry& g) {
  std::vector<uint32_t> ids;
  std::set<std::string> told;
  for (const SourceMesh::Run& run : g.mesh.runs) {
    if (const auto found = g.materials.find(run.material); found != g.materials.end()) {
      ids.push_back(material_id(found->second));
    } else if (material_ids_.count(run.material)) {
      ids.push_back(material_id({run.material, {}}));
    } else if (g.material.given()) {
      ids.push_back(material_id(g.material));
    } else {
      if (told.insert(run.material).second)
        add("SP102", {g.mesh.file, run.line, 0, {}, -1},
            run.material.empty() ? "faces without 'usemtl' in '" + g.name + "'; give the object a 'material'"
                                 : "unknown material '" + run.material +
                                       "'; define it, or map the name under 'materials' of '" + g.name + "'");
      ids.push_back(kNone);
    }
  }
  if (g.material.given()) material_id(g.material);  // even when every face has a better one, the name must exist
  Mesh mesh = make_mesh(g.mesh, g.to_local, g.normals, ids);
  mesh.name = g.name;
  scene_.meshes.push_back(std::move(mesh));
  return {TargetKind::mesh, static_cast<uint32_t>(scene_.meshes.size() - 1), 1, nullptr};
}

Baker::Built Baker::build_terrain(const DraftGeometry& g) {
  try {
    terrains_.push_back(std::make_unique<TerrainGrid>(g.terrain));
  } catch (const Error& e) {  // a sample that lies nowhere on Earth
    add("SP504", g.where, "terrain '" + g.name + "': " + e.message());
    return {TargetKind::mesh, static_cast<uint32_t>(scene_.meshes.size()), 0, nullptr};
  }
  const auto first = static_cast<uint32_t>(scene_.meshes.size());
  std::vector<Mesh> tiles = terrains_.back()->tiles(g.name, g.tile_m, material_id(g.material));
  if (tiles.empty()) add("SP504", g.where, "terrain '" + g.name + "' has no two by two samples with heights");
  for (Mesh& t : tiles) scene_.meshes.push_back(std::move(t));
  return {TargetKind::mesh, first, static_cast<uint32_t>(scene_.meshes.size()) - first, terrains_.back().get()};
}

Baker::Built Baker::build_primitive(const DraftGeometry& g) {
  Primitive p = g.primitive;
  p.name = g.name;
  p.material = material_id(g.material);
  scene_.primitives.push_back(std::move(p));
  return {TargetKind::primitive, static_cast<uint32_t>(scene_.primitives.size() - 1), 1, nullptr};
}

void Baker::geometry() {
  for (const DraftGeometry& g : draft_.geometry) switch (g.kind) {
      case DraftGeometry::Kind::mesh:
      case DraftGeometry::Kind::voxels:
        built_[g.name] = build_mesh(g);
        break;
      case DraftGeometry::Kind::terrain:
        built_[g.name] = build_terrain(g);
        break;
      case DraftGeometry::Kind::primitive:
        built_[g.name] = build_primitive(g);
        break;
    }
}

// World first, every group before the groups it contains (Kahn 1962); groups in a cycle are reported and left out.
std::vector<size_t> Baker::group_order() {
  std::map<std::string, size_t> row;
  for (size_t i = 0; i < draft_.groups.size(); ++i) row[draft_.groups[i].name] = i;
  std::vector<size_t> parents(draft_.groups.size(), 0), order;
  const auto each_child = [&](size_t g, const auto& visit) {
    std::set<size_t> seen;
    for (const DraftPlacement& p : draft_.groups[g].placements)
      if (const auto found = row.find(p.target.name);
          found != row.end() && !built_.count(p.target.name) && seen.insert(found->second).second)
        visit(found->second);
  };
  for (size_t g = 0; g < draft_.groups.size(); ++g) each_child(g, [&](size_t c) { ++parents[c]; });
  std::vector<size_t> ready;
  for (size_t g = draft_.groups.size(); g-- > 0;)
    if (parents[g] == 0) ready.push_back(g);
  while (!ready.empty()) {
    const size_t g = ready.back();
    ready.pop_back();
    order.push_back(g);
    each_child(g, [&](size_t c) {
      if (--parents[c] == 0) ready.push_back(c);
    });
  }
  for (size_t g = 0; g < draft_.groups.size(); ++g)
    if (parents[g]) add("SP402", draft_.groups[g].where, "group '" + draft_.groups[g].name + "' is part of a circle");
  // World is never inside another group, so it is ready at once; it must come first.
  const auto world = std::find(order.begin(), order.end(), size_t{0});
  if (world != order.end()) std::rotate(order.begin(), world, world + 1);
  return order;
}

// What a name places; nothing when it is unknown (which is filed) or part of a circle (which has been).
std::optional<Baker::Built> Baker::target(const Reference& ref) {
  used_targets_.insert(ref.name);
  if (const auto found = built_.find(ref.name); found != built_.end()) return found->second;
  if (const auto found = group_ids_.find(ref.name); found != group_ids_.end())
    return Built{TargetKind::group, found->second, 1, nullptr};
  std::vector<std::string> known = names_of(draft_.geometry, [](const DraftGeometry& g) { return g.name; });
  for (size_t g = 1; g < draft_.groups.size(); ++g) {
    if (draft_.groups[g].name == ref.name) return std::nullopt;
    known.push_back(draft_.groups[g].name);
  }
  add("SP401", ref.where, "unknown object '" + ref.name + "'; " + name_hint(ref.name, known));
  return std::nullopt;
}

// The transforms of one placement: one, or as many as its table or scatter has.
std::vector<Affine3> Baker::transforms(const DraftPlacement& p) {
  std::vector<Affine3> all;
  if (p.scatter) {
    const auto ground = built_.find(p.on.name);
    if (ground == built_.end() || ground->second.kind != TargetKind::mesh) {
      add("SP405", p.on.where, "'" + p.on.name + "' is no terrain and no mesh");
      return all;
    }
    for (const Affine3& row :
         scatter(std::span(scene_.meshes).subspan(ground->second.first, ground->second.count), *p.scatter))
      all.push_back(row * p.to_parent);
    return all;
  }
  if (!p.table) all.push_back(p.to_parent);
  for (const Affine3& row : p.rows) all.push_back(p.to_parent * row);
  return all;
}

// Lifts transforms onto a terrain.
bool Baker::put_on(const DraftPlacement& p, bool world, std::vector<Affine3>& all) {
  const auto ground = built_.find(p.on.name);
  if (!world)
    return add("SP405", p.on.where, "'on' counts in 'world' only: groups do not know where they will stand"), false;
  if (ground == built_.end() || !ground->second.terrain)
    return add("SP405", p.on.where, "'" + p.on.name + "' is no terrain"), false;
  for (Affine3& t : all) {
    const auto z = ground->second.terrain->height_at(t.b.x, t.b.y);
    if (!z) return add("SP405", p.where, strf("(%g, %g) is not on '%s'", t.b.x, t.b.y, p.on.name.c_str())), false;
    t.b.z += *z;
  }
  return true;
}

void Baker::place(const DraftPlacement& p, Group& group, bool world) {
  Placement made;
  if (p.material.given()) made.material_override = material_id(p.material);
  if (p.tag.given()) {
    const auto [tag, fresh] = tag_ids_.try_emplace(p.tag.name, static_cast<uint32_t>(scene_.tags.size()));
    if (fresh) scene_.tags.push_back(p.tag.name);
    made.tag = tag->second;
  }
  const std::optional<Built> what = target(p.target);
  for (const double a : p.to_parent.a)
    if (!std::isfinite(a)) return add("SP404", p.where, "the transform of '" + p.target.name + "' is not finite");
  if (p.to_parent.determinant() == 0)
    return add("SP404", p.where, "the transform of '" + p.target.name + "' has no volume");
  std::vector<Affine3> all = transforms(p);
  if (p.on.given() && !p.scatter && !put_on(p, world, all)) return;
  if (!what) return;
  if (p.motion) {
    if (p.on.given()) return add("SP405", p.on.where, "what moves cannot stand 'on' something");
    made.track = static_cast<uint32_t>(scene_.tracks.size());
    scene_.tracks.push_back({strf("'%s' (line %d)", p.target.name.c_str(), p.motion_where.line), p.motion});
    motion_where_.push_back(p.motion_where);
  }
  made.kind = what->kind;
  for (const Affine3& t : all) {
    made.to_parent = t;
    for (uint32_t k = 0; k < what->count; ++k) {
      made.target = what->first + k;
      group.placements.push_back(made);
    }
  }
}

// The declared time, which every motion must cover; undeclared, the time that all have in common (for those that never
// begin or end: second 0).
TimeSpan Baker::time_window() {
  TimeSpan common{-INFINITY, INFINITY};
  for (size_t k = 0; k < scene_.tracks.size(); ++k) {
    const TimeSpan c = scene_.tracks[k].track->covered();
    common = {std::max(common.begin, c.begin), std::min(common.end, c.end)};
    if (draft_.times && !(c.contains(draft_.times->begin) && c.contains(draft_.times->end)))
      add("SP407", motion_where_[k],
          strf("the motion of %s is known from %.9g to %.9g s, 'times_s' is %.9g to %.9g s",
               scene_.tracks[k].name.c_str(), c.begin, c.end, draft_.times->begin, draft_.times->end));
    else if (!(common.begin <= common.end))
      return add("SP407", motion_where_[k], "the motion of " + scene_.tracks[k].name + " has no time in common with the others"), TimeSpan{};
  }
  if (draft_.times) return {draft_.times->begin, draft_.times->end};
  if (!std::isfinite(common.begin)) common.begin = std::min(0.0, common.end);
  if (!std::isfinite(common.end)) common.end = std::max(0.0, common.begin);
  return common;
}

void Baker::groups() {
  const std::vector<size_t> order = group_order();
  for (size_t i = 0; i < order.size(); ++i) group_ids_[draft_.groups[order[i]].name] = static_cast<uint32_t>(i);
  for (const size_t g : order) {
    Group group;
    group.name = draft_.groups[g].name;
    for (const DraftPlacement& p : draft_.groups[g].placements) place(p, group, g == 0);
    scene_.groups.push_back(std::move(group));
  }
  const bool media = !draft_.volumes.empty() || draft_.ambient.given();
  if (scene_.groups.empty() || (draft_.groups.front().placements.empty() && !media))
    add("SP406", {draft_.file, 0, 0, {}, -1}, "'world' is empty");
}

void Baker::unused() {
  for (const DraftMaterial& m : draft_.materials)
    if (!used_materials_.count(m.material.id)) add("SP103", m.where, "material '" + m.material.id + "' is not used");
  for (const DraftClassMap& m : draft_.class_maps)
    if (!used_maps_.count(m.map.name)) add("SP503", m.where, "map '" + m.map.name + "' is not used");
  for (const DraftPropertyMap& m : draft_.property_maps)
    if (!used_maps_.count(m.map.name)) add("SP503", m.where, "map '" + m.map.name + "' is not used");
  for (const DraftGeometry& g : draft_.geometry)
    if (!used_targets_.count(g.name)) add("SP403", g.where, "object '" + g.name + "' is never placed");
  for (size_t g = 1; g < draft_.groups.size(); ++g)
    if (!used_targets_.count(draft_.groups[g].name))
      add("SP403", draft_.groups[g].where, "group '" + draft_.groups[g].name + "' is never placed");
}

}  // namespace

Scene bake_scene(const Draft& draft, Report& report) { return Baker(draft, report).run(); }

}  // namespace suite
