// The air over a place as a spectral state sees it: what each of its layers does to light, per bin.
//
// Between two levels densities are even and the temperature is linear in height; levels stand so close that neither
// shows (air_spec.h). Everything is per metre of way, whatever its direction.
#pragma once
#include <memory>
#include <span>
#include <vector>

#include "air/air_spec.h"
#include "air/beam_table.h"
#include "air/shells.h"
#include "optics/phase_function.h"
#include "spectral/state.h"

namespace suite {

struct AirColumn {
  Shells shells;
  size_t bins = 0;
  std::vector<float> extinction;  // [layer][bin], 1/m
  // What molecules, or particles of one kind, scatter of it, and how.
  struct Kind {
    std::vector<float> scattering;  // [layer][bin], 1/m
    std::shared_ptr<const PhaseFunction> phase;
    std::vector<std::vector<double>> moments;  // per bin: Legendre moments, [0] = 1, one more than streams
  };
  std::vector<Kind> kinds;
  std::vector<float> blackbody;  // [level][bin], W/(m2 sr um)

  std::vector<double> water;  // vapour in each layer, kg/m3
  // n - 1 at the levels and the reference wavelength, of dry air; empty = beams are straight.
  std::vector<double> refractivity;

  size_t ground = 0;  // level of the ground that the diffuse field stands on

  size_t layers() const { return shells.layers(); }
};

enum class ColumnParts {
  all,
  extinction,  // for many bins: no phase functions and moments, and particles interpolated over 1 % of the wavelength
};
// Bakes air for a state, whose g-points are some of those of with_gas_points. Error: bands beyond what gases or
// particles are known for (named); as check_air.
AirColumn bake_column(const AirSpec& spec, const SpectralState& state, ColumnParts parts = ColumnParts::all);

// How deep places in it lie for a beam from outside, in the shadow of the Earth below the ground's level. Error:
// density that falls so fast that it would lead light around the Earth.
BeamTable bake_beam_table(const AirSpec& spec, const AirColumn& column);

// Splits the intervals of a state (with_g_points) where gases absorb, so that a bin is monochromatic for them.
SpectralState with_gas_points(const AirSpec& spec, const SpectralState& state);

}  // namespace suite
