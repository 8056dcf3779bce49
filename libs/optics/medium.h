// A participating medium: how it absorbs, scatters and emits per metre of way, and the same baked for a spectral state.
//
// Coefficients hold at density 1; a voxel grid scales them by its densities, so they may as well be per unit of mass
// (m2/kg) with densities in kg/m3. Extinction is absorption + scattering, always.
// Based on: S. Chandrasekhar, "Radiative transfer", 1960, chapter I; emission is absorption times n^2 B(T) (Kirchhoff).
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "optics/phase_function.h"

namespace suite {

struct Medium {
  std::string id;  // unique alpha-numeric identifier
  std::string description;
  Curve absorption = Curve::constant(0);  // 1/m at density 1
  Curve scattering = Curve::constant(0);  // 1/m at density 1
  ModelSpec phase;                        // a row of phases(); none when nothing scatters
  Curve index = Curve::constant(1);       // index of refraction
  double temperature_k = 0;               // 0 = none given: does not emit
  int priority = 0;                       // of overlapping bodies the one with the highest holds
};

// Coefficients finite and >= 0, index in [1, 5], a checked phase function where something scatters (filled in by
// isotropic scattering when none is named), a sane temperature. Error located at `where` otherwise.
void check_medium(Medium& medium, const Where& where = {});

// n - wavelength dn/dwavelength of an index of refraction, the slope taken over 2 % of the wavelength, as far as the
// curve reaches: what pulses are delayed by. Based on: M. Born & E. Wolf, "Principles of optics", section 1.3.4.
double group_index(const Curve& index, double wavelength_um);

// Per bin of a state. Error when a curve does not cover the state.
struct BakedMedium {
  BakedMedium(const Medium& medium, const SpectralState& state);
  // Of an index of 1, from its parts; blackbody may be empty. Bug: sizes that differ.
  BakedMedium(std::vector<float> absorption, std::vector<float> scattering, std::vector<float> blackbody,
              std::unique_ptr<const PhaseFunction> phase);
  std::vector<float> absorption, scattering;  // 1/m at density 1
  std::vector<float> index_squared;
  double group_index = 1;  // at the state's reference: light takes so much longer than in empty space
  std::vector<float>
      blackbody;  // n^2 B(T), W/(m2 sr um); empty = does not emit at its own temperature, or below 1e-12 everywhere
  std::unique_ptr<const PhaseFunction> phase;  // null when nothing scatters
  bool scatters() const { return phase != nullptr; }
  bool uniform() const;  // scatters alike at all wavelengths: the same coefficient and the same phase function
};

}  // namespace suite
