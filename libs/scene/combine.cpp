#include "scene/combine.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <set>
#include <type_traits>

#include "base/error.h"
#include "motion/track.h"
#include "scene/curvature.h"
#include "scene/tables.h"

namespace suite {

namespace {

template <class T>
void move_behind(std::vector<T>& all, std::vector<T>& more) {
  if (all.empty())
    all = std::move(more);
  else
    all.insert(all.end(), std::make_move_iterator(more.begin()), std::make_move_iterator(more.end()));
}

// Moves the indices of a part behind what is there already; `tags` says where its tags have gone.
struct Shift {
  const Scene& all;
  const std::vector<uint32_t>& tags;
  template <class Table>
  void must(uint32_t& index) const {
    if constexpr (std::is_same_v<Table, TagTable>)
      index = tags[index];
    else
      index += static_cast<uint32_t>((all.*Table::rows).size());
  }
  template <class Table>
  void may(uint32_t& index) const {
    if (index != kNone) must<Table>(index);
  }
};

SceneFrame frame_of(const GeodeticOrigin& o) {
  return SceneFrame({o.latitude_deg, o.longitude_deg, o.ellipsoid_height_m});
}

// Everything that happens in a scene, so many seconds later.
void delay(Scene& scene, double seconds) {
  if (seconds == 0) return;
  for (SceneTrack& t : scene.tracks) t.track = delayed_track(t.track, seconds);
  for (Schedule& s : scene.schedules) {
    s.life = {s.life.begin + seconds, s.life.end + seconds};
    s.when.delay(seconds);
  }
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
    delay(s, time_shift(s));
    if (!first) {
      for (SceneTrack& t : s.tracks) t.name += " in " + part.name;
      for (Schedule& t : s.schedules) t.name += " in " + part.name;
    }
    indices(s);
    if (part.motion) {
      root.track = static_cast<uint32_t>(all_.tracks.size() + s.tracks.size());
      s.tracks.push_back({"'" + part.name + "'", part.motion});
    }
    life(part, root);
    volumes(part, root);
    root.target = static_cast<uint32_t>(all_.groups.size());
    if (!part.motion) all_.bounds.grow(transformed(s.bounds, root.to_parent));
    for_each_table([&]<class Table>(Table) {
      if constexpr (!std::is_same_v<Table, TagTable>) move_behind(all_.*Table::rows, s.*Table::rows);
    });
    all_.groups[0].placements.push_back(root);
  }

  void life(ScenePart& part, Placement& root) const {
    Scene& s = part.scene;
    if (part.life == kAlways) return;
    if (!s.volumes.empty() || s.ambient != kNone)
      throw Error("scene '" + part.name + "' has " + (s.volumes.empty() ? "an ambient medium" : "volumes") +
                      ", which cannot appear or disappear",
                  "let it be there always");
    root.schedule = static_cast<uint32_t>(all_.schedules.size() + s.schedules.size());
    s.schedules.push_back({"scene '" + part.name + "'", part.life, {}, {}, {}});
  }

  // Volumes follow their scene's placement.
  void volumes(ScenePart& part, const Placement& root) {
    Scene& s = part.scene;
    const Affine3& place = root.to_parent;
    for (Volume& v : s.volumes) {
      if (v.track == kNone) {
        v.to_world = place * v.to_world, v.track = root.track;
        continue;
      }
      // What moves in a scene that stands elsewhere would need the scene's placement after its own motion.
      if (!(place == Affine3{}))
        throw Error("scene '" + part.name + "' has a volume that moves, so it cannot be placed",
                    "make it the first scene, without a placement");
      if (part.motion) {
        const SceneTrack own = s.tracks[v.track - all_.tracks.size()];
        v.track = static_cast<uint32_t>(all_.tracks.size() + s.tracks.size());
        s.tracks.push_back({own.name, composed_track(part.motion, own.track)});
      }
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

  // Every index of a part, and its ambient medium and tags, so that its tables can stand behind those that are there.
  void indices(Scene& s) {
    if (s.ambient != kNone && all_.ambient != kNone)
      throw Error("two scenes have an ambient medium", "one may fill what no body fills");
    std::vector<uint32_t> tags;
    for (const std::string& tag : s.tags) {
      const auto found = std::find(all_.tags.begin(), all_.tags.end(), tag);
      tags.push_back(static_cast<uint32_t>(found - all_.tags.begin()));
      if (found == all_.tags.end()) all_.tags.push_back(tag);
    }
    const Shift shift{all_, tags};
    shift.may<MediumTable>(s.ambient);
    if (s.ambient != kNone) all_.ambient = s.ambient;
    for_each_table([&]<class Table>(Table) {
      for (auto& row : s.*Table::rows)
        if constexpr (requires { Table::indices(row, shift); }) Table::indices(row, shift);
    });
  }

  std::vector<ScenePart> parts_;
  Scene all_;
  std::set<std::string> material_names_, file_names_;
};

}  // namespace

Scene combine_scenes(std::vector<ScenePart> parts) { return Combiner(std::move(parts)).run(); }

void set_epoch(Scene& scene, const std::string& epoch) {
  if (!scene.epoch.empty())
    delay(scene, instant_from_utc(parse_iso8601(scene.epoch)) - instant_from_utc(parse_iso8601(epoch)));
  scene.epoch = epoch;
}

}  // namespace suite
