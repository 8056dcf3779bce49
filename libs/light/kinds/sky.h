// The sky: uniform, tabulated (one table or one per wavelength, e.g. an environment image), or thermal.
//
// Based on: importance sampling of environment maps by cells (Pharr, Jakob & Humphreys, "Physically based rendering",
// 2016, section 14.2.4), extended to many wavelengths by averaging the densities each bin would use. Thermal sky:
// Schwarzschild's equation for isothermal absorbing layers over a plane Earth (e.g. Liou 2002, eq. 4.2.9).
#pragma once
#include <algorithm>
#include <optional>
#include <vector>

#include "light/light_spec.h"

namespace suite {

// A layer of air as a thermal sky sees it, from the ground up.
struct ThermalLayer {
  double temperature_k = 0;
  Curve optical_depth;  // vertical, of absorption
};

// How molecules polarise a sky: across the plane of its direction and the sun, by the degree most sin^2 / (1 + cos^2)
// of the angle between the two, at all wavelengths. Based on: Lord Rayleigh 1871 (Bohren & Huffman 1983, section 5.2).
struct RayleighPattern {
  Dir sun;          // towards it
  double most = 0;  // at right angles from the sun, 0 to 1
};

// Q and U over I of a sky's light, in the meridian frame of its direction of travel, at all wavelengths: rows and
// columns as SkySpec::table, bilinear between.
struct SkyStokes {
  std::vector<double> q, u;  // hypot(q, u) <= 1
  size_t zeniths = 0, azimuths = 0;
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
  std::optional<RayleighPattern> polarisation = {};  // neither: unpolarised
  std::optional<SkyStokes> stokes = {};
};

LightSpecPtr make_light(SkySpec spec);

// A sky baked for a state. A uniform sky is met by chance only; others are also drawn, from one density for all
// wavelengths: the mean over the bins of what each of them would draw from. No bin's weight therefore exceeds the
// number of bins, and the estimate is unbiased in all of them.
class Sky final : public Light {
 public:
  // Error: table of the wrong size, negative or not finite; layers without temperature or with negative depth.
  Sky(const SkySpec& spec, const SpectralState& state);
  // For its directions alone: of one wavelength.
  explicit Sky(const SkySpec& directions);
  std::optional<LightSample> sample(const LightReceiver& at, const std::array<double, 4>& u,
                                    double time) const override;
  std::optional<LightMet> met_outside(Dir direction, double time) const override;
  void add(Dir d, double time, float scale, std::span<float> radiance) const override;  // any kind of sky
  size_t members() const override { return 0; }
  std::optional<LightSample> sample_member(size_t member, double probability, const LightReceiver& at,
                                           const std::array<double, 4>& u, double time) const override;

  Stokes stokes(uint32_t source, Dir k, double time) const override;

  bool tabulated() const { return !cdf_.empty(); }
  // When the shape is one for all wavelengths: relative radiance in a direction times a spectrum. spectrum() is null
  // for other skies. Both 0 below the horizon.
  double relative(Dir d) const;
  const float* spectrum() const { return channels_ == 1 ? spectrum_.data() : nullptr; }
  // Only when tabulated.
  DirectionSample draw(Vec2 u) const;
  double density(Dir d) const;

 private:
  // Where a direction lies in the table.
  struct Place {
    double row, column;
  };
  // The corners of the table that a direction lies between.
  struct Corners {
    size_t at[4];
    double weight[4];
    int count = 0;
  };
  void bake_table(const SkySpec& spec, const SpectralState& state);
  void bake_layers(const SkySpec& spec, const SpectralState& state);
  void bake_density();
  bool outside(Dir d) const { return d.z < 0 && !full_sphere_; }
  Place place_of(Dir d) const;
  size_t row_of(Place p) const { return std::min(rows_ - 1, static_cast<size_t>(p.row)); }
  size_t column_of(Place p) const { return std::min(columns_ - 1, static_cast<size_t>(p.column)); }
  Corners corners_of(Place place) const;
  double relative(Place place) const;
  double density(Place place) const;
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
  std::vector<uint32_t> begins_;                  // the first cell whose cdf exceeds i / cells
  std::vector<double> densities_;                 // 1/sr, of cells
  std::vector<Vec2> turns_;                       // cosine and sine of the azimuths between columns of cells
  std::vector<double> edges_;                     // cosines of the zenith angles between rows of cells
  size_t rows_ = 0, columns_ = 0, channels_ = 1;  // cells: rows x columns
  double theta_max_ = kPi / 2;
  bool full_sphere_ = false, cells_ = false;
  std::optional<RayleighPattern> polarisation_;
  std::optional<SkyStokes> stokes_;
  uint32_t source() const { return polarisation_ || stokes_ ? 0 : kUnpolarised; }
  Stokes tabulated_stokes(Dir d) const;
};

}  // namespace suite
