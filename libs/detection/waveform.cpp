#include "detection/waveform.h"

#include <algorithm>
#include <cmath>

namespace suite {

SampleGrid samples_within(double start, double stop, double step, const Where& where) {
  if (!(step > 0) || !(stop > start))
    throw Error(where, strf("a gate from %g to %g s", start, stop), "stop after start");
  const double count = std::ceil((stop - start) / step * (1 - 1e-12));
  if (!(count <= static_cast<double>(kMostSamples)))
    throw Error(where, strf("a gate of %.4g samples of %g s", count, step),
                strf("at most %zu: a shorter gate or longer samples", kMostSamples));
  return {start, step, std::max<size_t>(1, static_cast<size_t>(count))};
}

Expected expect_electrons(std::span<const PhotonArrival> arrivals, double passive, const PulseShape& pulse,
                          const ElectronRates& rates, const SampleGrid& grid) {
  Expected e{grid, std::vector<double>(grid.count, 0), std::vector<double>(grid.count, 0),
             (passive * rates.efficiency + rates.dark) * grid.step};
  const auto sample_of = [&](double t) {
    return static_cast<size_t>(
        std::clamp(std::floor((t - grid.start) / grid.step), 0.0, static_cast<double>(grid.count - 1)));
  };
  for (const PhotonArrival& a : arrivals) {
    if (a.time + pulse.high() < grid.start || a.time + pulse.low() >= grid.stop()) continue;
    const size_t first = sample_of(a.time + pulse.low()), last = sample_of(a.time + pulse.high());
    double before = pulse.before(grid.begin_of(first) - a.time);
    for (size_t k = first; k <= last; ++k) {
      const double after = pulse.before(grid.begin_of(k + 1) - a.time), share = rates.efficiency * (after - before);
      e.signal[k] += share * a.photons;
      e.variance[k] += share * share * a.variance;
      before = after;
    }
  }
  return e;
}

}  // namespace suite
