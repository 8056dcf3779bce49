// Where the sun may stand on surfaces with Dirac lobes: elements of all that is bounded, and of what has no end the
// part from which light gets to the scene.
#pragma once
#include "heat/heat_faces.h"
#include "heat/primitive_faces.h"

namespace suite {

class MirrorPlaces {
 public:
  // mirrors: by material, whether it has Dirac lobes. elements: those whose light is looked for; mirrors are cut about
  // as finely. time: s, within the tracer's window. Keeps references.
  MirrorPlaces(const Tracer& tracer, const Elements& elements, const std::vector<bool>& mirrors, double time);

  size_t size() const { return finite() + endless_.size(); }
  size_t moving() const { return moving_; }  // instances, left out
  size_t endless() const { return endless_.size(); }
  bool is_endless(size_t place) const { return place >= finite(); }

  // A place as it is looked at with the sun in a direction (scene ENU).
  struct Patch {
    double area = 0;                     // m2; 0: sends nothing to the scene
    uint32_t element = kNone;            // of the mirrors', or
    uint32_t object = kNone;             // a surface without end,
    std::optional<PrimitiveFaces> part;  // cut off
  };
  Patch patch(size_t place, Dir sun) const;
  // Uniform over the patch.
  Hit point(const Patch& patch, const PointDraw& draw) const;

 private:
  size_t finite() const { return mirrors_ ? mirrors_->size() : 0; }
  const Tracer& tracer_;
  double time_;
  std::optional<Elements> mirrors_;
  struct Endless {
    uint32_t object;
    Box3 wanted;  // m, ENU: where its light is to come
  };
  std::vector<Endless> endless_;
  size_t moving_ = 0;
};

}  // namespace suite
