// What generation must remember of a path and processing need not.
#pragma once
#include <array>
#include <cstdint>

#include "math/sampling.h"
#include "optics/scatter_model.h"
#include "radiometry/medium_stack.h"
#include "surface/optics.h"

namespace suite {

struct LivePath {
  SampleStream stream{0, 0, 0};
  uint32_t sample = 0;
  std::array<double, 4> u;  // numbers of the current node
  Vec3 origin;              // of the next segment
  Dir direction;
  double length = 0;                     // optical length so far
  double relative[kMaxKnots];            // r_k
  double throughput[kMaxKnots];          // at the knots
  double shares = 1, shares_before = 1;  // A after and before the last event
  double last_density = 0;               // p_h of the last event, without roulette; 0 after a Dirac event or none
  MediumStack bodies;                    // that the next segment starts in
  bool scattered = false;                // the last event was a scattering in a medium, at:
  Vec3 place;
  double length_at_place = 0;               // optical length there
  const BakedMaterial* receiver = nullptr;  // that the path starts at
  uint32_t flights = 0;                     // through media so far
  uint32_t scatterings = 0;                 // inside media so far
};

// What a contribution is divided by that a path got in one of two ways, an explicit sample of a source or a
// continuation that met it: own is the density of the way it went, other that of the other one (formulas in
// path_generator.h).
inline double shared_density(double own, double other, bool disk) {
  return disk ? own + other * (other / own) : own + other;
}

}  // namespace suite
