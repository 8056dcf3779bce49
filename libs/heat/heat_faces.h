// The faces of elements, which are the rows of the exchange, and the ends of light: faces, parts of the sky, what has a
// temperature of its own.
#pragma once
#include <vector>

#include "heat/elements.h"
#include "heat/heat_optics.h"

namespace suite {

class HeatFaces {
 public:
  // Fronts of all elements in their order, then the backs of those that are open. Keeps a reference to the elements.
  HeatFaces(const Elements& elements, const HeatOptics& optics);

  size_t size() const { return element_.size(); }
  uint32_t element(size_t face) const { return element_[face]; }
  // The number that the face would have if no element had been left out: what its paths are drawn by, so that they are
  // the same.
  uint32_t number(size_t face) const { return numbers_.empty() ? static_cast<uint32_t>(face) : numbers_[face]; }
  bool is_back(size_t face) const { return face >= fronts_; }
  uint32_t back_of(uint32_t element) const { return back_[element]; }  // kNone: not open

  // Outsides, numbered after the faces.
  static constexpr uint32_t kRings = 16;  // of the sky, in which level ground receives equal shares of an even sky
  // Ring of a direction above the horizon.
  static uint32_t ring(Dir d) { return std::min(kRings - 1, static_cast<uint32_t>(kRings * d.z * d.z)); }
  uint32_t outside_ring(uint32_t ring) const { return count() + ring; }
  uint32_t outside_below() const { return count() + kRings; }       // beyond the scene, below the horizon
  uint32_t outside_moving() const { return count() + kRings + 1; }  // what moves, comes or goes
  uint32_t outside_material(uint32_t m) const { return count() + kRings + 2 + own_[m]; }
  size_t outsides() const { return kRings + 2 + materials_.size(); }
  // Materials with temperatures of their own, in the order of their outsides.
  const std::vector<uint32_t>& materials() const { return materials_; }

  // Where light ends that is absorbed at a hit of a material, coming along a direction. The back of an element that is
  // not open is an end of its own: as warm as the element, but what it takes goes to what is behind and warms nothing.
  uint32_t end_at(const Hit& hit, Dir direction, uint32_t material) const;
  uint32_t closed_back(uint32_t element) const { return count() + static_cast<uint32_t>(outsides()) + element; }
  // All numbers of ends lie below: faces, outsides, closed backs.
  size_t ends() const { return closed_back(static_cast<uint32_t>(elements_.size())); }
  // The face as warm as an end; kNone: an outside's.
  uint32_t face_of(uint32_t end) const {
    return end < size() ? end : end < size() + outsides() ? kNone : end - static_cast<uint32_t>(size() + outsides());
  }

 private:
  uint32_t count() const { return static_cast<uint32_t>(element_.size()); }
  const Elements& elements_;
  std::vector<bool> has_heat_;
  size_t fronts_;
  std::vector<uint32_t> element_, back_, own_, materials_;
  std::vector<uint32_t> numbers_;  // empty: the faces' own
};

}  // namespace suite
