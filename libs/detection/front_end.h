// The analogue part of a detector that is linear in light: primary electrons, avalanche, receiver, amplifier; and how
// returns are told from its voltage.
#pragma once
#include "detection/decompose.h"
#include "detection/detectors.h"

namespace suite {

struct FrontEnd {
  ElectronRates rates;
  double gain = 1;             // mean, of the avalanche, >= 1
  double excess = 1;           // noise factor F >= 1
  double amplifier_noise = 0;  // electrons behind the avalanche, standard deviation of a sample
  double receiver_fwhm = 0;    // s, of the answer to one electron
};
// Keys quantum_efficiency, dark_rate_hz, gain, excess_noise | ionisation_ratio, receiver_fwhm_ns. The caller adds the
// amplifier.
FrontEnd read_front_end(const Params& params);

// Electrons behind the avalanche in each sample. ideal: the mean of `noisy`; error: of ideal by the paths of the
// response; noise: standard deviation of noisy about ideal.
struct Voltage {
  SampleGrid grid;
  std::vector<double> ideal, error, noise, noisy;
  std::vector<double> signal;  // the laser's part of ideal
  double level = 0;            // of ideal where there is background alone
  // Noise of neighbouring samples is correlated by the receiver. Sums over many samples have this times the variance of
  // independent ones: (sum w)^2 / sum w^2 of its shares w.
  double correlation = 1;
};
Voltage pass(const FrontEnd& front, const Expected& expected, Pcg32& random);

// How returns are told. Key `returns: {by: none | threshold | constant_fraction | gaussian, ...}`.
struct Discriminator {
  enum class By { none, threshold, constant_fraction, gaussian } by = By::none;
  Threshold threshold;
  double fraction = 0.5, delay = 0;
  DecomposeSpec decompose;
};
// Keys threshold_UNIT, hysteresis_UNIT, which become the unit's multiples of `scale`. width: s, standard deviation of
// the system's answer to an impulse.
Discriminator read_discriminator(const Params& params, const char* unit, double scale, double width);
// values: above the baseline. noise: of each sample.
std::vector<LidarReturn> tell_returns(const Discriminator& d, std::span<const double> values,
                                      std::span<const double> noise, const SampleGrid& grid);
// Truth: a return is one of the laser's light when that has more electrons within a FWHM about it than the rest has.
void mark_signal(std::vector<LidarReturn>& returns, const Voltage& voltage, double fwhm);

}  // namespace suite
