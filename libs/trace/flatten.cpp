#include "trace/flatten.h"

#include <algorithm>
#include <atomic>

#include "base/memory.h"
#include "scene/presence.h"
#include "scene/unfolded.h"

namespace suite {

namespace {

// What a group inherits on the way down. `to_node` leads to the frame of the node, or to that of the list.
struct Inherited {
  Affine3 to_node;
  uint32_t node = kNone, material = kNone, tag = kNone, via = kNone;
  bool same = true;  // to_node is the identity
};

// Fills one list.
struct Walk {
  const Scene& scene;
  const Sharing& sharing;
  const std::vector<uint32_t>& shared_as;  // per group of the scene
  Assembly& out;
  std::vector<MovingNode>* nodes;  // null in shared groups
  SharedGroup* inside;             // null in the scene itself
  uint32_t instances = 0;

  void group(uint32_t index, const Inherited& above) {
    for (const Placement& p : scene.groups[index].placements) {
      if (p.track == kNone && p.schedule == kNone) {
        placed(p, above, p.material_override);
        continue;
      }
      // One thing, whatever it is made of: the same numbers of instances.
      const uint32_t first = instances;
      for (const uint32_t made : made_of(scene, p.schedule)) {
        instances = first;
        Inherited here = above;
        here.node = static_cast<uint32_t>(nodes->size());
        nodes->push_back({above.node, above.to_node, p.track, p.schedule, made});
        here.to_node = {};
        here.same = true;
        placed(p, here, made == kNone ? p.material_override : made);
      }
    }
  }

  void placed(const Placement& p, Inherited here, uint32_t material) {
    // The outermost override wins: whoever places a thing decides what it is made of.
    if (here.material == kNone) here.material = material;
    if (p.tag != kNone) here.tag = p.tag;
    if (p.kind != TargetKind::group || sharing.shared[p.target]) return object(p, here);
    here.to_node = here.to_node * p.to_parent;
    here.same = false;
    if (inside) {
      inside->vias.push_back({here.via, &p.to_parent});
      here.via = static_cast<uint32_t>(inside->vias.size() - 1);
    }
    group(p.target, here);
  }

