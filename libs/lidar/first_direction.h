// Where paths leave the receiver to: a direction within a pixel, or towards a place that the beam lights within the
// pixel, by the one-sample balance heuristic of both. A beam much narrower than the field is then never missed, and
// neither is what lies beside it.
//
// The beam is seen from the receiver as a spot on a plane across its axis: p_receiver = p_plane s^2 / cos, s the way
// from the receiver to the plane, cos that of the angle at which it is met. One plane stands at what the axis meets;
// where the baseline moves the spot by more than a part of its width over the gate there are more, in equal steps of
// the logarithm of their distances.
// Based on: E. Veach, "Robust Monte Carlo methods for light transport simulation", 1997, section 9.2.
#pragma once
#include <algorithm>
#include <array>
#include <vector>

#include "lidar/field.h"
#include "lidar/laser_beam.h"
#include "lidar/pulse_at_work.h"

namespace suite {

class FirstDirection {
 public:
  // Keeps references. near, far: m, between which light may turn back. in_field: whether directions evenly in the field
  // are needed at all beside those in the beam.
  enum class InField { needed, spared };
  FirstDirection(const LaserBeam& beam, const ReceiverField& field, double near, double far, InField in_field);

  // importance: over the density, m2 sr; 0 = outside of the pixel.
  struct Drawn {
    Dir direction;  // ENU
    double importance = 0;
  };
  Drawn draw(const PulseAtWork& pulse, size_t pixel, const std::array<double, 4>& u) const;

 private:
  static constexpr size_t kMostPlanes = 9;
  struct Planes {
    std::array<double, kMostPlanes> distance;  // m from the laser
    size_t count = 0;
    // Half of the draws are for the plane at what the axis meets, the others share the rest.
    double share(size_t k) const { return count == 1 ? 1 : k == 0 ? 0.5 : 0.5 / static_cast<double>(count - 1); }
    size_t choose(double u) const {
      if (count == 1 || u < 0.5) return 0;
      return std::min(count - 1, 1 + static_cast<size_t>((2 * u - 1) * static_cast<double>(count - 1)));
    }
  };
  Planes planes(const PulseAtWork& pulse) const;
  double beam_density(const PulseAtWork& pulse, const Planes& planes, Dir direction) const;
  const LaserBeam& beam_;
  const ReceiverField& field_;
  double near_, far_;
  double field_share_;  // of directions evenly in the field
};

}  // namespace suite
