// A table for the correction of images for the air: the quantities of lut_bands.h over a grid of states of the air and
// of angles.
//
// A state (water vapour, aerosol, ozone, elevation of the ground) is solved once for all angles and heights of the
// sensor; states are independent of each other, so they may be done in any order, by many processes, and be kept.
#pragma once
#include <array>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "air/air_spec.h"
#include "correction/lut_bands.h"
#include "spectral/state.h"

namespace suite {

// Ascending values; an axis of one value is a constant.
struct LutAxis {
  std::string_view name;  // as ISOFIT has it
  const char* unit;
  double low, high;            // possible values
  std::vector<double> values;  // empty: as the air is (states), or the axis's own default
};
// The axes of a table, in their order: those of states first.
enum class LutAxisOf { water, aerosol, ozone, elevation, height, view_zenith, sun_zenith, azimuth };
inline constexpr size_t kLutAxes = 8, kLutStateAxes = 4;
using LutAxes = std::array<LutAxis, kLutAxes>;
// With their names, units and ranges, without values: H2OSTR (g/cm2), AOT550, O3 (DU), surface_elevation_km,
// observer_altitude_km (above sea level; default 100, above all air), observer_zenith (deg, default 0), solar_zenith
// (deg, must be given), relative_azimuth (deg, default 0).
LutAxes lut_axes();

struct LutTable {
  LutAxes axes;  // complete
  std::vector<Band> bands;
  std::vector<double> solar_irradiance;  // of each band at 1 AU, uW/(cm2 nm)
  size_t states() const;                 // of the air
  size_t views() const;                  // of each of them
  // What a state is called in messages: "H2OSTR 1.5, AOT550 0.1".
  std::string name_of(size_t state) const;
};

// The quantities of one state: [view], views in the order of the axes, the last fastest.
using LutState = std::vector<LutValues>;

// How finely a state is solved.
struct LutFineness {
  double widest_um = 0;  // of a bin; 0: half the narrowest band's width at half maximum, 10 nm at most
  int streams = 16;
  int points = 4;      // of the gases in a bin at most (GasReduction)
  double thin = 0.01;  // optical depth of layers that are solved as one (air_correction)
};

// Of the bins, um.
double widest_bin(const LutTable& table, const LutFineness& fineness);

// Completes the axes from the air and their defaults. Error: a value out of its range, not ascending, an aerosol's
// depth for air without any, a sensor that is not above the ground, no angle of the sun, more than 1e7 views, a state
// that is no air (5 g/cm2 of water above 2 km).
LutTable make_lut(const AirSpec& air, std::vector<Band> bands, LutAxes axes);
// The air of a state. Water vapour and ozone are columns above the ground, depths of aerosol as well.
AirSpec air_of_state(const AirSpec& air, const LutTable& table, size_t state);
// The bins on which the air of a state is solved, which is set as fine as that.
SpectralState lut_bins(AirSpec& air_of_state, const LutTable& table, const LutFineness& fineness);
LutState lut_state(const AirSpec& air, const LutTable& table, size_t state, const LutFineness& fineness);

// Largest difference of two solutions of a state over its views, for each key the bands: an estimate of the error of
// the coarser one.
LutValues lut_difference(const LutState& a, const LutState& b);

}  // namespace suite
