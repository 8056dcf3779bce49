#include "air/refraction.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/error.h"
#include "math/vec.h"

namespace suite {

namespace {

// Gauss-Legendre with 8 points on -1..1, the positive half (M. Abramowitz, I. A. Stegun, 1964, table 25.4).
constexpr double kNode[] = {0.1834346424956498, 0.5255324099163290, 0.7966664774136267, 0.9602898564975363},
                 kWeight[] = {0.3626837833783620, 0.3137066458778873, 0.2223810344533745, 0.1012285362903763};

}  // namespace

double refractivity(double wavelength_um, double pressure, double temperature) {
  const double s = 1 / (wavelength_um * wavelength_um);
  // At 15 degrees C and 101325 Pa.
  return 1e-8 * (5792105 / (238.0185 - s) + 167917 / (57.362 - s)) * (pressure / 101325) * (288.15 / temperature);
}

Refraction::Refraction(double radius, std::vector<double> heights, std::vector<double> density, double per_density)
    : radius_(radius), heights_(std::move(heights)), density_(std::move(density)), per_density_(per_density) {
  if (heights_.size() < 2 || density_.size() != heights_.size())
    throw Error(strf("%zu heights and %zu densities of air", heights_.size(), density_.size()),
                "a density at each of two heights or more");
  if (!(radius_ > 0) || !(radius_ + heights_[0] > 0)) throw Error(strf("the Earth's radius is %g m", radius_));
  if (!(per_density_ >= 0)) throw Error("the refractivity of air is negative");
  for (size_t i = 0; i < heights_.size(); ++i) {
    if (!(density_[i] > 0) || !std::isfinite(density_[i]))
      throw Error(strf("the density of air at %g m is not positive: %g", heights_[i], density_[i]));
    if (i == 0) continue;
    if (!(heights_[i] > heights_[i - 1]) || !std::isfinite(heights_[i]))
      throw Error(strf("heights of the air are not ascending: %g m, then %g m", heights_[i - 1], heights_[i]));
    decay_.push_back(std::log(density_[i - 1] / density_[i]) / (heights_[i] - heights_[i - 1]));
    const Index low = at(i - 1, heights_[i - 1]);
    if (!(low.n + (radius_ + heights_[i - 1]) * low.slope > 0))
      throw Error(strf("above %g m the air thins out so fast that it leads light around the Earth", heights_[i - 1]),
                  "a smoother profile, or none of refraction");
  }
}

Refraction::Index Refraction::at(size_t l, double height) const {
  const double density = density_[l] * std::exp(-decay_[l] * (height - heights_[l]));
  return {density, 1 + per_density_ * density, -per_density_ * density * decay_[l]};
}

size_t Refraction::layer_of(double height) const {
  if (!(height >= heights_.front() && height < heights_.back()))
    throw Error(strf("a ray starts at %g m, outside the profile of the air", height),
                strf("it covers %g to %g m", heights_.front(), heights_.back()));
  return static_cast<size_t>(std::upper_bound(heights_.begin(), heights_.end(), height) - heights_.begin()) - 1;
}

double Refraction::rise(size_t l, double height, size_t from_layer, double from) const {
  const double n = at(l, height).n, n0 = at(from_layer, from).n, r0 = radius_ + from;
  const double difference = (height - from) * n + r0 * (n - n0);
  return difference * (difference + 2 * n0 * r0);
}

double Refraction::height_of(size_t l, double low, double gain) const {
  const double top = heights_[l + 1];
  double h = std::min(top, low + gain / (2 * (radius_ + low)));
  // Newton: (n r)^2 is smooth and rises.
  for (int i = 0; i < 20; ++i) {
    const Index x = at(l, h);
    const double r = radius_ + h, step = (gain - rise(l, h, l, low)) / (2 * x.n * r * (x.n + r * x.slope));
    h = std::clamp(h + step, low, top);
    if (std::fabs(step) < 1e-9) break;
  }
  return h;
}

Refraction::Sums Refraction::along(double constant, size_t l, double height, double q, double until) const {
  Sums sums;
  for (; l + 1 < heights_.size() && q < until; height = heights_[++l]) {
    const double q_top = std::sqrt(q * q + rise(l, heights_[l + 1], l, height)), end = std::min(q_top, until);
    const double mean = 0.5 * (q + end), half = 0.5 * (end - q);
    for (int i = 0; i < 8; ++i) {
      const double offset = i % 2 ? kNode[i / 2] : -kNode[i / 2], v = mean + half * offset;
      const double h = height_of(l, height, (v - q) * (v + q)), r = radius_ + h;
      const Index x = at(l, h);
      const double path = kWeight[i / 2] * half / (x.n + r * x.slope);
      sums.density += x.density * path;
      sums.bending -= x.slope / x.n * constant / (x.n * r) * path;
    }
    q = q_top;
  }
  return sums;
}

std::optional<Refraction::Ray> Refraction::ray(double height, double apparent_zenith) const {
  const size_t l = layer_of(height);
  const double inf = std::numeric_limits<double>::infinity(), nr = at(l, height).n * (radius_ + height);
  const double constant = nr * std::sin(apparent_zenith), q = nr * std::cos(apparent_zenith);
  const Sums above = along(constant, l, height, std::fabs(q), inf), vertical = along(0, l, height, nr, inf);
  Ray ray{above.density / vertical.density, above.bending, height};
  if (q >= 0) return ray;

  // Down to the height at which n r is the constant, and up from there to where it came from.
  size_t low = l;
  while (low > 0 && rise(low, heights_[low], l, height) + q * q > 0) --low;
  const double gain = -(rise(low, heights_[low], l, height) + q * q);
  if (gain < 0) return std::nullopt;
  ray.lowest_height = height_of(low, heights_[low], gain);
  const Sums below = along(constant, low, ray.lowest_height, 0, std::fabs(q));
  ray.air_mass += 2 * below.density / vertical.density;
  ray.bending += 2 * below.bending;
  return ray;
}

double Refraction::horizon(double height) const {
  const size_t l = layer_of(height);
  const double fall = rise(l, height, 0, heights_[0]), nr = at(l, height).n * (radius_ + height);
  return kPi - std::atan2(std::sqrt(nr * nr - fall), std::sqrt(fall));
}

std::optional<double> Refraction::apparent_zenith(double height, double true_zenith) const {
  const auto bending = [&](double apparent) {
    const std::optional<Ray> r = ray(height, apparent);
    return r ? r->bending : kPi;
  };
  // Up to the horizon, just above which rays still come from outside.
  double low = 0, high = std::nextafter(horizon(height), 0);
  if (!(true_zenith >= 0) || high + bending(high) < true_zenith) return std::nullopt;
  // Bending grows with the angle, by less than it.
  double a = std::min(true_zenith, high);
  for (int i = 0; i < 60; ++i) {
    const double off = a + bending(a) - true_zenith;
    if (std::fabs(off) < 1e-12) break;
    (off > 0 ? high : low) = a;
    const double next = a - off / 1.3;
    a = next > low && next < high ? next : 0.5 * (low + high);
  }
  return a;
}

}  // namespace suite
