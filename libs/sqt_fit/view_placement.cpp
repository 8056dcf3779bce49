#include "sqt_fit/view_placement.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"

namespace suite::sqt {

namespace {

constexpr size_t kDense = 61;  // trial angles
constexpr size_t kRadii = 14, kViewAzimuths = 7;

// log2 f and its share of the scattered power at one view, over fixed points of the divided sphere; share 0 = not
// valid.
struct Look {
  std::vector<double> level, share;
};

Look look(const Function& function, LobeFrame frame, double theta) {
  const size_t channels = function.info().wavelength_um.size();
  const Dir out = dir_from_angles(theta, 0);
  const LobeMap map(frame, out, false);
  Look l;
  std::vector<double> f(channels);
  for (size_t r = 0; r < kRadii; ++r)
    for (size_t a = 0; a < kViewAzimuths; ++a) {
      // Rings of polar angle from 0.2 to 80 deg in geometric steps, each standing for the ring around it.
      const double polar = 0.2 * kDegree * std::pow(400.0, static_cast<double>(r) / (kRadii - 1));
      const Dir d = dir_from_angles(polar, kPi * (static_cast<double>(a) + 0.5) / kViewAzimuths);
      const double cosine = map.cosine(d);
      double level = 0, share = 0;
      if (cosine > 0.02) {
        function.value(out, map.incident(d), f);
        double mean = 0;
        for (const double v : f) mean += v / static_cast<double>(channels);
        if (std::isfinite(mean) && mean > 0) {
          level = std::log2(std::max(mean, 1e-9));
          share = mean * cosine * map.stretch(d) * polar * std::sin(polar);
        }
      }
      l.level.push_back(level);
      l.share.push_back(share);
    }
  return l;
}

}  // namespace

std::vector<double> place_views(const Function& function, LobeFrame frame, size_t count, size_t most, double last,
                                double allowed) {
  std::vector<Look> looks(kDense);
  const double step = last / (kDense - 1);
  parallel_for(0, kDense, 1, [&](size_t begin, size_t end) {
    for (size_t j = begin; j < end; ++j) looks[j] = look(function, frame, step * static_cast<double>(j));
  });
  // Mean second difference at every trial angle.
  std::vector<double> bend(kDense, 0.0);
  for (size_t j = 1; j + 1 < kDense; ++j) {
    double sum = 0, norm = 0;
    for (size_t k = 0; k < looks[j].level.size(); ++k) {
      const double w = std::min({looks[j - 1].share[k], looks[j].share[k], looks[j + 1].share[k]});
      if (!(w > 0)) continue;
      sum += looks[j].share[k] * std::fabs(looks[j - 1].level[k] - 2 * looks[j].level[k] + looks[j + 1].level[k]);
      norm += looks[j].share[k];
    }
    bend[j] = norm > 0 ? sum / norm : 0;
  }
  bend[0] = bend[1];
  bend[kDense - 1] = bend[kDense - 2];
  double mean = 0;
  for (const double b : bend) mean += b / kDense;
  // Views count by their solid angle; beyond 80 deg measurements are poor and nothing is gained by following them
  // closely.
  std::vector<double> cumulative{0};
  double weights = 0;
  for (size_t j = 0; j + 1 < kDense; ++j) {
    const double theta = step * (static_cast<double>(j) + 0.5);
    const double weight = theta < 80 * kDegree ? std::sin(theta) + 0.05 : 0.2;
    weights += weight;
    cumulative.push_back(cumulative.back() + std::cbrt(weight * (0.5 * (bend[j] + bend[j + 1]) + 0.3 * mean + 1e-5)));
  }
  if (!count)
    count = static_cast<size_t>(
        std::clamp(std::ceil(std::sqrt(std::pow(cumulative.back(), 3) / (8 * allowed * weights))) + 1, 9.0,
                   static_cast<double>(std::max<size_t>(most, 9))));
  std::vector<double> nodes;
  size_t j = 0;
  for (size_t n = 0; n < count; ++n) {
    const double target = cumulative.back() * static_cast<double>(n) / static_cast<double>(count - 1);
    while (j + 2 < kDense && cumulative[j + 1] < target) ++j;
    const double t = (target - cumulative[j]) / (cumulative[j + 1] - cumulative[j]);
    nodes.push_back(step * (static_cast<double>(j) + std::clamp(t, 0.0, 1.0)));
  }
  nodes.back() = last;
  // Whole units of 1e-7 rad (0.02 arc seconds), so that seven digits say all.
  for (double& theta : nodes) theta = std::round(1e7 * theta) / 1e7;
  return nodes;
}

}  // namespace suite::sqt
