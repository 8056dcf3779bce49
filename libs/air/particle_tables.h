// The tables that scripts/bake_particles makes, and how values between their entries follow.
#pragma once
#include <span>
#include <string>
#include <vector>

#include "math/mueller.h"

namespace suite {

// A place between two nodes: (1 - share) of `low`, share of low + 1.
struct Between {
  size_t low;
  double share;
};
// scale: of the coordinate in which one interpolates, ascending or descending in x alike; nodes ascend. x is taken to
// the nearest end outside them; with one node, low is 0 and so is the share.
Between between(std::span<const double> nodes, double x, double (*scale)(double));

// One kind over states (humidities, effective radii) and wavelengths.
struct ParticleTable {
  std::span<const double> wavelengths_um, phase_wavelengths_um, states;
  std::vector<double> extinction, absorbed;  // [state][wavelength]; absorbed: share of the extinction, 1 - albedo
  std::span<const short> phase;   // [state][phase wavelength][stored angle], thousandths of ln, by differences
  std::vector<double> asymmetry;  // instead of a phase function: Henyey-Greenstein's
  // [state][phase wavelength][P12, P33, P34][stored angle], thousandths of P11, by differences; empty: not known.
  std::span<const short> matrix;
  bool has_matrices() const { return !matrix.empty(); }

  // Interpolated: logarithms of extinction and of what is absorbed; phase functions mixed by what they scatter.
  struct Value {
    double extinction, albedo;
    std::vector<double> phase;  // over phase_cosines()
  };
  Value at(double wavelength_um, double state, double (*scale)(double)) const;
  // Scattering matrices over P11, over phase_cosines(), of the same mixture.
  std::vector<PlaneBlocks> matrices(double wavelength_um, double state, double (*scale)(double)) const;

 private:
  std::vector<double> corner_phase(size_t entry) const;
  std::vector<PlaneBlocks> corner_matrices(size_t entry) const;
  double scattering_at(double wavelength_um, size_t state) const;
  template <class Use>
  void corners(std::span<const double> wavelengths, double wavelength_um, const Between& state, const Use& use) const;
};

// rural, maritime, urban, free_troposphere: states are relative humidities; stratosphere: one state.
ParticleTable aerosol_table(const std::string& name);
ParticleTable desert_table();  // states: wind speeds, m/s
ParticleTable water_table();   // states: effective radii, um; extinction m2/kg
ParticleTable ice_table();

}  // namespace suite
