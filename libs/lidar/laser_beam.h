// How a laser's beam spreads: its density over directions, and rays drawn from it.
//
// Profiles are even in the tangent plane q = (x, y) / -z of the laser's frame, as an even plate under a top hat of edge
// angle a holds energy / (pi R^2 tan^2 a). At a distance R the waist w joins in, as a tangent:
//   Gaussian   1/e^2 radius sqrt(tan^2(full angle / 2) + (w / R)^2)
//   top hat    edge tan(half angle) + w / R
//   image      none
// What has no width at all is traced as kNarrowest wide.
// Based on: A. Siegman, "Lasers", 1986, chapter 17 (Gaussian beams far and near).
#pragma once
#include <vector>

#include "lidar/instrument.h"

namespace suite {

class LaserBeam {
 public:
  static constexpr double kNarrowest = 1e-6;  // rad, half-angle: what hits on large triangles are exact to

  // Error: angles out of range, an image of no energy, or one with a waist.
  explicit LaserBeam(const BeamProfile& profile);

  // 1/sr, of a unit energy, towards a point in a direction of the laser's frame (unit) and at a distance (m, > 0) from
  // its middle.
  double density(Dir local, double distance) const;
  // A direction as density() has it.
  Dir sample(Vec2 u, double distance) const;
  // A ray of the beam: the same light at all distances, but for the squared angle's share of a waist.
  struct Start {
    Vec3 place;  // m, laser's frame
    Dir direction;
  };
  Start start(Vec2 u, Vec2 u_place) const;
  double solid_angle() const { return solid_angle_; }  // sr, that holds most of it, far away
  // rad, half-angle, of the narrowest detail
  double width() const { return width_; }

 private:
  double cells_density(Vec2 q) const;
  Vec2 sample_cells(Vec2 u) const;
  BeamProfile profile_;
  double edge_ = 0;  // tangent
  double solid_angle_ = 0, width_ = 0;
  std::vector<double> cumulative_;  // of the image, up to 1
};

}  // namespace suite
