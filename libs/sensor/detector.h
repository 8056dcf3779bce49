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
#include "math/sampling.h"
#include "sensor/sensors.h"
#include "spectral/state.h"

namespace suite {

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

// Reads key `detector`; nothing when absent. Error: what only counts can show, without `gain_e_per_dn`.
std::optional<DetectorSpec> read_detector(const Params& params, const SensorContext& context);

// 1/sr: irradiance on the focal plane = radiance / G#. throughput: 0..1 of the optics; obscuration: share of the
// diameter.
double g_number(double f_number, double throughput, double obscuration = 0);

// A band that weighs photons as the detector counts them: response x quantum efficiency x wavelength. `electrons`
// receives electrons per (W/(m2 um) of spectral irradiance on a m2 for 1 s), averaged with that weight:
// integral of response QE lambda / (h c) dlambda.
Band photon_band(const Band& band, const Curve& quantum_efficiency, double& electrons);

class Detector {
 public:
  explicit Detector(const DetectorSpec& spec) : spec_(spec) {}
  const DetectorSpec& spec() const { return spec_; }
  // What a detector always is, of its number (row * columns + column of the array).
  struct Character {
    double response = 1, dark = 1;  // factors
    bool dead = false, hot = false;
  };
  Character character(uint64_t detector) const;
  struct Reading {
    uint16_t counts = 0;
    bool clipped = false;  // by the full well or an end of the converter; what always gives 0 or full scale is not
  };
  // One read-out of a detector that counts: signal electrons (before the detector's own response), exposure time (s)
  // and a number that tells this read-out from all others. more: electrons, standard deviation of noise beside that of
  // the spec.
  Reading read(double electrons, double exposure, const Character& of, uint64_t read_out, double more = 0) const;
  // Signal electrons as they are told from counts: bias and mean dark current taken off.
  double signal_of(double counts, double exposure) const {
    return (counts - spec_.bias) * spec_.gain - spec_.dark_current * exposure;
  }

 private:
  DetectorSpec spec_;
};

// Poisson variate with the given mean from a generator: by inversion up to 30, by transformed rejection above.
// Based on: W. Hoermann, "The transformed rejection method for generating Poisson random variables", Insurance:
// Mathematics and Economics 12, 1993 (algorithm PTRS).
double poisson(double mean, Pcg32& random);
// Standard normal variate (Box and Muller 1958).
double normal(Pcg32& random);

}  // namespace suite
