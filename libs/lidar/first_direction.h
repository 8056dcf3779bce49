// Where paths leave the receiver to: a direction within a pixel, or towards a place that the beam lights within the
// pixel, by the one-sample balance heuristic of both. A beam much narrower than the field is then never missed, and
// neither is what lies beside it.
//
// The beam is seen from the receiver as a spot on a sphere about the laser: p_receiver = p_beam s^2 / (R^2 cos), s the
// way from the receiver to the sphere of radius R, cos that of the angle at which it is met. One sphere stands at what
// the beam's axis meets; where the baseline moves the spot by more than a part of its width over the gate there are
// more, in equal steps of the logarithm.
// Based on: E. Veach, "Robust Monte Carlo methods for light transport simulation", 1997, section 9.2.
#pragma once
#include <array>
#include <vector>

#include "lidar/laser_beam.h"
#include "lidar/field.h"
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
  static constexpr size_t kMostSpheres = 9;
  struct Spheres {
    std::array<double, kMostSpheres> radius;
    size_t count = 0;
  };
  Spheres spheres(const PulseAtWork& pulse) const;
  double beam_density(const PulseAtWork& pulse, const Spheres& spheres, Dir direction) const;
  const LaserBeam& beam_;
  const ReceiverField& field_;
  double near_, far_;
  double field_share_;  // of directions evenly in the field
};

}  // namespace suite
