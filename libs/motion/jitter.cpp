#include "motion/jitter.h"

#include <algorithm>
#include <functional>

#include "base/error.h"
#include "math/sampling.h"

namespace suite {

namespace {

// Interpolates inside segment i of the table.
double between(const Psd& p, size_t i, double f) {
  const double f0 = p.frequency[i], f1 = p.frequency[i + 1], s0 = p.density[i], s1 = p.density[i + 1];
  if (p.between == Psd::Between::linear) return s0 + (s1 - s0) * (f - f0) / (f1 - f0);
  return s0 * std::exp(std::log(s1 / s0) * std::log(f / f0) / std::log(f1 / f0));
}

// Integral of S(f) g(f) from `low` to `high`, by three-point Gauss-Legendre on pieces short against the table's bends
// and against `ripple`, the scale on which g changes (Hz).
double integral(const Psd& p, double low, double high, double ripple, const std::function<double(double)>& g) {
  constexpr double kNode = 0.77459666924148338;  // sqrt(3/5)
  double sum = 0;
  for (size_t i = 0; i + 1 < p.frequency.size(); ++i) {
    const double f0 = std::fmax(p.frequency[i], low), f1 = std::fmin(p.frequency[i + 1], high);
    for (double a = f0; a < f1;) {
      // A sixteenth of the segment, of an octave where S is a power law, and no more than the ripple.
      double b = a + std::fmin((f1 - f0) / 16, ripple);
      if (p.between == Psd::Between::log_log) b = std::fmin(b, a * std::exp2(0.0625));
      if (f1 - b < 1e-9 * (f1 - f0)) b = f1;
      const double m = (a + b) / 2, h = (b - a) / 2;
      auto value = [&](double f) { return between(p, i, f) * g(f); };
      sum += h / 9 * (5 * value(m - kNode * h) + 8 * value(m) + 5 * value(m + kNode * h));
      a = b;
    }
  }
  return sum;
}

double sinc2(double x) {
  if (std::fabs(x) < 1e-8) return 1;
  const double s = std::sin(kPi * x) / (kPi * x);
  return s * s;
}

// Integral of S sinc^2(f T): pieces of a quarter of the lobes up to the thousandth lobe, above it the lobes' mean,
// 1 / (2 (pi f T)^2), whose share is below 1e-7 of S.
double exposed(const Psd& psd, double exposure) {
  psd.check();
  if (!(exposure >= 0 && std::isfinite(exposure))) throw Error(strf("an exposure of %g s", exposure), "0 or more");
  if (exposure == 0) return psd.variance();
  const double edge = 1000 / exposure;
  return integral(psd, 0, edge, 0.25 / exposure, [&](double f) { return sinc2(f * exposure); }) +
         integral(psd, edge, INFINITY, INFINITY,
                  [&](double f) { return 0.5 / (kPi * kPi * f * f * exposure * exposure); });
}

}  // namespace

void Psd::check() const {
  if (frequency.size() != density.size())
    throw Error(strf("a power spectral density has %zu frequencies and %zu values", frequency.size(), density.size()));
  if (frequency.size() < 2) throw Error("a power spectral density needs at least two points");
  double largest = 0;
  for (size_t i = 0; i < frequency.size(); ++i) {
    if (!(frequency[i] >= 0 && std::isfinite(frequency[i])) || (i > 0 && !(frequency[i] > frequency[i - 1])))
      throw Error(strf("frequency %g Hz of a power spectral density is out of order", frequency[i]),
                  "0 or more, ascending");
    if (!(density[i] >= 0 && std::isfinite(density[i])))
      throw Error(strf("the value %g of a power spectral density is outside its range", density[i]), "0 or more");
    if (between == Between::log_log && !(frequency[i] > 0 && density[i] > 0))
      throw Error(strf("a power spectral density with the point (%g Hz, %g) cannot be joined by power laws",
                       frequency[i], density[i]),
                  "give positive points, or linear interpolation");
    largest = std::fmax(largest, density[i]);
  }
  if (!(largest > 0)) throw Error("a power spectral density is zero everywhere", "leave the axis out instead");
}

double Psd::at(double f) const {
  if (!(f >= frequency.front() && f <= frequency.back())) return 0;
  const auto after = std::upper_bound(frequency.begin(), frequency.end(), f);
  const size_t i = std::min<size_t>(static_cast<size_t>(after - frequency.begin()), frequency.size() - 1) - 1;
  return suite::between(*this, i, f);
}

double Psd::variance() const {
  return integral(*this, 0, INFINITY, INFINITY, [](double) { return 1.0; });
}

double frame_to_frame_variance(const Psd& psd, double exposure) { return exposed(psd, exposure); }
double in_frame_variance(const Psd& psd, double exposure) {
  // Not by subtraction from the variance where that would cancel: 1 - sinc^2 ~ (pi f T)^2 / 3 for short exposures.
  psd.check();
  if (exposure * psd.frequency.back() > 0.25) return psd.variance() - exposed(psd, exposure);
  return integral(psd, 0, INFINITY, INFINITY, [&](double f) {
    const double x = kPi * f * exposure, x2 = x * x;
    // 1 - (sin x / x)^2 as its series; the next term is below 1e-9 of the first for x < 0.8.
    return x2 / 3 * (1 - x2 * (2.0 / 15) * (1 - x2 * (1.0 / 14) * (1 - x2 * (2.0 / 45) * (1 - x2 / 33))));
  });
}

namespace {

// The spectral distribution of an axis' waves: half by variance, half even in log f, as a fine cumulative table.
struct Spread {
  std::vector<double> f, cumulative;
  double variance, octaves;  // natural logarithm of the ratio of the outer frequencies

