// Absorption line by line, and the tables of k that are baked from it.
//
// Assumes: Voigt lines cut 25 cm-1 from their middle, without mixing of lines; widths of air and of the gas itself.
// Based on: HITRAN's definitions (L. S. Rothman et al., J. Quant. Spectrosc. Radiat. Transfer 60, 1998, appendix A);
// the Voigt function of J. A. C. Weideman, SIAM J. Numer. Anal. 31, 1994 (N = 32); the g-points of E. J. Mlawer et al.,
// J. Geophys. Res. 102, 1997 (RRTM).
#pragma once
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "air/continuum.h"
#include "air/gas_table.h"

namespace suite {

// A line as HITRAN has it, at 296 K.
struct SpectralLine {
  double wavenumber_cm = 0;    // in vacuum
  double intensity = 0;        // cm-1/(molecule cm-2), isotopic abundance included
  double air_width_cm = 0;     // half width at half maximum, cm-1/atm
  double self_width_cm = 0;    // the same
  double lower_energy_cm = 0;  // cm-1
  double exponent = 0;         // of the air width in 296 K / T
  double shift_cm = 0;         // by the pressure of air, cm-1/atm
  int isotopologue = 1;        // of the gas, from 1 by abundance
};

// A gas to be baked: its lines by ascending wavenumber, the partition sum of an isotopologue at a temperature over that
// at 296 K (partition_ratio when there is nothing better), and its mass, kg/mol (molar_mass(gas) when there is none).
struct LineGas {
  Gas gas = Gas::h2o;
  std::vector<SpectralLine> lines = {};
  std::function<double(int isotopologue, double kelvin)> partition = {};
  std::function<double(int isotopologue)> mass = {};
  double share = 0;  // of all air, mol/mol, for its self broadening
};
// (T/296)^1.5, of linear molecules (T/296): rotation only, without vibrations.
double partition_ratio(Gas gas, double kelvin);

// Real part of w(x + iy), y >= 0, to 1e-6 of its largest at the same y.
double voigt(double x, double y);

// Cross section of a gas, m2/molecule, at wavenumbers low_cm + i * step_cm. base_left: each line without what it has at
// its cut, as MT_CKD expects of water.
std::vector<double> line_spectrum(const LineGas& gas, double low_cm, double step_cm, size_t count, double pressure,
                                  double temperature, bool base_left = false);
// Half width at half maximum of the narrowest of its lines from low_cm to high_cm, cm-1, to 0.02 % (J. J. Olivero & R.
// L. Longbothum, J. Quant. Spectrosc. Radiat. Transfer 17, 1977, equation 2); nothing when it has no line there.
std::optional<double> narrowest_line(const LineGas& gas, double low_cm, double high_cm, double pressure,
                                     double temperature);

struct LineBake {
  std::vector<double> edges_cm;     // of the bands
  std::vector<double> pressure;     // Pa
  std::vector<double> temperature;  // K
  double step_cm = 0.002;           // of the spectrum; at most as wide as narrowest_line at the lowest pressure
  size_t points = 16;               // of a band: 16, 8 or 4
  std::string source = {};
  std::function<void()> done = {};  // called after each of bake_spectra, from any thread
};
// Spectra that a bake goes through: one of each gas, band, pressure and temperature.
size_t bake_spectra(size_t gases, const LineBake& bake);
// The g-points of each band, each the mean of k over its part, so that the mean of k is kept. In parallel. Error: no
// band, no gas, a gas twice, an axis that is none (check_gas_table), a number of points that is none of these, a
// spectrum of more than 1e9 values or 2e7 in a band, a table of more than 2e9.
GasTable bake_lines(std::span<const LineGas> gases, const WaterContinuum* continuum, const LineBake& bake);

}  // namespace suite
