// Where a slice's cells lie: maps between incident directions and the sphere that the quad-tree divides, chosen so that
// lobes of all slices fall on top of one another.
//
// half:    the half vector h = (in + out) / |in + out|; a mirror lobe sits at the pole for every view. d in = 4 (out.h)
// d h. retro:   the same with `out` reflected at the normal's axis; a lobe that returns to the viewer sits at the pole.
// direct:  the incident direction itself (no lobe to follow).
// forward: the whole sphere around `out` (phase functions); what goes straight on, in = -out, sits at its lower pole.
// On the transmitted side `in` is first folded up (in.z -> -in.z): light that goes straight on sits at the pole under
// half.
//
// Based on: S. Rusinkiewicz, "A new change of variables for efficient BRDF representation", EGWR 1998 (half vector);
// the Jacobian is Torrance & Sparrow's 4 cos (JOSA 57, 1967).
#pragma once
#include <algorithm>
#include <cmath>
#include <utility>

#include "math/vec.h"

namespace suite::sqt {

enum class LobeFrame { half = 0, retro = 1, direct = 2, forward = 3 };

// One slice's map. `out` is the view in the slice's own frame.
class LobeMap {
 public:
  LobeMap(LobeFrame frame, Dir out, bool transmitted)
      : frame_(frame), out_(frame == LobeFrame::retro ? Dir{-out.x, -out.y, out.z} : out), transmitted_(transmitted) {}
  bool reflects() const { return frame_ == LobeFrame::half || frame_ == LobeFrame::retro; }

  // The point of the divided sphere for an incident direction of this sheet's side.
  Dir cell_direction(Dir in) const {
    if (transmitted_) in.z = -in.z;
    if (!reflects()) return in;
    return normalized(in + out_);
  }
  // The inverse; may lie below the horizon (then there is nothing).
  Dir incident(Dir d) const {
    Dir in = reflects() ? d * (2 * dot(d, out_)) - out_ : d;
    if (transmitted_) in.z = -in.z;
    return in;
  }
  // Solid angle of incident directions per solid angle of the divided sphere.
  double stretch(Dir d) const { return reflects() ? 4 * std::fabs(dot(d, out_)) : 1.0; }
  // Cosine of the incident direction (positive on this sheet's side) for surfaces. Half vectors lie above the horizon:
  // below it d and -d name the same incident direction, so such a d stands for nothing (cosine at most 0).
  double cosine(Dir d) const {
    if (!reflects()) return d.z;
    const double along = dot(d, out_);
    return 2 * (d.z > 0 ? along : std::max(along, 0.0)) * d.z - out_.z;
  }
  // Cosine and stretch of several directions at once, each a vector of doubles; the same bits.
  template <class Lanes>
  std::pair<Lanes, Lanes> cosine_and_stretch(Lanes x, Lanes y, Lanes z) const {
    if (!reflects()) return {z, Lanes{} + 1};
    const Lanes along = x * out_.x + y * out_.y + z * out_.z, none{};
    const Lanes seen = z > 0 ? along : (along > 0 ? along : none);
    return {2 * seen * z - out_.z, 4 * (along < 0 ? -along : along)};
  }

 private:
  LobeFrame frame_;
  Dir out_;
  bool transmitted_;
};

}  // namespace suite::sqt
