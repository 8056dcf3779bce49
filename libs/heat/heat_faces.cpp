#include "heat/heat_faces.h"

namespace suite {

HeatFaces::HeatFaces(const Elements& elements, const HeatOptics& optics)
    : elements_(elements), has_heat_(optics.has_heat), fronts_(elements.size()), back_(elements.size(), kNone) {
  for (uint32_t e = 0; e < elements.size(); ++e) element_.push_back(e);
  for (uint32_t e = 0; e < elements.size(); ++e)
    if (optics.heated[elements[e].material].back_open) {
      back_[e] = count();
      element_.push_back(e);
    }
  if (const auto& left = elements.left_out(); !left.empty()) {
    // Of those with open backs, how many have lower numbers.
    const auto all = static_cast<uint32_t>(elements.size() + left.size());
    std::vector<uint32_t> backs(all + 1, 0);
    for (const Elements::LeftOut& e : left) backs[e.number + 1] = optics.heated[e.material].back_open;
    for (uint32_t e = 0; e < elements.size(); ++e) backs[elements.number(e) + 1] = back_[e] != kNone;
    for (uint32_t e = 0; e < all; ++e) backs[e + 1] += backs[e];
    for (size_t f = 0; f < element_.size(); ++f) {
      const uint32_t number = elements.number(element_[f]);
      numbers_.push_back(is_back(f) ? all + backs[number] : number);
    }
  }
  own_.resize(optics.has_heat.size(), kNone);
  for (uint32_t m = 0; m < own_.size(); ++m)
    if (!optics.has_heat[m]) {
      own_[m] = static_cast<uint32_t>(materials_.size());
      materials_.push_back(m);
    }
}

uint32_t HeatFaces::end_at(const Hit& hit, Dir direction, uint32_t material) const {
  if (!has_heat_[material]) return outside_material(material);
  const std::optional<uint32_t> element = elements_.at(hit, material);
  if (!element || !elements_.rests(hit)) return outside_moving();
  const bool front = dot(direction, hit.normal) < 0;
  if (front) return *element;
  return back_[*element] == kNone ? closed_back(*element) : back_[*element];
}

}  // namespace suite
