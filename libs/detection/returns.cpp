#include "detection/returns.h"

#include <algorithm>
#include <cmath>

namespace suite {

void number_returns(std::vector<LidarReturn>& returns) {
  std::sort(returns.begin(), returns.end(), [](const LidarReturn& a, const LidarReturn& b) { return a.time < b.time; });
  for (size_t k = 0; k < returns.size(); ++k)
    returns[k].number = static_cast<uint32_t>(k + 1), returns[k].of = static_cast<uint32_t>(returns.size());
}

namespace {

// The signal at a time, straight between middles of samples, the end values beyond.
double at(std::span<const double> signal, const SampleGrid& grid, double time) {
  const double x = std::clamp((time - grid.middle(0)) / grid.step, 0.0, static_cast<double>(grid.count - 1));
  const auto k = std::min(static_cast<size_t>(x), grid.count - 1);
  if (k + 1 >= grid.count) return signal[k];
  const double share = x - static_cast<double>(k);
  return signal[k] * (1 - share) + signal[k + 1] * share;
}

}  // namespace

std::vector<LidarReturn> leading_edges(std::span<const double> signal, const SampleGrid& grid, const Threshold& t) {
  std::vector<LidarReturn> found;
  bool armed = true;
  double deaf_until = -1;
  for (size_t k = 0; k < grid.count && found.size() < t.most; ++k) {
    if (signal[k] < t.level - t.hysteresis || (t.hysteresis == 0 && signal[k] < t.level)) armed = true;
    if (!armed || signal[k] < t.level) {
      if (!found.empty() && signal[k] >= t.level - t.hysteresis && !armed)
        found.back().amplitude = std::max(found.back().amplitude, signal[k]);
      continue;
    }
    armed = false;
    double time = grid.middle(k);
    if (k && signal[k - 1] < t.level)
      time = grid.middle(k - 1) + grid.step * (t.level - signal[k - 1]) / (signal[k] - signal[k - 1]);
    if (time < deaf_until) continue;
    LidarReturn r;
    r.time = time, r.amplitude = signal[k];
    found.push_back(r);
    deaf_until = time + t.dead;
  }
  number_returns(found);
  return found;
}

std::vector<LidarReturn> constant_fractions(std::span<const double> signal, const SampleGrid& grid,
                                            const ConstantFraction& c) {
  std::vector<LidarReturn> found;
  double peak = 0, deaf_until = -1, last = 0;
  for (size_t k = 0; k < grid.count && found.size() < c.arm.most; ++k) {
    peak = std::max(peak, signal[k]);
    const double difference = at(signal, grid, grid.middle(k) - c.delay) - c.fraction * signal[k];
    if (k && last < 0 && difference >= 0 && peak >= c.arm.level) {
      const double time = grid.middle(k - 1) + grid.step * last / (last - difference);
      if (time >= deaf_until) {
        LidarReturn r;
        r.time = time, r.amplitude = peak;
        found.push_back(r);
        deaf_until = time + c.arm.dead;
      }
      peak = 0;
    }
    last = difference;
  }
  number_returns(found);
  return found;
}

}  // namespace suite
