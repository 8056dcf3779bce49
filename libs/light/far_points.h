// Far points of a light, stars and planets: too small for any path to meet, so that sensors that can put them on their
// focal plane themselves (sensor/point_images.h).
#pragma once
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "light/night/satellites.h"
#include "math/vec.h"
#include "motion/star_refraction.h"
#include "spectral/curve.h"
#include "spectral/state.h"

namespace suite {

struct FarPoint {
  std::string name;  // in its catalogue
  double v = 0;      // magnitude
  double scale = 1;  // of its light
  double kelvin = 0;
  std::shared_ptr<const Curve> shape = {};         // over that at 0.55 um; null = a blackbody's of `kelvin`
  bool twinkles = true;                            // it has no disk
  std::shared_ptr<const SunlitPoint> moving = {};  // a satellite, whose light is its share of the Sun's
  Dir direction;  // towards it at the moment of FarPoints, scene ENU, without refraction
};

// Where and when a point is looked for: m, scene ENU; s.
struct PointLook {
  double time = 0;
  Vec3 from;
};

struct FarPoints {
  std::vector<FarPoint> points;
  Dir pole;                                        // they turn about it with the Earth, scene ENU
  double seconds = 0;                              // simulation time of the directions
  std::optional<uint64_t> scintillation = {};      // seed; nothing: they do not twinkle
  double height = 0;                               // m above sea level, of the scene's origin
  std::shared_ptr<const StarRefraction> air = {};  // that lifts them; null: there is none

  // The factor by which a point differs from its mean in an exposure of a sensor; 1 where nothing twinkles, or the
  // sensor's aperture (m) is not known (0).
  struct Watched {
    double aperture = 0, begin = 0, end = 0;  // m; s
    Vec3 from;                                // m, scene ENU
    Dir direction;                            // of the point
  };
  double scintillation_of(size_t point, const Watched& how) const;

  // Towards a point as it is seen, through the air above or, from orbit, along the limb; satellites are not lifted.
  Dir direction_at(const FarPoint& point, const PointLook& look) const;
  // Above the air, W/(m2 um), the mean of each bin.
  std::vector<double> irradiance(const FarPoint& point, const SpectralState& state, const PointLook& look = {}) const;
};

}  // namespace suite