  explicit Spread(const Psd& psd) : variance(psd.variance()) {
    // From the lowest frequency, or where that is 0 from a thousandth of the second: slower drifts are an offset.
    const double lowest = psd.frequency[0] > 0 ? psd.frequency[0] : psd.frequency[1] * 1e-3;
    octaves = std::log(psd.frequency.back() / lowest);
    if (psd.frequency[0] < lowest) f.push_back(psd.frequency[0]);
    for (size_t i = 0; i + 1 < psd.frequency.size(); ++i) {
      const double f0 = std::fmax(psd.frequency[i], lowest), f1 = psd.frequency[i + 1];
      const int pieces = std::clamp(static_cast<int>(64 * std::log2(f1 / f0)), 32, 2048);
      for (int k = 0; k < pieces; ++k) f.push_back(f0 * std::pow(f1 / f0, static_cast<double>(k) / pieces));
    }
    f.push_back(psd.frequency.back());
    cumulative.push_back(0);
    for (size_t i = 0; i + 1 < f.size(); ++i) {
      const double mid = (f[i] + f[i + 1]) / 2, width = f[i + 1] - f[i];
      const double share = (psd.at(f[i]) + 4 * psd.at(mid) + psd.at(f[i + 1])) / 6 * width / variance;
      const double even = f[i] > 0 ? std::log(f[i + 1] / f[i]) / octaves : 0;
      cumulative.push_back(cumulative.back() + 0.5 * (share + even));
    }
  }
  double density(const Psd& psd, double at) const {
    const double even = at >= f.back() * std::exp(-octaves) ? 1 / (at * octaves) : 0;
    return 0.5 * (psd.at(at) / variance + even);
  }
  double frequency_at(double u) const {
    const double target = u * cumulative.back();
    const auto after = std::upper_bound(cumulative.begin(), cumulative.end(), target);
    const size_t i = std::clamp<size_t>(static_cast<size_t>(after - cumulative.begin()), 1, f.size() - 1) - 1;
    const double width = cumulative[i + 1] - cumulative[i];
    return f[i] + (f[i + 1] - f[i]) * (width > 0 ? (target - cumulative[i]) / width : 0.5);
  }
};

}  // namespace

Jitter::Jitter(const std::array<AxisJitter, 6>& axes, uint64_t seed, int components) : axes_(axes), seed_(seed) {
  if (components < 16 || components > 4096) throw Error(strf("jitter of %d components", components), "16 to 4096");
  for (int axis = 0; axis < 6; ++axis) {
    const AxisJitter& a = axes_[axis];
    if (!std::isfinite(a.mean)) throw Error("a mean of jitter is not finite");
    if (a.kind == AxisJitter::Kind::white && !(a.sigma >= 0 && std::isfinite(a.sigma)))
      throw Error(strf("jitter of standard deviation %g", a.sigma), "0 or more");
    if (a.kind != AxisJitter::Kind::psd) continue;
    a.psd.check();
    const Spread spread(a.psd);
    for (int k = 0; k < components; ++k) {
      const uint64_t key = hash_of(seed, 0x6a697474ull, static_cast<uint64_t>(axis), static_cast<uint64_t>(k));
      const double f = spread.frequency_at((k + unit_double(key)) / components);
      const double share = a.psd.at(f) / (components * spread.density(a.psd, f));  // of the variance
      if (share > 0) waves_[axis].push_back({std::sqrt(2 * share), 2 * kPi * f, 2 * kPi * unit_double(mix64(key))});
    }
  }
}

double Jitter::white(int axis, double t) const {
  const double second = std::floor(t);
  const uint64_t tick = static_cast<uint64_t>((t - second) * 1e9);
  const uint64_t key = hash_of(hash_of(seed_, 0x77686974ull, static_cast<uint64_t>(axis)),
                               static_cast<uint64_t>(static_cast<int64_t>(second)), tick);
  // Box & Muller 1958; 1 - u is never 0.
  return std::sqrt(-2 * std::log(1 - unit_double(key))) * std::cos(2 * kPi * unit_double(mix64(key)));
}

std::array<double, 6> Jitter::at(double t) const {
  std::array<double, 6> x{};
  for (int axis = 0; axis < 6; ++axis) {
    const AxisJitter& a = axes_[axis];
    if (a.kind == AxisJitter::Kind::none) continue;
    x[axis] = a.mean;
    if (a.kind == AxisJitter::Kind::white) x[axis] += a.sigma * white(axis, t);
    for (const Wave& w : waves_[axis]) x[axis] += w.amplitude * std::cos(w.rate * t + w.phase);
  }
  return x;
}

bool Jitter::still() const {
  return std::all_of(axes_.begin(), axes_.end(), [](const AxisJitter& a) { return a.kind == AxisJitter::Kind::none; });
}

namespace {
Pose pose_of(const std::array<double, 6>& x) {
  const Vec3 turn{x[3], x[4], x[5]};
  const double angle = length(turn);
  return {angle > 0 ? quat_about(turn / angle, angle) : Quat{}, {x[0], x[1], x[2]}};
}
}  // namespace

Pose Jitter::pose(double t) const { return pose_of(at(t)); }

JitterWindow::JitterWindow(const Jitter& jitter, TimeSpan window) : jitter_(jitter), window_(window) {
  constexpr double kPerPeriod = 24, kMost = 4e6;
  for (int axis = 0; axis < 6; ++axis) {
    double fastest = 0;
    for (const Jitter::Wave& w : jitter.waves_[axis]) fastest = std::fmax(fastest, w.rate);
    const double points = (window.end - window.begin) * fastest / (2 * kPi) * kPerPeriod;
    if (!(fastest > 0) || !(points <= kMost)) continue;
    Table& table = tables_[axis];
    const size_t n = static_cast<size_t>(points) + 2;
    table.step = (window.end - window.begin) / static_cast<double>(n - 1);
    table.value.resize(n);
    table.slope.resize(n);
    for (size_t i = 0; i < n; ++i) {
      const double t = window.begin + table.step * static_cast<double>(i);
      for (const Jitter::Wave& w : jitter.waves_[axis]) {
        table.value[i] += w.amplitude * std::cos(w.rate * t + w.phase);
        table.slope[i] -= w.amplitude * w.rate * std::sin(w.rate * t + w.phase);
      }
    }
  }
}

std::array<double, 6> JitterWindow::at(double t) const {
  if (!window_.contains(t)) return jitter_.at(t);
  std::array<double, 6> x{};
  for (int axis = 0; axis < 6; ++axis) {
    const AxisJitter& a = jitter_.axes_[axis];
    const Table& table = tables_[axis];
    if (a.kind == AxisJitter::Kind::none) continue;
    x[axis] = a.mean;
    if (a.kind == AxisJitter::Kind::white) x[axis] += a.sigma * jitter_.white(axis, t);
    if (table.value.empty() || !(table.step > 0)) {
      for (const Jitter::Wave& w : jitter_.waves_[axis]) x[axis] += w.amplitude * std::cos(w.rate * t + w.phase);
      continue;
    }
    const double place = (t - window_.begin) / table.step;
    const size_t i = std::min(static_cast<size_t>(place), table.value.size() - 2);
    const double s = place - static_cast<double>(i), r = 1 - s;
    x[axis] += r * r * ((1 + 2 * s) * table.value[i] + s * table.step * table.slope[i]) +
               s * s * ((3 - 2 * s) * table.value[i + 1] - r * table.step * table.slope[i + 1]);
  }
  return x;
}

Pose JitterWindow::pose(double t) const { return pose_of(at(t)); }

}  // namespace suite
