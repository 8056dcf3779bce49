// Elements that are left, and places on them as hits.
#include <algorithm>

#include "base/error.h"
#include "heat/elements.h"

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

std::vector<Vec3> Elements::places_by_instance(size_t element, const SampleStream& stream, uint32_t each) const {
  const uint32_t cell = elements_[element].cell;
  const Group& group = groups_[group_of_cell_[cell]];
  std::vector<Vec3> places;
  for (uint32_t s = group.first_slot; s < group.first_slot + group.slots; ++s)
    for (uint32_t k = 0; k < each; ++k) {
      const Local p = local_point(group, cell, stream.draw(k, 0));
      const Hit hit = group.mesh ? tracer_.on_triangle(slots_[s].object, p.triangle, p.u, p.v, time_)
                                 : tracer_.on_exact(slots_[s].object, p.position, p.normal, p.uv, time_);
      places.push_back(hit.position);
    }
  return places;
}

std::optional<Hit> Elements::hit_at(const HeatedPlace& place) const {
  const auto found = slot_of_.find(place.instance);
  if (found == slot_of_.end() || slots_.empty()) return std::nullopt;
  const Slot& slot = slots_[found->second];
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
