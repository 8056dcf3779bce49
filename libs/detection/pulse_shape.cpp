#include "detection/pulse_shape.h"

#include <algorithm>
#include <cmath>

#include "math/vec.h"

namespace suite {

namespace {

constexpr double kReach = 7.1;  // deviations of a Gaussian beyond which lie less than 1e-12

double normal_before(double x) { return 0.5 * std::erfc(-x / std::sqrt(2.0)); }
double normal_density(double x) { return std::exp(-0.5 * x * x) / std::sqrt(2 * kPi); }

}  // namespace

PulseShape PulseShape::impulse() { return {}; }

PulseShape PulseShape::gaussian(double fwhm) {
  SUITE_CHECK(fwhm > 0);
  PulseShape p;
  p.kind_ = Kind::gaussian;
  p.deviation_ = fwhm / kFwhmOfDeviation;
  p.high_ = kReach * p.deviation_, p.low_ = -p.high_;
  return p;
}

PulseShape PulseShape::rectangular(double length) {
  SUITE_CHECK(length > 0);
  PulseShape p;
  p.kind_ = Kind::rectangular;
  p.deviation_ = length / std::sqrt(12.0);
  p.high_ = length / 2, p.low_ = -p.high_;
  return p;
}

PulseShape PulseShape::table(std::vector<double> time, std::vector<double> power, const Where& where) {
  if (time.size() < 2 || time.size() != power.size())
    throw Error(where, strf("a pulse of %zu times and %zu values", time.size(), power.size()), "at least two of each");
  PulseShape p;
  p.kind_ = Kind::table;
  p.time_ = std::move(time), p.power_ = std::move(power);
  p.sum_.assign(p.time_.size(), 0);
  double first = 0, second = 0;
  for (double& v : p.power_) v = std::isfinite(v) ? std::max(v, 0.0) : v;
  for (size_t k = 0; k < p.time_.size(); ++k)
    if (!std::isfinite(p.time_[k]) || !std::isfinite(p.power_[k]) || (k && !(p.time_[k] > p.time_[k - 1])))
      throw Error(where, strf("value %zu of a pulse: time %g, power %g", k, p.time_[k], p.power_[k]),
                  "finite, times ascending");
  // Moments of each straight piece: exact by Simpson's rule for t * power, and by Gauss's for t^2 * power.
  for (size_t k = 1; k < p.time_.size(); ++k) {
    const double a = p.time_[k - 1], h = p.time_[k] - a, y0 = p.power_[k - 1], y1 = p.power_[k];
    p.sum_[k] = p.sum_[k - 1] + 0.5 * h * (y0 + y1);
    for (const double g : {-std::sqrt(0.6), 0.0, std::sqrt(0.6)}) {
      const double s = 0.5 * (1 + g), t = a + s * h, y = y0 + s * (y1 - y0), w = (g == 0 ? 8.0 : 5.0) / 18 * h;
      first += w * t * y, second += w * t * t * y;
    }
  }
  const double all = p.sum_.back();
  if (!(all > 0) || !std::isfinite(all)) throw Error(where, "a pulse without energy", "at least one value above 0");
  const double centroid = first / all;
  p.deviation_ = std::sqrt(std::max(0.0, second / all - centroid * centroid));
  for (double& t : p.time_) t -= centroid;
  for (double& v : p.power_) v /= all;
  for (double& v : p.sum_) v /= all;
  p.low_ = p.time_.front(), p.high_ = p.time_.back();
  return p;
}

double PulseShape::power(double t) const {
  if (kind_ == Kind::gaussian) return normal_density(t / deviation_) / deviation_;
  if (t < low_ || t > high_) return 0;
  if (kind_ == Kind::rectangular) return 1 / (high_ - low_);
  const auto next = std::min<size_t>(
      static_cast<size_t>(std::upper_bound(time_.begin(), time_.end(), t) - time_.begin()), time_.size() - 1);
  const size_t k = std::max<size_t>(next, 1);
  return power_[k - 1] + (t - time_[k - 1]) / (time_[k] - time_[k - 1]) * (power_[k] - power_[k - 1]);
}

double PulseShape::before(double t) const {
  switch (kind_) {
    case Kind::impulse:
      return t > 0 ? 1 : 0;
    case Kind::gaussian:
      return normal_before(t / deviation_);
    case Kind::rectangular:
      return std::clamp((t - low_) / (high_ - low_), 0.0, 1.0);
    case Kind::table:
      break;
  }
  if (t <= low_) return 0;
  if (t >= high_) return 1;
  const auto k = static_cast<size_t>(std::upper_bound(time_.begin(), time_.end(), t) - time_.begin());
  return sum_[k - 1] + 0.5 * (t - time_[k - 1]) * (power_[k - 1] + power(t));
}

double PulseShape::fwhm() const {
  if (kind_ == Kind::impulse) return 0;
  if (kind_ == Kind::gaussian) return kFwhmOfDeviation * deviation_;
  if (kind_ == Kind::rectangular) return high_ - low_;
  const auto top = std::max_element(power_.begin(), power_.end());
  const double half = *top / 2;
  auto k = static_cast<size_t>(top - power_.begin());
  const auto crossing = [&](size_t a, size_t b) {  // between knots a (above half) and b (below)
    return time_[a] + (time_[b] - time_[a]) * (power_[a] - half) / (power_[a] - power_[b]);
  };
  size_t left = k, right = k;
  while (left > 0 && power_[left] > half) --left;
  while (right + 1 < power_.size() && power_[right] > half) ++right;
  const double begin = power_[left] > half ? time_[left] : crossing(left + 1, left),
               end = power_[right] > half ? time_[right] : crossing(right - 1, right);
  return end - begin;
}

// A piece y = m + n s of the power against a Gaussian about t: the integrals of the normal density and of s times it.
double PulseShape::blurred(double t, double sigma) const {
  double sum = 0;
  const auto piece = [&](double a, double b, double ya, double yb) {
    const double u = (a - t) / sigma, v = (b - t) / sigma;
    if (v < -kReach || u > kReach) return;
    const double n = (yb - ya) / (b - a), at_t = ya + n * (t - a);
    sum += at_t * (normal_before(v) - normal_before(u)) - n * sigma * (normal_density(v) - normal_density(u));
  };
  if (kind_ == Kind::rectangular) piece(low_, high_, power(0), power(0));
  for (size_t k = 1; k < time_.size(); ++k) piece(time_[k - 1], time_[k], power_[k - 1], power_[k]);
  return sum;
}

PulseShape PulseShape::through(double receiver_fwhm) const {
  if (!(receiver_fwhm > 0)) return *this;
  if (kind_ == Kind::impulse) return gaussian(receiver_fwhm);
  if (kind_ == Kind::gaussian) return gaussian(std::hypot(fwhm(), receiver_fwhm));
  const double sigma = receiver_fwhm / kFwhmOfDeviation, begin = low_ - kReach * sigma, end = high_ + kReach * sigma;
  const double wanted = std::min(receiver_fwhm, fwhm()) / 20;
  const size_t steps = static_cast<size_t>(std::clamp((end - begin) / wanted, 64.0, 20000.0));
  std::vector<double> time, power;
  for (size_t k = 0; k <= steps; ++k) {
    time.push_back(begin + (end - begin) * static_cast<double>(k) / static_cast<double>(steps));
    power.push_back(blurred(time.back(), sigma));
  }
  return table(std::move(time), std::move(power));
}

}  // namespace suite
