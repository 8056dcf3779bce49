#include "scene/leaves.h"

#include <algorithm>

#include "motion/track.h"
#include "scene/presence.h"

namespace suite {

Leaves::Leaves(const Scene& scene) : scene_(scene), of_(scene.groups.size()), first_(scene.groups.size()) {
  for (size_t g = scene.groups.size(); g-- > 0;)  // parents come before their children
    for (const Placement& p : scene.groups[g].placements) {
      first_[g].push_back(of_[g]);
      of_[g] += p.kind == TargetKind::group ? of_[p.target] : 1;
    }
}

bool tags_groups(const Scene& scene) {
  return std::ranges::any_of(scene.groups, [](const Group& g) {
    return std::ranges::any_of(g.placements,
                               [](const Placement& p) { return p.tag != kNone && p.kind == TargetKind::group; });
  });
}

uint64_t Leaves::object_of(uint64_t number) const {
  uint64_t object = number, begin = 0;  // of the placement that is looked at
  for (size_t group = 0;;) {
    const std::vector<uint64_t>& first = first_[group];
    const auto i =
        static_cast<size_t>(std::upper_bound(first.begin(), first.end(), number - begin) - first.begin()) - 1;
    const Placement& p = scene_.groups[group].placements[i];
    begin += first[i];
    if (p.tag != kNone) object = begin;
    if (p.kind != TargetKind::group) return object;
    group = p.target;
  }
}

std::optional<Leaf> Leaves::at(uint64_t number, double t) const {
  Leaf leaf;
  for (size_t group = 0;;) {
    const std::vector<uint64_t>& first = first_[group];
    const auto i = static_cast<size_t>(std::upper_bound(first.begin(), first.end(), number) - first.begin()) - 1;
    const Placement& p = scene_.groups[group].placements[i];
    number -= first[i];
    const std::optional<uint32_t> made = made_at(scene_, p.track, p.schedule, t);
    if (!made) return std::nullopt;
    if (leaf.material_override == kNone) leaf.material_override = *made == kNone ? p.material_override : *made;
    if (p.tag != kNone) leaf.tag = p.tag;
    if (p.track != kNone) leaf.place = leaf.place * scene_.tracks[p.track].track->at(t).affine();
    leaf.place = leaf.place * p.to_parent;
    if (p.kind != TargetKind::group) {
      leaf.kind = p.kind, leaf.target = p.target;
      return leaf;
    }
    group = p.target;
  }
}

}  // namespace suite
