// The geometry of a camera's optics: which direction a place of the focal plane looks in.
//
// Focal-plane coordinates are metres as the scene is seen: x to the right, y downwards, the optical axis at (0, 0). The
// camera's own axes are x right, y up in the picture, and it looks along -z.
// Based on: D. C. Brown, "Close-range camera calibration", Photogrammetric Engineering 37(8), 1971 (radial and
// decentring distortion).
#pragma once
#include <optional>

#include "base/params.h"
#include "math/vec.h"

namespace suite {

// Brown and Conrady's model in coordinates divided by the focal length: a thing whose undistorted image is at (x, y),
// r^2 = x^2 + y^2, is imaged at
//   x' = x (1 + k1 r^2 + k2 r^4 + k3 r^6) + 2 p1 x y + p2 (r^2 + 2 x^2)
//   y' = y (1 + k1 r^2 + k2 r^4 + k3 r^6) + p1 (r^2 + 2 y^2) + 2 p2 x y
struct Distortion {
  double k1 = 0, k2 = 0, k3 = 0, p1 = 0, p2 = 0;
  bool none() const { return k1 == 0 && k2 == 0 && k3 == 0 && p1 == 0 && p2 == 0; }
  Vec2 distorted(Vec2 ideal) const;
  // The inverse by Newton's method to 1e-14; nothing where the model folds over.
  std::optional<Vec2> ideal(Vec2 distorted) const;
};

struct Lens {
  double focal_length = 0.05;  // m, > 0
  double aperture = 0;         // m, diameter; 0 = not stated (a pinhole)
  double obscuration = 0;      // share of the diameter, 0..0.95
  double throughput = 1;       // 0..1
  bool cos4 = false;           // the focal plane's irradiance falls off as cos^4 of the angle from the axis
  double focus_distance = 0;   // m; > 0: rays start all over the aperture and meet at this distance
  Distortion distortion;

  double f_number() const { return aperture > 0 ? focal_length / aperture : 0; }
  bool thin() const { return focus_distance > 0 && aperture > 0; }
  // Unit direction in camera axes of what is imaged at a place of the focal plane (m).
  Dir look(Vec2 place) const;
  // The place of the focal plane (m) where a direction in camera axes (z < 0) is imaged.
  Vec2 image_of(Dir direction) const;
  // Where on the aperture a ray starts, m in the camera's x-y plane, from two uniform numbers.
  Vec2 pupil(double u, double v) const;
};

// Keys focal_length_mm, aperture_mm or f_number, obscuration, throughput, cos4, focus_distance_m, distortion.
Lens read_lens(const Params& params);

}  // namespace suite
