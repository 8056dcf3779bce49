// From radiance in front of the optics to digital counts: signal electrons, noise, gain and quantisation.
//
// Assumes: an extended scene in focus (camera equation); noise sources independent; the full well clips before the
// gain. The noise is added to the computed radiance as it is, with what is left of its Monte Carlo error. Based on: P.
// N. Slater, "Remote Sensing: Optics and Optical Systems", 1980 (G# = (1 + 4 N^2) / (tau pi), E = L / G#); J. R.
// Janesick, "Photon Transfer", SPIE 2007 (shot, read and fixed-pattern noise).
#pragma once
#include <cmath>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "base/params.h"
#include "sensor/sensors.h"
#include "spectral/state.h"

namespace suite {

inline constexpr double kMostElectrons = 1e12;

struct DetectorSpec {
  Curve quantum_efficiency;  // electrons per photon, 0..1
  double fill_factor = 1;    // sensitive share of the pitch, 0..1
  double dark_current = 0;   // electrons/s
  double read_noise = 0;     // electrons, standard deviation
  double full_well = 0;      // electrons; 0 = no limit
  double gain = 0;           // electrons per count; 0 = no converter: signal electrons alone, without noise
  double bias = 0;           // counts
  int bits = 16;             // 1..16
  bool shot_noise = true;
  double nonuniformity = 0;                  // standard deviation of a detector's relative response (PRNU)
  double dark_nonuniformity = 0;             // standard deviation of its relative dark current
  double dead = 0, hot = 0;                  // shares of detectors that give 0, or full scale, always
  std::vector<std::array<uint32_t, 2>> bad;  // column, row of further dead ones
  uint64_t seed = 0;                         // of everything random; fixed pattern depends on it alone
  // Of thermal instruments: K, a blackbody that fills the view, 0 = not one; and the noise-equivalent temperature
  // difference against it that is to be met, 0 = as the other terms make it.
  double background = 0, netd = 0;
  bool counts() const { return gain > 0; }
  // Signal electrons as they are told from counts: bias and mean dark current taken off. exposure: s.
  double signal_of(double counts, double exposure) const { return (counts - bias) * gain - dark_current * exposure; }
};

// Noise-equivalent temperature difference (NEDT, NETD): temporal noise against a blackbody that fills the view.
struct NoiseAtBackground {
  double own = 0;    // electrons, standard deviation: shot noise of signal and dark current, read noise, quantisation
  double slope = 0;  // electrons/K
  double more = 0;   // electrons, standard deviation of what has to be added to meet the spec's NETD
  double netd() const { return std::sqrt(own * own + more * more) / slope; }  // K
};
// signal: electrons that the background gives; slope: electrons/K there; exposure: s. NETD = noise / slope, all terms
// independent (Holst, "Electro-Optical Imaging System Performance", 2008, section on NEDT). Error: a NETD that is below
// what the other terms make.
NoiseAtBackground noise_at_background(const DetectorSpec& spec, double signal, double slope, double exposure);

// The keys of a detector, in the parts that its kinds (detectors/) are put together from. Located Error for anything
// wrong. What lets light in: quantum_efficiency, fill_factor.
void read_light(const Params& p, const SensorContext& context, DetectorSpec& d);
// What pixels differ in, and the seed: prnu, dark_nonuniformity, dead_fraction, hot_fraction, bad_pixels, seed. dark:
// the key of the dark current, per second.
void read_pixels(const Params& p, const char* dark, DetectorSpec& d);
// From charge to counts: gain_e_per_dn, full_well_e, bias_dn (`bias` unless given), bits.
void read_converter(const Params& p, double bias, DetectorSpec& d);

// 1/sr: irradiance on the focal plane = radiance / G#. throughput: 0..1 of the optics; obscuration: share of the
// diameter.
double g_number(double f_number, double throughput, double obscuration = 0);

// A band that weighs photons as the detector counts them: response x quantum efficiency x wavelength. `electrons`
// receives electrons per (W/(m2 um) of spectral irradiance on a m2 for 1 s), averaged with that weight:
// integral of response QE lambda / (h c) dlambda.
Band photon_band(const Band& band, const Curve& quantum_efficiency, double& electrons);

}  // namespace suite
