#include "scene/bake.h"

#include <algorithm>
#include <cmath>

#include "base/placed.h"
#include "motion/track.h"
#include "scene/baker.h"
#include "scene/curvature.h"
#include "scene/origin_check.h"
#include "scene/presence.h"
#include "scene/unfolded.h"

namespace suite {

Scene Baker::run() {
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
  if (draft_.curvature_m && report_.count(Severity::error) == 0) curve();
  scene_.epoch = draft_.epoch;
  const TimeSpan times = time_window();
  if (report_.count(Severity::error) == 0) {
    try {
      scene_.bounds = scene_bounds(scene_, times.begin, times.end);
    } catch (const Error& e) {
      throw placed(e, draft_.times ? draft_.times->where : Where{draft_.file, 0, 0, {}, -1});
    }
    report_endless_media();
    report_shared_faces(time_of_all(scene_));
  }
  return std::move(scene_);
}

Baker::Built Baker::build_mesh(const DraftGeometry& g) {
  std::vector<uint32_t> ids;
  std::set<std::string> reported;
  for (const SourceMesh::Run& run : g.mesh.runs) {
    if (const auto found = g.materials.find(run.material); found != g.materials.end()) {
      ids.push_back(material_id(found->second));
    } else if (material_ids_.count(run.material)) {
      ids.push_back(material_id({run.material, {}}));
    } else if (g.material.given()) {
      ids.push_back(material_id(g.material));
    } else {
      if (reported.insert(run.material).second)
        add("SP102", {g.mesh.file, run.line, 0, {}, -1},
            run.material.empty() ? "faces without 'usemtl' in '" + g.name + "'; give the object a 'material'"
                                 : "unknown material '" + run.material +
                                       "'; define it, or map the name under 'materials' of '" + g.name + "'");
      ids.push_back(kNone);
    }
  }
  if (g.material.given()) material_id(g.material);  // even when every face has a better one, the name must exist
  Mesh mesh = make_mesh(g.mesh, g.to_local, g.normals, ids, g.crease_rad);
  mesh.name = g.name;
  scene_.meshes.push_back(std::move(mesh));
  return {TargetKind::mesh, static_cast<uint32_t>(scene_.meshes.size() - 1), 1, nullptr};
}

// A scene that is to be curved is put together on the flat plane; a georeferenced terrain is laid there first.
SourceTerrain Baker::on_plane(const SourceTerrain& terrain) const {
  if (!draft_.curvature_m || !terrain.georeferenced) return terrain;
  SourceTerrain flat = terrain;
  const GeodeticOrigin& o = draft_.origin;
  flat.place = [place = terrain.place, frame = SceneFrame({o.latitude_deg, o.longitude_deg, o.ellipsoid_height_m})](
                   double column, double row, double height) { return frame.flattened(place(column, row, height)); };
  return flat;
}

void Baker::curve() {
  const Where& where = draft_.curvature_where;
  Curved done;
  try {
    done = curve_scene(scene_, *draft_.curvature_m);
  } catch (const Error& e) {
    return add("SP404", where, e.message() + "; " + e.hint());
  }
  for (const std::string& name : done.rigid)
    add("SP408", where, name + " is too large for the curvature and only turned with it");
  for (const auto& [name, count] : done.long_edges)
    report_.add("SP409", draft_.file,
                {where, strf("mesh '%s': %zu triangles have edges that leave the surface by more than %g m",
                             name.c_str(), count, *draft_.curvature_m)},
                count);
  if (done.moving) add("SP410", where, strf("%zu moving placements", done.moving));
}

Baker::Built Baker::build_terrain(const DraftGeometry& g) {
  try {
    terrains_.push_back(std::make_unique<TerrainGrid>(on_plane(g.terrain)));
  } catch (const Error& e) {  // a sample that lies nowhere on Earth
    add("SP504", g.where, "terrain '" + g.name + "': " + e.message());
    return {TargetKind::mesh, static_cast<uint32_t>(scene_.meshes.size()), 0, nullptr, true};
  }
  if (g.terrain.georeferenced)
    if (const auto fault = misplaced_origin(*terrains_.back(), draft_.origin))
      add("SP505", g.where, "terrain '" + g.name + "': " + *fault);
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
  for (const DraftGeometry& g : draft_.geometry) {
    if (g.failed) {
      if (g.material.given()) material_id(g.material);
      built_[g.name] = {TargetKind::mesh, static_cast<uint32_t>(scene_.meshes.size()), 0, nullptr, true};
      continue;
    }
    switch (g.kind) {
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
      add("SP401", p.on.where, "'" + p.on.name + "' is no terrain and no mesh to scatter over");
      return all;
    }
    try {
      all = scatter(std::span(scene_.meshes).subspan(ground->second.first, ground->second.count), *p.scatter);
    } catch (const Error& e) {
      add("SP411", p.where, e.message() + "; " + e.hint());
    }
    for (Affine3& t : all) t = t * p.to_parent;
    return all;
  }
  if (!p.table) all.push_back(p.to_parent);
  for (const Affine3& row : p.rows) all.push_back(p.to_parent * row);
  return all;
}

// What `on` may name.
std::string Baker::terrains() const {
  std::string names;
  for (const auto& [name, built] : built_)
    if (built.terrain) names += (names.empty() ? "" : ", ") + name;
  return names.empty() ? "the scene has none: give z instead of 'on'" : "'on' takes one of: " + names;
}

// Lifts transforms onto a terrain.
bool Baker::put_on(const DraftPlacement& p, bool world, std::vector<Affine3>& all) {
  const auto ground = built_.find(p.on.name);
  if (!world)
    return add("SP405", p.on.where, "'on' counts in 'world' only: groups do not know where they will stand"), false;
  if (ground != built_.end() && ground->second.failed) return false;
  if (ground == built_.end() || !ground->second.terrain)
    return add("SP401", p.on.where, "'" + p.on.name + "' is no terrain; " + terrains()), false;
  for (Affine3& t : all) {
    const auto z = ground->second.terrain->height_at(t.b.x, t.b.y);
    if (!z) return add("SP405", p.where, strf("(%g, %g) is not on '%s'", t.b.x, t.b.y, p.on.name.c_str())), false;
    t.b.z += *z;
  }
  return true;
}

namespace {
constexpr double kFarthest = 1e13;  // m; beyond, a millimetre is lost in double
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
  for (const Affine3& t : all)
    if (!(length(t.b) < kFarthest))
      return add("SP404", p.where,
                 strf("'%s' is placed absurdly far away, at (%g, %g, %g)", p.target.name.c_str(), t.b.x, t.b.y, t.b.z));
  if (!what) return;
  if (p.motion) {
    if (p.on.given()) return add("SP405", p.on.where, "what moves cannot stand 'on' something");
    made.track = static_cast<uint32_t>(scene_.tracks.size());
    scene_.tracks.push_back(
        {strf("'%s' (line %d of the scene's text)", p.target.name.c_str(), p.motion_where.line), p.motion});
    motion_where_.push_back(p.motion_where);
  }
  if (p.schedule) made.schedule = schedule(*p.schedule, p.target.name, p.where);
  made.kind = what->kind;
  for (const Affine3& t : all) {
    made.to_parent = t;
    for (uint32_t k = 0; k < what->count; ++k) {
      made.target = what->first + k;
      group.placements.push_back(made);
    }
  }
}

uint32_t Baker::schedule(const DraftSchedule& draft, const std::string& target, const Where& where) {
  Schedule made;
  made.name = strf("'%s' (line %d of the scene's text)", target.c_str(), where.line);
  made.life = draft.life;
  made.when = draft.when;
  for (const DraftSchedule::Row& row : draft.rows) {
    made.there.push_back(row.there);
    made.material.push_back(row.material.given() ? material_id(row.material) : kNone);
  }
  scene_.schedules.push_back(std::move(made));
  return static_cast<uint32_t>(scene_.schedules.size() - 1);
}

// The declared time, which every motion must cover while what moves is there; undeclared, the time that all have in
// common (for those that never begin or end: second 0, and all that comes and goes).
TimeSpan Baker::time_window() {
  std::vector<uint32_t> schedule_of(scene_.tracks.size(), kNone);
  for (const Group& g : scene_.groups)
    for (const Placement& p : g.placements)
      if (p.track != kNone) schedule_of[p.track] = p.schedule;
  TimeSpan common{-INFINITY, INFINITY}, passing{0, 0};
  for (size_t k = 0; k < scene_.tracks.size(); ++k) {
    const SceneTrack& t = scene_.tracks[k];
    const TimeSpan c = t.track->covered();
    if (t.track->absent_outside()) {
      passing = {std::min(passing.begin, c.begin), std::max(passing.end, c.end)};
      continue;
    }
    const TimeSpan asked = draft_.times ? TimeSpan{draft_.times->begin, draft_.times->end} : TimeSpan{-kEver, kEver};
    const Presence there = presence(scene_, kNone, schedule_of[k], {}, asked);
    const auto misses = [&](double time) { return std::isfinite(time) && !c.contains(time); };
    if ((draft_.times || schedule_of[k] != kNone) && there.any && (misses(there.hull.begin) || misses(there.hull.end)))
      add("SP407", motion_where_[k],
          strf("the motion of %s is known from %.9g to %.9g s, %s is %.9g to %.9g s", t.name.c_str(), c.begin, c.end,
               there.all && draft_.times ? "'times_s'" : "its life", there.hull.begin, there.hull.end));
    if (schedule_of[k] != kNone) continue;  // needed while it is there, which need not be when others are
    common = {std::max(common.begin, c.begin), std::min(common.end, c.end)};
    if (!draft_.times && !(common.begin <= common.end))
      return add("SP407", motion_where_[k], "the motion of " + t.name + " has no time in common with the others"),
             TimeSpan{};
  }
  if (draft_.times) return {draft_.times->begin, draft_.times->end};
  if (!std::isfinite(common.begin)) common.begin = std::min(passing.begin, common.end);
  if (!std::isfinite(common.end)) common.end = std::max(passing.end, common.begin);
  return common;
}

// Copies of copies multiply: a short text can ask for more than can be numbered. Filed at the innermost group that is
// too large by itself.
void Baker::count_unfolded(const std::vector<size_t>& order) {
  if (scene_.groups.empty()) return;
  const Sharing sharing = share_groups(scene_);
  const std::vector<double>& counts = sharing.instances;
  const bool few = counts.front() <= kMostInstances;
  if (few && sharing.kept <= kMostKept) return;
  size_t at = 0;
  for (bool deeper = !few; deeper;) {
    deeper = false;
    for (const Placement& p : scene_.groups[at].placements)
      if (p.kind == TargetKind::group && counts[p.target] > kMostInstances) {
        at = p.target, deeper = true;
        break;
      }
  }
  const DraftGroup& group = draft_.groups[order[at]];
  add("SP411", group.placements.empty() ? group.where : group.placements.front().where,
      few ? strf("the scene keeps %.3g placements, however much its groups share", sharing.kept)
          : strf("'%s' unfolds into %.3g instances, the scene into %.3g", group.name.c_str(), counts[at],
                 counts.front()));
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
  count_unfolded(order);
  const bool media = !draft_.volumes.empty() || draft_.ambient.given();
  if (!draft_.failed_placements && (scene_.groups.empty() || (draft_.groups.front().placements.empty() && !media)))
    add("SP406", {draft_.file, 0, 0, {}, -1}, "'world' is empty");
}

void Baker::unused() {
  for (const DraftMaterial& m : draft_.materials)
    if (!used_materials_.count(m.material.id)) add("SP103", m.where, "material '" + m.material.id + "' is not used");
  for (const DraftClassMap& m : draft_.class_maps)
    if (!used_maps_.count(m.map.name)) add("SP503", m.where, "map '" + m.map.name + "' is not used");
  for (const DraftPropertyMap& m : draft_.property_maps)
    if (!used_maps_.count(m.map.name)) add("SP503", m.where, "map '" + m.map.name + "' is not used");
  if (draft_.failed_placements) return;
  for (const DraftGeometry& g : draft_.geometry)
    if (!used_targets_.count(g.name)) add("SP403", g.where, "object '" + g.name + "' is never placed");
  for (size_t g = 1; g < draft_.groups.size(); ++g)
    if (!used_targets_.count(draft_.groups[g].name))
      add("SP403", draft_.groups[g].where, "group '" + draft_.groups[g].name + "' is never placed");
}

Scene bake_scene(const Draft& draft, Report& report) { return Baker(draft, report).run(); }

}  // namespace suite
