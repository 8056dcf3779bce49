#include "trace/flatten.h"

#include <algorithm>

#include "base/memory.h"
#include "scene/presence.h"
#include "scene/unfolded.h"

namespace suite {

namespace {

// What a group inherits on the way down. `to_node` leads to the frame of the node, or to ENU when there is none.
struct Inherited {
  Affine3 to_node;
  uint32_t node = kNone, material = kNone, tag = kNone;
  bool same = true;  // to_node is the identity
};

struct Walk {
  const Scene& scene;
  size_t limit;
  Flattened& out;
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
        here.node = static_cast<uint32_t>(out.nodes.size());
        out.nodes.push_back({above.node, above.to_node, p.track, p.schedule, made});
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
    if (p.kind == TargetKind::group) {
      here.to_node = here.to_node * p.to_parent;
      here.same = false;
      group(p.target, here);
    } else {
      object(p, here);
    }
  }

  void object(const Placement& p, const Inherited& here) {
    if (out.objects.size() >= limit)
      throw Error(strf("the scene unfolds into more than %zu instances", limit), "place fewer copies");
    const bool mesh = p.kind == TargetKind::mesh;
    const uint32_t instance = instances++;
    if (mesh && scene.meshes[p.target].triangle_count() == 0) return;
    // A transform that is in the scene already is not stored again.
    const Affine3* place = here.same ? &p.to_parent : &out.composed.emplace_back(here.to_node * p.to_parent);
    out.objects.push_back(
        {place, mesh ? p.target : kNone, mesh ? kNone : p.target, here.material, here.tag, instance, here.node});
  }
};

}  // namespace

Flattened flatten(const Scene& scene, size_t limit) {
  // An object, its transform, and what the tracer keeps of it.
  constexpr double bytes = 2 * (sizeof(TracedObject) + sizeof(Affine3));
  const double count = unfolded(scene.groups).front(), most = std::min(kMostUnfolded, available_memory() / bytes);
  if (count > most && count > 1e6)
    throw Error(strf("the scene unfolds into %.3g placements, at most %.3g can be held", count, most),
                "place fewer copies");
  Flattened flat;
  if (scene.groups.size() == 1) flat.objects.reserve(scene.groups[0].placements.size());
  Walk{scene, limit, flat}.group(0, {});
  const auto moving = std::stable_partition(flat.objects.begin(), flat.objects.end(),
                                            [](const TracedObject& o) { return o.node == kNone; });
  flat.fixed = static_cast<size_t>(moving - flat.objects.begin());
  return flat;
}

}  // namespace suite
