#include "spectral/thermometer.h"

#include <algorithm>
#include <cmath>

#include "spectral/planck.h"

namespace suite {

namespace {

constexpr double kLowest = 10, kHighest = 20000, kThermometerStep = 1.0 / 64;  // K, K, of ln T
constexpr double kLeastRadiance = 1e-250;
constexpr double kWidest = 0.02;  // of a piece, relative to its wavelength

}  // namespace

BandThermometer::BandThermometer(const Band& band) {
  static constexpr double at[3] = {-0.7745966692414834, 0, 0.7745966692414834},
                          share[3] = {5.0 / 18, 8.0 / 18, 5.0 / 18};
  const std::vector<double>& x = band.response.wavelength_um();
  double sum = 0;
  for (size_t i = 0; i + 1 < x.size(); ++i) {
    const int pieces = 1 + static_cast<int>((x[i + 1] - x[i]) / (kWidest * x[i]));
    const double step = (x[i + 1] - x[i]) / pieces;
    for (int p = 0; p < pieces; ++p)
      for (int k = 0; k < 3; ++k) {
        const double w = x[i] + (p + 0.5 + 0.5 * at[k]) * step, weight = step * share[k] * band.response.at(w);
        if (weight > 0) nodes_.push_back({w, weight}), sum += weight;
      }
  }
  if (!(sum > 0)) throw Error("the band '" + band.name + "' responds nowhere");
  for (Node& n : nodes_) n.weight /= sum;
  const int steps = static_cast<int>(std::ceil(std::log(kHighest / kLowest) / kThermometerStep));
  for (int i = 0; i <= steps; ++i) {
    const double kelvin = kLowest * std::pow(kHighest / kLowest, static_cast<double>(i) / steps);
    double mean = 0, steep = 0;
    for (const Node& n : nodes_) {
      const double b = n.weight * planck_radiance(n.wavelength_um, kelvin);
      mean += b, steep += b * planck_steepness(n.wavelength_um, kelvin);
    }
    // d(1/T)/d(ln L) = -1/T^2 dT/d(ln L) = -(1/T) / (T dL/dT / L)
    if (mean > kLeastRadiance) rows_.push_back({std::log(mean), 1 / kelvin, -mean / (kelvin * steep)});
  }
  if (rows_.size() < 2) throw Error("the band '" + band.name + "' sees no blackbody below 20 000 K");
}

double BandThermometer::radiance(double kelvin) const {
  double mean = 0;
  for (const Node& n : nodes_) mean += n.weight * planck_radiance(n.wavelength_um, kelvin);
  return mean;
}

BandThermometer::Reading BandThermometer::read(double radiance) const {
  const double y = radiance > 0 ? std::log(radiance) : NAN;
  if (!(y >= rows_.front().logarithm && y <= rows_.back().logarithm)) return {NAN, NAN};
  auto above = std::upper_bound(rows_.begin(), rows_.end(), y, [](double v, const Row& r) { return v < r.logarithm; });
  if (above == rows_.end()) --above;
  const Row &a = *(above - 1), &b = *above;
  const double h = b.logarithm - a.logarithm, t = (y - a.logarithm) / h, s = 1 - t;
  const double inverse =
      s * s * (1 + 2 * t) * a.inverse + t * t * (1 + 2 * s) * b.inverse + s * t * h * (s * a.slope - t * b.slope);
  const double slope = 6 * s * t * (b.inverse - a.inverse) / h + s * (1 - 3 * t) * a.slope + t * (1 - 3 * s) * b.slope;
  return {1 / inverse, -slope / (inverse * inverse * radiance)};
}

}  // namespace suite
