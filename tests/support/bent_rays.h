// Bent rays through round air by quadratures of n r sin(theta), which share nothing with the tables of libs/air but the
// layers.
#pragma once
#include <algorithm>
#include <cmath>
#include <vector>

#include "air/column.h"
#include "air/refraction.h"

namespace suite::test {

constexpr double kBentRadius = 6371e3;  // m

// Rays that come from far away and pass above a place, by their lowest points. Layers of even extinction, n - 1
// exponential between their bounds; along the ray h = lowest + u^2, Gauss's 8 points in u between the bounds.
class Bent {
 public:
  Bent(std::vector<double> heights, std::vector<double> refractivity, std::vector<std::vector<double>> extinction)
      : heights_(std::move(heights)), refractivity_(std::move(refractivity)), extinction_(std::move(extinction)) {
    for (size_t l = 0; l + 1 < heights_.size(); ++l)
      decay_.push_back(std::log(refractivity_[l] / refractivity_[l + 1]) / (heights_[l + 1] - heights_[l]));
  }

  struct Sums {
    double bending = 0;
    std::vector<double> depth;  // per bin
  };
  // n r at a height, and -n'/n.
  struct Index {
    double nr, fall;
  };
  Index at(double height) const { return at(height, layer(height)); }
  // From the lowest point of a ray up to a height.
  void add(double lowest, double height, double times, Sums& to) const {
    static constexpr double node[] = {0.1834346424956498, 0.5255324099163290, 0.7966664774136267, 0.9602898564975363},
                            weight[] = {0.3626837833783620, 0.3137066458778873, 0.2223810344533745, 0.1012285362903763};
    const double constant = at(lowest).nr;
    for (size_t l = layer(lowest); l + 1 < heights_.size() && heights_[l] < height; ++l) {
      const double a = std::sqrt(std::max(heights_[l], lowest) - lowest),
                   b = std::sqrt(std::min(heights_[l + 1], height) - lowest);
      double way = 0;
      for (int i = 0; i < 8; ++i) {
        const double u = 0.5 * (a + b) + 0.5 * (b - a) * (i % 2 ? node[i / 2] : -node[i / 2]);
        const Index here = at(lowest + u * u, l);
        const double sine = constant / here.nr,
                     cosine = std::sqrt((here.nr - constant) * (here.nr + constant)) / here.nr;
        const double step = times * weight[i / 2] * (b - a) * u / cosine;  // ds, with dh = 2 u du
        way += step;
        to.bending += here.fall * sine * step;
      }
      for (size_t bin = 0; bin < to.depth.size(); ++bin) to.depth[bin] += way * extinction_[bin][l];
    }
  }
  // Up to a place, from beyond its lowest point.
  Sums along(double lowest, double height, size_t bins) const {
    Sums sums{0, std::vector<double>(bins)};
    add(lowest, heights_.back(), 1, sums);
    add(lowest, height, 1, sums);
    return sums;
  }
  // The true zenith angle, at the place, of where the ray comes from.
  double zenith(double lowest, double height) const {
    return kPi - std::asin(std::min(1.0, at(lowest).nr / at(height).nr)) + along(lowest, height, 0).bending;
  }
  // Of the ray that comes from a true zenith angle; below 0 = the Earth is in its way.
  double lowest(double height, double true_zenith) const {
    if (zenith(0, height) < true_zenith) return -1;
    double low = 0, high = height;
    for (int i = 0; i < 36; ++i) (zenith(0.5 * (low + high), height) > true_zenith ? low : high) = 0.5 * (low + high);
    return 0.5 * (low + high);
  }
  const std::vector<double>& heights() const { return heights_; }
  double extinction(size_t bin, size_t l) const { return extinction_[bin][l]; }

 private:
  Index at(double height, size_t l) const {
    const double n = 1 + refractivity_[l] * std::exp(-decay_[l] * (height - heights_[l]));
    return {n * (kBentRadius + height), decay_[l] * (n - 1) / n};
  }
  size_t layer(double height) const {
    const auto next = std::upper_bound(heights_.begin() + 1, heights_.end() - 1, height);
    return static_cast<size_t>(next - heights_.begin()) - 1;
  }
  std::vector<double> heights_, refractivity_, decay_;
  std::vector<std::vector<double>> extinction_;  // [bin][layer], 1/m
};

inline Bent bent_of(const AirSpec& air, const SpectralState& state, bool straight = false) {
  const AirColumn column = bake_column(air, state);
  std::vector<double> n;
  for (const AirLevel& l : air_levels(air))
    n.push_back((straight ? 1e-9 : 1) * refractivity(state.reference_um, l.pressure, l.temperature));
  std::vector<std::vector<double>> extinction(state.size());
  for (size_t i = 0; i < state.size(); ++i)
    for (size_t l = 0; l < column.layers(); ++l) extinction[i].push_back(column.extinction[l * state.size() + i]);
  return {{column.shells.heights().begin(), column.shells.heights().end()}, n, extinction};
}

}  // namespace suite::test
