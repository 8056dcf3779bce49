// Opaque surfaces that lie on the faces of what light passes: the ground under a block of glass, the walls of a basin
// of water. Both faces stand in one place, and a ray that had been let through the first would start beyond the second.
// What is opaque ends whatever lies on it, whichever of the two the tracer names: glass or water that lies on something
// touches it, without air between.
// Of two faces that both pass light, one that lies on the other is not seen (told: scheduler/surroundings.h).
#pragma once
#include <vector>

#include "surface/surface.h"

namespace suite {

class Contacts {
 public:
  // Keeps references.
  Contacts(const Surface& surface, const Optics& optics);
  // Puts the opaque surface that lies where `ray` has met a face that passes light, if there is one, into hit; the
  // distance stays as it was. What it takes to find out counts as rays.
  void settle(const Ray& ray, Hit& hit, TraceStatistics& statistics) {
    if (any_ && hit.hit()) look(ray, hit, statistics);
  }
  // Whether there is one.
  bool covers(const Ray& ray, Hit hit, TraceStatistics& statistics) {
    settle(ray, hit, statistics);
    return any_ && kind(hit) == Kind::opaque;
  }

 private:
  enum class Kind : uint8_t { other, face, opaque };
  void look(const Ray& ray, Hit& hit, TraceStatistics& statistics);
  Kind kind(const Hit& hit) const {
    const uint32_t material = surface_.material(hit);
    return material == kNone ? Kind::opaque : kind_[material];
  }
  const Surface& surface_;
  std::vector<Kind> kind_;  // [material]
  bool any_ = false;
  std::vector<Hit> beside_;  // scratch
};

}  // namespace suite
