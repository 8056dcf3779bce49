// Explicit sources of radiance outside the scene: the Sun and the sky. Sources are asked for a direction towards them
// (with its density) and for the radiance they send from a direction; both ways are combined by multiple importance
// sampling in the path generator.
#pragma once
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "math/vec.h"
#include "spectral/state.h"

namespace suite {

// The Sun, or any far disk of uniform radiance.
struct SunSpec {
  Dir direction{0, 0, 1};               // towards the Sun, ENU
  double half_angle = 0.00465;          // rad; 0 = collimated
  Curve irradiance;                     // W/(m2 um) on a plane facing it
};

// The sky over the scene. Radiance below the horizon (z < 0) is zero unless `full_sphere`.
struct SkySpec {
  Curve radiance;                       // W/(m2 sr um): the mean, or the whole of a uniform sky
  // Relative radiance over zenith x azimuth, multiplied by `radiance`: rows are zenith angles from 0 to 90 degrees
  // (180 when full_sphere) inclusive, columns mathematical azimuths from 0 in equal steps, periodic. Empty = uniform.
  std::vector<double> table;
  size_t zeniths = 0, azimuths = 0;
  bool full_sphere = false;
};

struct DirectionSample {
  Dir direction;
  double density = 0;                   // 1/sr; 0 = the only direction of a collimated source
};

// A sun baked for a state.
class Sun {
 public:
  Sun(const SunSpec& spec, const SpectralState& state);   // Error: half angle not in [0, pi/2], negative irradiance
  DirectionSample sample(Vec2 u) const;
  bool collimated() const { return drop_ == 0; }
  bool contains(Dir d) const;                             // false when collimated: nothing meets it by chance
  double density() const { return density_; }             // inside the disk
  // Radiance of the disk, or the irradiance when collimated.
  const float* spectrum() const { return spectrum_.data(); }
  Dir direction() const { return frame_.z; }

 private:
  Frame frame_;
  double drop_;                         // 1 - cos(half angle)
  double density_;                      // 1 / solid angle
  std::vector<float> spectrum_;
};

// A sky baked for a state. A uniform sky is met by chance only; a tabulated one is also drawn from its table.
class Sky {
 public:
  Sky(const SkySpec& spec, const SpectralState& state);   // Error: table of the wrong size, negative or not finite
  bool tabulated() const { return !cdf_.empty(); }
  // Relative radiance in a direction, multiplies spectrum(); 0 below the horizon.
  double relative(Dir d) const;
  const float* spectrum() const { return spectrum_.data(); }
  // Only when tabulated: proportional to the cell means of the table times their solid angles.
  DirectionSample sample(Vec2 u) const;
  double density(Dir d) const;

 private:
  size_t cell_of(Dir d, size_t& row) const;
  double cell_solid_angle(size_t row) const;
  std::vector<float> spectrum_;
  std::vector<double> table_, cdf_;     // cdf over cells, row-major, last = 1
  size_t rows_ = 0, columns_ = 0;       // cells: (zeniths - 1) x azimuths
  double theta_max_ = kPi / 2;
  bool full_sphere_ = false;
};

struct Environment {
  std::unique_ptr<const Sun> sun;       // null = none
  std::unique_ptr<const Sky> sky;       // null = black
};

}  // namespace suite