  void object(const Placement& p, const Inherited& here) {
    const bool mesh = p.kind == TargetKind::mesh, group = p.kind == TargetKind::group;
    const uint32_t instance = instances;
    instances += group ? static_cast<uint32_t>(sharing.instances[p.target]) : 1;
    if (mesh && scene.meshes[p.target].triangle_count() == 0) return;
    // A transform that is in the scene already is not stored again.
    const Affine3* place = here.same ? &p.to_parent : &out.composed.emplace_back(here.to_node * p.to_parent);
    PlacedObject o;
    o.mesh = mesh ? p.target : kNone;
    o.primitive = p.kind == TargetKind::primitive ? p.target : kNone;
    o.material_override = here.material, o.tag = here.tag, o.instance = instance, o.node = here.node;
    o.place = place;
    out.objects.push_back(o);
    if (!shared_as.empty()) out.shared.push_back(group ? shared_as[p.target] : kNone);
    if (inside) inside->last.push_back({here.via, &p.to_parent});
  }
};

// What moves goes to the end.
void part(Flattened& flat) {
  const auto rests = [](const TracedObject& o) { return o.node == kNone; };
  if (!flat.shared.empty()) {
    std::vector<uint32_t> parted;
    for (const bool moving : {false, true})
      for (size_t i = 0; i < flat.objects.size(); ++i)
        if (rests(flat.objects[i]) != moving) parted.push_back(flat.shared[i]);
    flat.shared = std::move(parted);
  }
  const auto moving = std::stable_partition(flat.objects.begin(), flat.objects.end(), rests);
  flat.fixed = static_cast<size_t>(moving - flat.objects.begin());
}

}  // namespace

Affine3 SharedGroup::placed_via(const Affine3& group, uint32_t via) const {
  return (vias[via].above == kNone ? group : placed_via(group, vias[via].above)) * *vias[via].to_parent;
}

Affine3 SharedGroup::placed(const Affine3& group, size_t object) const {
  if (last.empty() || last[object].via == kNone) return group * *objects[object].place;
  return placed_via(group, last[object].via) * *last[object].own;
}

void Flattened::number_objects() {
  static std::atomic<uint64_t> editions{0};
  edition_ = ++editions;
  first.clear();
  numbers_ = static_cast<uint32_t>(objects.size());
  if (shared.empty()) return;
  double count = 0;
  for (size_t i = 0; i < objects.size(); ++i) {
    first.push_back(static_cast<uint32_t>(count));
    count += shared[i] == kNone ? 1 : groups[shared[i]].instances;
    if (count > kMostInstances)
      throw Error("the copies that a periodic scene has at the sides of its cell are more than 2^32 - 2 instances",
                  "place fewer copies, or let fewer groups stick out of the cell");
  }
  numbers_ = static_cast<uint32_t>(count);
}

uint32_t Flattened::with_number(uint32_t number) const {
  if (first.empty()) return number;
  return static_cast<uint32_t>(std::upper_bound(first.begin(), first.end(), number) - first.begin()) - 1;
}

void Flattened::step(Way& way, const SharedGroup& group, uint32_t object) const {
  const PlacedObject& o = group.objects[object];
  way.object.mesh = o.mesh, way.object.primitive = o.primitive;
  if (way.object.material_override == kNone) way.object.material_override = o.material_override;
  if (o.tag != kNone) way.object.tag = o.tag;
  way.object.instance += o.instance;
  way.number += o.instance;
  way.place = group.placed(way.place, object);
}

std::optional<Way> Flattened::way_to(uint32_t number) const {
  uint32_t object = with_number(number);
  Way at = way(object);
  for (uint32_t group = shared_of(object); group != kNone; group = groups[group].shared_of(object)) {
    const std::vector<PlacedObject>& inside = groups[group].objects;
    const auto after = std::upper_bound(inside.begin(), inside.end(), number - at.number,
                                        [](uint32_t n, const PlacedObject& o) { return n < o.instance; });
    if (after == inside.begin()) return std::nullopt;
    object = static_cast<uint32_t>(after - inside.begin()) - 1;
    step(at, groups[group], object);
  }
  if (at.number != number) return std::nullopt;
  return at;
}

const Way& Flattened::way_again(uint32_t number) const {
  thread_local Way kept;
  thread_local uint64_t edition = 0;  // of which numbering `kept` is
  if (edition == edition_ && kept.number == number) return kept;
  const std::optional<Way> way = way_to(number);
  SUITE_CHECK(way.has_value());
  kept = *way;
  edition = edition_;
  return kept;
}

Flattened flatten(const Scene& scene, double keep) {
  const Sharing sharing = share_groups(scene, keep);
  if (sharing.instances.front() > kMostInstances)
    throw Error(
        strf("the scene unfolds into %.3g instances, at most 2^32 - 2 can be numbered", sharing.instances.front()),
        "place fewer copies");
  // An object, its transform, and what the tracer keeps of it.
  constexpr double bytes = 2 * (sizeof(PlacedObject) + sizeof(Affine3));
  const double most = std::min(kMostKept, available_memory() / bytes);
  if (sharing.kept > most && sharing.kept > 1e6)
    throw Error(strf("of the scene %.3g placements are kept, at most %.3g can be held", sharing.kept, most),
                "place fewer copies");
  Flattened flat;
  std::vector<uint32_t> shared_as;
  uint32_t count = 0;
  if (std::count(sharing.shared.begin(), sharing.shared.end(), 1)) {
    shared_as.assign(scene.groups.size(), kNone);
    for (size_t g = 0; g < shared_as.size(); ++g)
      if (sharing.shared[g]) shared_as[g] = count++;
  }
  flat.groups.resize(count);
  for (size_t g = 0; g < shared_as.size(); ++g) {
    if (shared_as[g] == kNone) continue;
    SharedGroup& group = flat.groups[shared_as[g]];
    group.instances = static_cast<uint32_t>(sharing.instances[g]);
    Walk{scene, sharing, shared_as, group, nullptr, &group}.group(static_cast<uint32_t>(g), {});
    if (group.vias.empty()) std::vector<SharedGroup::Last>().swap(group.last);
    if (std::count(group.shared.begin(), group.shared.end(), kNone) == static_cast<long>(group.shared.size()))
      std::vector<uint32_t>().swap(group.shared);
  }
  if (scene.groups.size() == 1) flat.objects.reserve(scene.groups[0].placements.size());
  Walk{scene, sharing, shared_as, flat, &flat.nodes, nullptr}.group(0, {});
  part(flat);
  flat.number_objects();
  return flat;
}

}  // namespace suite
