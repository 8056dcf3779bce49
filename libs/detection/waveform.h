// Expected primary electrons of a pixel over time: the impulse response with the pulse, the quantum efficiency, passive
// light and dark current. What every detector begins with.
#pragma once
#include <span>
#include <vector>

#include "detection/pulse_shape.h"

namespace suite {

// Even samples; sample k lasts from start + k step to start + (k + 1) step. Times are s after the pulse's emission.
struct SampleGrid {
  double start = 0, step = 1e-9;
  size_t count = 0;
  double begin_of(size_t k) const { return start + static_cast<double>(k) * step; }
  double middle(size_t k) const { return start + (static_cast<double>(k) + 0.5) * step; }
  double stop() const { return begin_of(count); }
};
inline constexpr size_t kMostSamples = 4000000;
// From start to stop, both s; the last sample reaches to stop or beyond. Error at `where`: no time, or more than
// kMostSamples.
SampleGrid samples_within(double start, double stop, double step, const Where& where = {});

// An impulse of the response.
struct PhotonArrival {
  double time = 0;  // s after the emission
  double photons = 0, variance = 0;
};

struct ElectronRates {
  double efficiency = 1;  // electrons per photon, 0..1
  double dark = 0;        // electrons/s
};

struct Expected {
  SampleGrid grid;
  std::vector<double> signal;    // electrons by the laser's light, of each sample
  std::vector<double> variance;  // of signal, by the paths of the response
  double background = 0;         // electrons of a sample: passive light and dark current
};

// passive: photons/s.
Expected expect_electrons(std::span<const PhotonArrival> arrivals, double passive, const PulseShape& pulse,
                          const ElectronRates& rates, const SampleGrid& grid);

}  // namespace suite
