#include "scene/combine.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <set>

#include "base/error.h"
#include "motion/track.h"
#include "scene/curvature.h"

namespace suite {

namespace {

template <class T>
uint32_t move_behind(std::vector<T>& all, std::vector<T>& more) {
  const auto first = static_cast<uint32_t>(all.size());
  if (all.empty())
    all = std::move(more);
  else
    all.insert(all.end(), std::make_move_iterator(more.begin()), std::make_move_iterator(more.end()));
  return first;
}

void shift(uint32_t& index, uint32_t by) {
  if (index != kNone) index += by;
}

SceneFrame frame_of(const GeodeticOrigin& o) {
  return SceneFrame({o.latitude_deg, o.longitude_deg, o.ellipsoid_height_m});
}

class Combiner {
 public:
  explicit Combiner(std::vector<ScenePart> parts) : parts_(std::move(parts)) {}

  Scene run() {
    SUITE_CHECK(!parts_.empty());
    const Scene& first = parts_.front().scene;
    all_.name = first.name, all_.description = first.description, all_.author = first.author;
    all_.origin = first.origin;
    for (const ScenePart& p : parts_)
      if (all_.epoch.empty()) all_.epoch = p.scene.epoch;
    all_.groups.push_back({"scenes", {}});
    for (size_t k = 0; k < parts_.size(); ++k) add(parts_[k], k == 0);
    return std::move(all_);
  }

 private:
  void add(ScenePart& part, bool first) {
    Placement root;
    root.kind = TargetKind::group;
    root.to_parent = place_of(part, first);
    drapes(part, root.to_parent);
    names(part, first);
    Scene& s = part.scene;
    const double later = time_shift(s);
    const auto tracks = static_cast<uint32_t>(all_.tracks.size());
    for (SceneTrack& t : s.tracks) {
      if (later != 0) t.track = delayed_track(t.track, later);
      if (!first) t.name += " in " + part.name;
      all_.tracks.push_back(std::move(t));
    }
    indices(s, tracks);
    if (part.motion) {
      root.track = static_cast<uint32_t>(all_.tracks.size());
      all_.tracks.push_back({"'" + part.name + "'", part.motion});
    }
    media(part, root);
    root.target = move_behind(all_.groups, s.groups);
    all_.groups[0].placements.push_back(root);
    if (!part.motion) all_.bounds.grow(transformed(s.bounds, root.to_parent));
    move_behind(all_.class_maps, s.class_maps), move_behind(all_.map_bindings, s.map_bindings);
    move_behind(all_.property_maps, s.property_maps), move_behind(all_.property_bindings, s.property_bindings);
    move_behind(all_.temperatures, s.temperatures);
    move_behind(all_.meshes, s.meshes), move_behind(all_.primitives, s.primitives);
    move_behind(all_.materials, s.materials), move_behind(all_.files, s.files);
  }

  // Media, grids and volumes follow their scene's placement.
  void media(ScenePart& part, const Placement& root) {
    Scene& s = part.scene;
    const Affine3& place = root.to_parent;
    if (s.ambient != kNone && all_.ambient != kNone)
      throw Error("two scenes have an ambient medium", "one may fill what no body fills");
    const uint32_t first = move_behind(all_.media, s.media);
    shift(s.ambient, first);
    if (s.ambient != kNone) all_.ambient = s.ambient;
    for (Material& m : s.materials) shift(m.inside, first), shift(m.outside, first);
    for (VoxelGrid& g : s.grids)
      for (uint32_t& m : g.media) m += first;
    const uint32_t grids = move_behind(all_.grids, s.grids);
    for (const Volume& v : s.volumes) {
      if (v.track == kNone) {
        all_.volumes.push_back({v.grid + grids, place * v.to_world, root.track});
        continue;
      }
      // What moves in a scene that stands elsewhere would need the scene's placement after its own motion.
      if (!(place == Affine3{}))
        throw Error("scene '" + part.name + "' has a volume that moves, so it cannot be placed",
                    "make it the first scene, without a placement");
      uint32_t track = v.track;
      if (part.motion) {
        const SceneTrack own = all_.tracks[track];
        track = static_cast<uint32_t>(all_.tracks.size());
        all_.tracks.push_back({own.name, composed_track(part.motion, own.track)});
      }
      all_.volumes.push_back({v.grid + grids, v.to_world, track});
    }
  }

  Affine3 place_of(const ScenePart& part, bool first) const {
    if (part.placement) return *part.placement;
    if (part.motion || first) return {};
    for (const ScenePart* p : {&parts_.front(), &part})
      if (!p->scene.origin.given)
        throw Error("scene '" + p->name + "' has no origin on the Earth, so scenes cannot be related by it",
                    "give '" + part.name + "' a placement");
    // Through the Earth's centre and back: an ulp there is a nanometre.
    return (frame_of(all_.origin).to_ecef().inverse() * frame_of(part.scene.origin).to_ecef()).affine();
  }

