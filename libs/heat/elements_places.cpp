// Elements that are left, and places on them as hits.
#include <algorithm>

#include "base/error.h"
#include "heat/elements.h"
#include "heat/made_of.h"

namespace suite {

void Elements::keep(const std::vector<bool>& kept) {
  SUITE_CHECK_EQ(kept.size(), elements_.size());
  std::vector<HeatElement> left;
  std::vector<uint32_t> first{0};
  std::vector<uint32_t> numbers;
  total_area_ = 0;
  for (size_t c = 0; c + 1 < first_element_.size(); ++c) {
    for (uint32_t e = first_element_[c]; e < first_element_[c + 1]; ++e)
      if (kept[e])
        left.push_back(elements_[e]), numbers.push_back(number(e)), total_area_ += elements_[e].area;
      else
        left_out_.push_back({number(e), elements_[e].cell, elements_[e].material});
    first.push_back(static_cast<uint32_t>(left.size()));
  }
  std::ranges::sort(left_out_, {}, &LeftOut::number);
  numbers_ = std::move(numbers);
  elements_ = std::move(left), first_element_ = std::move(first);
}

// Where the instance of an object stands; nothing for what never rests.
std::optional<Elements::Slot> Elements::slot_for(uint32_t number, const TracedObject& o) {
  double time = time_;
  uint32_t places = kNone;
  if (o.node != kNone && rests_.empty()) {
    if (!stays_put(tracer_, number)) return std::nullopt;
  } else if (o.node != kNone && (suite::changes_place(tracer_, number) || !tracer_.there(number, time_))) {
    std::optional<RestPlaces> found = rest_places(tracer_, number, rests_);
    if (found) {
      places = static_cast<uint32_t>(places_.size()), time = found->time[found->home];
      places_.push_back(*std::move(found));
    } else if (!stays_put(tracer_, number)) {
      return std::nullopt;
    }
  }
  const Affine3 place = tracer_.to_world(number, time);
  return Slot{number, o.instance, 0, place, place.inverse(), places};
}

// At which a slot stands where it does in an interval.
double Elements::time_of(const Slot& slot, uint32_t interval) const {
  if (slot.places == kNone) return time_;
  const RestPlaces& places = places_[slot.places];
  return places.time[interval == kNone ? places.home : interval];
}

Affine3 Elements::to_local_at(const Slot& slot, double time) const {
  return slot.places == kNone ? slot.to_local : tracer_.to_world(slot.object, time).inverse();
}

bool Elements::rests(const Hit& hit) const {
  const auto found = slot_of_.find(tracer_.object(hit.object).instance);
  if (found == slot_of_.end() || slots_.empty()) return false;
  const uint32_t places = slots_[found->second].places;
  return places == kNone || places_[places].rests[interval_of(rests_, hit.time)];
}

std::vector<float> Elements::presence(size_t interval) const {
  const std::optional<TimeSpan> window = tracer_.window();
  if (!window) return {};
  const TimeSpan span = rests_.empty() ? *window : rests_[interval].still;
  std::vector<double> of_group(groups_.size(), 0.0);
  for (const Slot& slot : slots_) {
    double there = 1;
    if (slot.places != kNone)
      there = places_[slot.places].rests[interval] ? 1 : 0;
    else if (tracer_.object(slot.object).node != kNone)
      there = share_there(tracer_, slot.object, span);
    of_group[slot.group] += there / groups_[slot.group].slots;
  }
  constexpr double kNearlyAll = 1 - 1e-9;
  if (std::ranges::all_of(of_group, [](double there) { return there > kNearlyAll; })) return {};
  std::vector<float> out;
  for (const HeatElement& e : elements_) {
    const double there = of_group[group_of_cell_[e.cell]];
    out.push_back(there > kNearlyAll ? 1.0f : static_cast<float>(there));
  }
  return out;
}

bool Elements::changes_place(size_t element) const {
  return slots_[groups_[group_of_cell_[elements_[element].cell]].first_slot].places != kNone;
}

std::vector<Vec3> Elements::places_by_instance(size_t element, const SampleStream& stream, uint32_t each) const {
  const uint32_t cell = elements_[element].cell;
  const Group& group = groups_[group_of_cell_[cell]];
  std::vector<Vec3> places;
  for (uint32_t s = group.first_slot; s < group.first_slot + group.slots; ++s)
    for (uint32_t k = 0; k < each; ++k) {
      const Local p = local_point(group, cell, stream.draw(k, 0));
      const Hit hit = group.mesh ? tracer_.on_triangle(slots_[s].object, p.triangle, p.u, p.v, time_of(slots_[s]))
                                 : tracer_.on_exact(slots_[s].object, p.position, p.normal, p.uv, time_of(slots_[s]));
      places.push_back(hit.position);
    }
  return places;
}

std::optional<Hit> Elements::hit_at(const HeatedPlace& place) const {
  const auto found = slot_of_.find(place.instance);
  if (found == slot_of_.end() || slots_.empty()) return std::nullopt;
  const Slot& slot = slots_[found->second];
  if (slot.places != kNone) return std::nullopt;
  const Group& group = groups_[slot.group];
  const Vec3 local = slot.to_local.point(place.position);
  if (!group.mesh) {
    const PrimitiveFaces& faces = grids_[group.grid].faces;
    const PrimitiveFaces::Place p = faces.place(local);
    return tracer_.on_exact(slot.object, local, slot.to_local.normal(place.normal), faces.point(p.face, p.a, p.b).uv,
                            time_);
  }
  const Mesh& mesh = tracer_.scene().meshes[tracer_.object(slot.object).mesh];
  const auto corner = [&](size_t k) {
    const float* at = &mesh.positions[3 * size_t{mesh.indices[3 * size_t{place.triangle} + k]}];
    return mesh.origin + Vec3{double{at[0]}, double{at[1]}, double{at[2]}};
  };
  const Vec3 a = corner(0), ab = corner(1) - a, ac = corner(2) - a, n = cross(ab, ac);
  const double scale = dot(n, n);
  if (!(scale > 0)) return std::nullopt;
  const double u = dot(cross(local - a, ac), n) / scale, v = dot(cross(ab, local - a), n) / scale;
  return tracer_.on_triangle(slot.object, place.triangle, u, v, time_);
}

}  // namespace suite
