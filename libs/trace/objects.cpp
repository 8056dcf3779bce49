// What there is to be met: objects by their numbers, and ways to look through them without unfolding shared groups.
#include <algorithm>
#include <map>
#include <tuple>

#include "trace/embree_internal.h"

namespace suite {

namespace {

// What an object within a shared group is, when the group is placed with an override and a tag, on a node or at rest.
TracedObject below(const TracedObject& above, const TracedObject& o) {
  TracedObject here = o;
  if (above.material_override != kNone) here.material_override = above.material_override;
  if (here.tag == kNone) here.tag = above.tag;
  here.node = above.node;
  return here;
}

// Looks through a hierarchy for what is wanted. How many of that are inside a group depends on its override, its
// tag and whether it is at rest, and is found once for each.
struct Search {
  const Flattened& flat;
  const std::function<bool(const TracedObject&)>& wanted;
  std::map<std::tuple<uint32_t, uint32_t, uint32_t, bool>, double> known;

  double inside(uint32_t group, const TracedObject& above) {
    const std::tuple key{group, above.material_override, above.tag, above.node == kNone};
    if (const auto at = known.find(key); at != known.end()) return at->second;
    const SharedGroup& frame = flat.groups[group];
    double sum = 0;
    for (size_t i = 0; i < frame.objects.size(); ++i) {
      const TracedObject here = below(above, frame.objects[i]);
      const uint32_t deeper = frame.shared_of(i);
      sum += deeper != kNone ? inside(deeper, here) : wanted(here) ? 1 : 0;
    }
    return known[key] = sum;
  }

  void visit(uint32_t group, const TracedObject& above, uint32_t first,
             const std::function<void(uint32_t, const TracedObject&)>& each) {
    if (inside(group, above) == 0) return;
    const SharedGroup& frame = flat.groups[group];
    for (size_t i = 0; i < frame.objects.size(); ++i) {
      TracedObject here = below(above, frame.objects[i]);
      const uint32_t deeper = frame.shared_of(i), within = frame.objects[i].instance;
      here.instance = above.instance + within;
      if (deeper != kNone)
        visit(deeper, here, first + within, each);
      else if (wanted(here))
        each(first + within, here);
    }
  }
};

}  // namespace

void World::kinds(const std::function<void(const TracedObject&)>& visit) const {
  // A group is looked into once for each override.
  std::vector<std::pair<uint32_t, uint32_t>> open;
  std::map<std::pair<uint32_t, uint32_t>, bool> seen;
  const auto look = [&](const Assembly& frame, uint32_t override) {
    for (size_t i = 0; i < frame.objects.size(); ++i) {
      TracedObject o = frame.objects[i];
      if (override != kNone) o.material_override = override;
      const std::pair inside{frame.shared_of(i), o.material_override};
      if (inside.first == kNone)
        visit(o);
      else if (!std::exchange(seen[inside], true))
        open.push_back(inside);
    }
  };
  look(flat, kNone);
  while (!open.empty()) {
    const auto [group, override] = open.back();
    open.pop_back();
    look(flat.groups[group], override);
  }
}

TracedObject Tracer::nested_object(uint32_t number) const { return world_->flat.way_again(number).object; }
Affine3 Tracer::nested_place(uint32_t number) const { return world_->flat.way_again(number).place; }

Affine3 Tracer::to_world(uint32_t number, double time) const {
  if (moving_) time = std::clamp(time, moving_->window.begin, moving_->window.end);
  return number < plain_.size() ? world_->to_world(plain_[number], time)
                                : world_->to_world(world_->flat.way_again(number), time);
}

size_t Tracer::object_count() const { return world_->flat.numbers(); }

void Tracer::kinds(const std::function<void(const TracedObject&)>& visit) const { world_->kinds(visit); }

void Tracer::each(const std::string& what, const std::function<bool(const TracedObject&)>& wanted,
                  const std::function<void(uint32_t, const TracedObject&)>& visit) const {
  const Flattened& flat = world_->flat;
  Search search{flat, wanted, {}};
  double count = 0;
  for (uint32_t i = 0; i < flat.objects.size(); ++i)
    if (const uint32_t group = flat.shared_of(i); group != kNone) count += search.inside(group, flat.objects[i]);
  if (count > kMostVisited)
    throw Error(strf("%s are %.4g copies in groups, at most 2^24 can be looked at one by one", what.c_str(), count),
                "name fewer of them, or place fewer copies");
  for (uint32_t i = 0; i < flat.objects.size(); ++i) {
    const TracedObject& o = flat.objects[i];
    if (const uint32_t group = flat.shared_of(i); group != kNone)
      search.visit(group, o, flat.number(i), visit);
    else if (wanted(o))
      visit(flat.number(i), o);
  }
}

std::vector<uint32_t> Tracer::of_instance(uint32_t instance) const {
  const Flattened& flat = world_->flat;
  std::vector<uint32_t> found;
  for (uint32_t i = 0; i < flat.objects.size(); ++i) {
    const uint32_t group = flat.shared_of(i), first = flat.objects[i].instance;
    if (instance < first || instance - first >= (group == kNone ? 1 : flat.groups[group].instances)) continue;
    const uint32_t number = flat.number(i) + (instance - first);
    if (flat.way_to(number)) found.push_back(number);
  }
  return found;
}

}  // namespace suite
