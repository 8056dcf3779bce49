// Sources of radiance outside the scene that are far away: disks (Sun, Moon) and the sky. They are asked for a
// direction towards them (with its density) and for the radiance they send from a direction; both ways are combined by
// multiple importance sampling in the path generator. Lamps stand in lamps.h.
#pragma once
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "math/vec.h"
#include "spectral/state.h"

namespace suite {

// A date from which direction, distance and size of a body follow (resolve.h).
struct SourceTime {
  std::string utc;  // ISO 8601, as parse_iso8601 accepts it
  Where where;
};

// The Sun, or any far disk of uniform radiance.
struct SunSpec {
  Dir direction{0, 0, 1};               // towards the Sun, ENU
  double half_angle = 0.00465;          // rad; 0 = collimated
  Curve irradiance;                     // W/(m2 um) on a plane facing it
  std::optional<SourceTime> time = {};  // direction still to be computed
  bool disk_by_time = false;            // half angle too, from the distance of the date
  bool at_1_au = false;                 // the irradiance holds at 1 AU and is to be scaled to the distance of the date
};

// A layer of air as a thermal sky sees it, from the ground up.
struct ThermalLayer {
  double temperature_k = 0;
  Curve optical_depth;  // vertical, of absorption
};

// The sky over the scene. Radiance below the horizon (z < 0) is zero unless `full_sphere`. What is given decides the
// kind: `layers` a thermal sky, `table` a tabulated one, neither a uniform one.
struct SkySpec {
  Curve radiance;  // W/(m2 sr um): the mean, or the whole of a uniform sky
  // Relative radiance over zenith x azimuth, multiplied by `radiance`: rows are zenith angles from 0 to 90 degrees
  // (180 when full_sphere) inclusive, columns mathematical azimuths from 0 in equal steps, periodic; bilinear between.
  // With `cells`, rows and columns divide the same ranges into cells of one value each.
  std::vector<double> table;
  size_t zeniths = 0, azimuths = 0;
  bool full_sphere = false;
  bool cells = false;
  // When not empty: one table per wavelength (ascending), one after the other in `table`; piecewise linear in
  // wavelength between them, constant beyond the first and the last.
  std::vector<double> wavelength_um = {};
  // Emission of non-scattering layers over a plane Earth, with the zenith angles tabulated in `zeniths` rows (2 or
  // more).
  std::vector<ThermalLayer> layers = {};
};

struct DirectionSample {
  Dir direction;
  double density = 0;  // 1/sr; 0 = the only direction of a collimated source
};

// A far disk baked for a state.
class Sun {
 public:
  Sun(const SunSpec& spec, const SpectralState& state);  // Error: half angle not in [0, pi/2], negative irradiance
  DirectionSample sample(Vec2 u) const;
  bool collimated() const { return drop_ == 0; }
  bool contains(Dir d) const;                  // false when collimated: nothing meets it by chance
  double density() const { return density_; }  // inside the disk
  // Radiance of the disk, or the irradiance when collimated.
  const float* spectrum() const { return spectrum_.data(); }
  // Irradiance on a plane facing the disk.
  const float* irradiance() const { return irradiance_.data(); }
  Dir direction() const { return frame_.z; }

 private:
  Frame frame_;
  double drop_;     // 1 - cos(half angle)
  double density_;  // 1 / solid angle
  std::vector<float> spectrum_, irradiance_;
};

// A sky baked for a state. A uniform sky is met by chance only; others are also drawn, from one density for all
// wavelengths: the mean over the bins of what each of them would draw from. No bin's weight therefore exceeds the
// number of bins, and the estimate is unbiased in all of them.
class Sky {
 public:
  // Error: table of the wrong size, negative or not finite; layers without temperature or with negative depth.
  Sky(const SkySpec& spec, const SpectralState& state);
  bool tabulated() const { return !cdf_.empty(); }
  // When the shape is one for all wavelengths: relative radiance in a direction times a spectrum. spectrum() is null
  // for other skies. Both 0 below the horizon.
  double relative(Dir d) const;
  const float* spectrum() const { return channels_ == 1 ? spectrum_.data() : nullptr; }
  // Adds scale times the radiance from a direction, any kind of sky.
  void add(Dir d, float scale, std::span<float> radiance) const;
  // Only when tabulated.
  DirectionSample sample(Vec2 u) const;
  double density(Dir d) const;

 private:
  // The corners of the table that a direction lies between.
  struct Corners {
    size_t at[4];
    double weight[4];
    int count = 0;
  };
  void bake_layers(const SkySpec& spec, const SpectralState& state);
  void bake_density();
  bool outside(Dir d) const { return d.z < 0 && !full_sphere_; }
  Corners corners_of(Dir d) const;
  size_t cell_of(Dir d, size_t& row) const;
  double cell_mean(size_t row, size_t column, size_t channel) const;
  double cell_solid_angle(size_t row) const;

  std::vector<float> spectrum_;  // per bin
  std::vector<float> table_;     // [direction][channel]
  // Bin i takes (1 - t) of channel a and t of channel b.
  struct Mix {
    uint32_t a, b;
    float t;
  };
  std::vector<Mix> mix_;
  std::vector<double> cdf_;                       // over cells, row-major, last = 1
  size_t rows_ = 0, columns_ = 0, channels_ = 1;  // cells: rows x columns
  double theta_max_ = kPi / 2;
  bool full_sphere_ = false, cells_ = false;
};

}  // namespace suite