  // Draped maps are asked in the frame of the whole: they follow a shift but no turn.
  void drapes(ScenePart& part, const Affine3& place) const {
    Scene& s = part.scene;
    Affine3 rest = place;
    rest.b = {};
    double off = 0;
    for (int corner = 0; corner < 8; ++corner) {
      const Box3& b = s.bounds;
      if (b.empty()) break;
      const Vec3 p{corner & 1 ? b.low.x : b.high.x, corner & 2 ? b.low.y : b.high.y, corner & 4 ? b.low.z : b.high.z};
      off = std::max(off, length(rest.point(p) - p));
    }
    std::shared_ptr<const FlatPlane> plane;
    const auto move = [&](const std::string& name, Projection projection, Drape& d) {
      if (projection != Projection::drape) return;
      if (part.motion)
        throw Error("map '" + name + "' is draped over scene '" + part.name + "', which moves", "project it by UV");
      if (d.plane) {  // asks on a plane of its own, wherever that has come to lie
        if (!plane)
          plane = std::make_shared<const FlatPlane>(FlatPlane{d.plane->frame, d.plane->to_scene * place.inverse()});
        d.plane = plane;
        return;
      }
      if (off > 0.1 * std::min(std::fabs(d.gsd_x), std::fabs(d.gsd_y)))
        throw Error(strf("map '%s' of scene '%s' would be off by %.3g m, because draped maps cannot turn with a scene",
                         name.c_str(), part.name.c_str(), off),
                    "project it by UV, or take the origin of that scene for all");
      d.origin_x += place.b.x;
      d.origin_y += place.b.y;
    };
    for (ClassMap& m : s.class_maps) move(m.name, m.projection, m.drape);
    for (PropertyMap& m : s.property_maps) move(m.name, m.projection, m.drape);
  }

  // Keeps names of materials and files apart.
  void names(ScenePart& part, bool first) {
    const auto apart = [&](std::set<std::string>& taken, std::string& name) {
      if (!first && taken.count(name)) name += " (" + part.name + ")";
      const std::string stem = name;
      for (int k = 2; !taken.insert(name).second; ++k) name = stem + strf(" %d", k);
    };
    std::map<std::string, std::string> renamed;
    for (DataFile& f : part.scene.files) {
      const std::string before = f.name;
      apart(file_names_, f.name);
      renamed[before] = f.name;
    }
    for (Material& m : part.scene.materials) {
      apart(material_names_, m.id);
      for (auto& [key, text] : m.surface.texts)
        if (const auto found = renamed.find(text); key == "file" && found != renamed.end()) text = found->second;
    }
    for (Medium& m : part.scene.media)
      for (auto& [key, text] : m.phase.texts)
        if (const auto found = renamed.find(text); key == "file" && found != renamed.end()) text = found->second;
  }

  double time_shift(const Scene& s) const {
    if (s.epoch.empty() || all_.epoch.empty()) return 0;
    return instant_from_utc(parse_iso8601(s.epoch)) - instant_from_utc(parse_iso8601(all_.epoch));
  }

  void indices(Scene& s, uint32_t tracks) {
    const auto materials = static_cast<uint32_t>(all_.materials.size()),
               meshes = static_cast<uint32_t>(all_.meshes.size());
    const auto primitives = static_cast<uint32_t>(all_.primitives.size()),
               groups = static_cast<uint32_t>(all_.groups.size());
    std::vector<uint32_t> tags;
    for (const std::string& tag : s.tags) {
      const auto found = std::find(all_.tags.begin(), all_.tags.end(), tag);
      tags.push_back(static_cast<uint32_t>(found - all_.tags.begin()));
      if (found == all_.tags.end()) all_.tags.push_back(tag);
    }
    for (Mesh& m : s.meshes)
      for (Part& p : m.parts) shift(p.material, materials);
    for (Primitive& p : s.primitives) shift(p.material, materials);
    for (Group& g : s.groups)
      for (Placement& p : g.placements) {
        p.target += p.kind == TargetKind::mesh ? meshes : p.kind == TargetKind::group ? groups : primitives;
        shift(p.material_override, materials);
        shift(p.track, tracks);
        if (p.tag != kNone) p.tag = tags[p.tag];
      }
    for (Volume& v : s.volumes) shift(v.track, tracks);
    for (ClassMap& m : s.class_maps)
      for (uint32_t& id : m.materials) id += materials;
    for (MapBinding& b : s.map_bindings)
      b.material += materials, b.class_map += static_cast<uint32_t>(all_.class_maps.size());
    for (PropertyMap& m : s.property_maps)
      for (uint32_t& id : m.materials) id += materials;
    for (PropertyBinding& b : s.property_bindings)
      b.material += materials, b.property_map += static_cast<uint32_t>(all_.property_maps.size());
    for (TemperatureBinding& t : s.temperatures) t.material += materials;
  }

  std::vector<ScenePart> parts_;
  Scene all_;
  std::set<std::string> material_names_, file_names_;
};

}  // namespace

Scene combine_scenes(std::vector<ScenePart> parts) { return Combiner(std::move(parts)).run(); }

void set_epoch(Scene& scene, const std::string& epoch) {
  if (!scene.epoch.empty()) {
    const double later = instant_from_utc(parse_iso8601(scene.epoch)) - instant_from_utc(parse_iso8601(epoch));
    for (SceneTrack& t : scene.tracks)
      if (later != 0) t.track = delayed_track(t.track, later);
  }
  scene.epoch = epoch;
}

}  // namespace suite
