#include "air/phase_grid.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "base/error.h"
#include "math/vec.h"

namespace suite {

namespace {

constexpr int kBetween = 3;  // angles of the grid per stored one

// Degrees: closest in the diffraction peak of drops, close over the rainbows and the glory.
std::vector<double> stored_angles() {
  struct Stretch {
    double to, step;
  };
  constexpr Stretch stretches[] = {{0.3, 0.05}, {0.7, 0.1}, {1, 0.15}, {2, 0.2}, {3, 0.25}, {5, 0.5},  {10, 1},
                                   {20, 2},     {120, 2.5}, {160, 1},  {170, 2}, {178, 1},  {180, 0.5}};
  std::vector<double> angles = {0};
  for (const Stretch& s : stretches) {
    const double from = angles.back();
    const int n = static_cast<int>(std::lround((s.to - from) / s.step));
    for (int i = 1; i <= n; ++i) angles.push_back(from + (s.to - from) * i / n);
  }
  return angles;
}

std::vector<double> cosines_of(const std::vector<double>& angles) {
  std::vector<double> cosines;
  for (size_t i = angles.size(); i-- > 0;) cosines.push_back(std::cos(angles[i] * kDegree));
  cosines.front() = -1;
  cosines.back() = 1;
  return cosines;
}

// As the stored ones, with two between any two.
std::vector<double> all_angles() {
  const std::vector<double> stored = stored_angles();
  std::vector<double> angles;
  for (size_t i = 0; i + 1 < stored.size(); ++i)
    for (int k = 0; k < kBetween; ++k) angles.push_back(stored[i] + (stored[i + 1] - stored[i]) * k / kBetween);
  angles.push_back(180);
  return angles;
}

const std::vector<double>& all_cosines() {
  static const std::vector<double> cosines = cosines_of(all_angles());
  return cosines;
}

// The last angle of the grid (counted by ascending cosine) that lies below each of many places, even in the sine of
// half the angle, in which the peak is as wide as the rest: a search begins there.
class Beginnings {
 public:
  static size_t of(double cosine) {
    static const Beginnings all;
    return all.below_[place(cosine)];
  }

 private:
  static constexpr size_t kPlaces = 2048;
  static size_t place(double cosine) {
    return static_cast<size_t>(std::sqrt(std::clamp(0.5 - 0.5 * cosine, 0.0, 1.0)) * (kPlaces - 1));
  }
  Beginnings() {
    const std::vector<double>& c = all_cosines();
    for (size_t i = 0; i < kPlaces; ++i) {
      const double s = static_cast<double>(i + 1) / (kPlaces - 1);  // where the place ends: its least cosine
      const size_t above = static_cast<size_t>(std::upper_bound(c.begin(), c.end(), 1 - 2 * s * s) - c.begin());
      below_[i] = static_cast<uint16_t>(std::clamp<size_t>(above, 1, c.size() - 1) - 1);
    }
  }
  std::array<uint16_t, kPlaces> below_;
};

}  // namespace

std::span<const double> phase_cosines() { return all_cosines(); }

PhasePlace phase_place(double cosine) {
  const std::vector<double>& c = all_cosines();
  size_t i = Beginnings::of(cosine);
  while (i > 0 && c[i] > cosine) --i;
  while (i + 2 < c.size() && c[i + 1] <= cosine) ++i;
  return {i, std::clamp((cosine - c[i]) / (c[i + 1] - c[i]), 0.0, 1.0)};
}

std::span<const double> stored_cosines() {
  static const std::vector<double> cosines = cosines_of(stored_angles());
  return cosines;
}

double phase_integral(std::span<const double> values) {
  const std::vector<double>& c = all_cosines();
  double sum = 0;
  for (size_t i = 1; i < c.size(); ++i) sum += kPi * (values[i - 1] + values[i]) * (c[i] - c[i - 1]);
  return sum;
}

namespace {

// What the value at each angle counts in each moment, [moment][angle].
std::vector<double> moment_weights(size_t count) {
  const std::vector<double>& c = all_cosines();
  // By parts: the integral of P_l p over the cosine is minus that of Q_l p', Q_l = (P_(l+1) - P_(l-1)) / (2l + 1),
  // which ends at 0; p' is constant between the angles, and the integral of Q_l follows from the same rule once more.
  std::vector<double> weights(count * c.size(), 0), p(count + 3), before(count + 1, 0), now(count + 1, 0);
  for (size_t i = 0; i < c.size(); ++i) {
    p[0] = 1;
    p[1] = c[i];
    for (size_t l = 1; l + 1 < p.size(); ++l) {
      const double n = static_cast<double>(l);
      p[l + 1] = ((2 * n + 1) * c[i] * p[l] - n * p[l - 1]) / (n + 1);
    }
    auto q = [&](size_t l) { return (p[l + 1] - p[l - 1]) / (2 * static_cast<double>(l) + 1); };
    for (size_t l = 1; l < count; ++l)
      now[l] = (q(l + 1) - (l > 1 ? q(l - 1) : c[i])) / (2 * static_cast<double>(l) + 1);
    for (size_t l = 0; i > 0 && l < count; ++l) {
      const double step = c[i] - c[i - 1], slope = l > 0 ? -2 * kPi * (now[l] - before[l]) / step : 0;
      double* row = &weights[l * c.size() + i];
      row[0] += l > 0 ? slope : kPi * step;
      row[-1] += l > 0 ? -slope : kPi * step;
    }
    std::swap(before, now);
  }
  return weights;
}

}  // namespace

std::vector<double> legendre_moments(std::span<const float> values, size_t count) {
  SUITE_CHECK(values.size() == all_cosines().size());
  // Enough for 64 streams; who wants more waits for weights of his own.
  constexpr size_t kKept = 130;
  static const std::vector<double> kept = moment_weights(kKept);
  const std::vector<double> own = count > kKept ? moment_weights(count) : std::vector<double>();
  const double* weight = count > kKept ? own.data() : kept.data();
  std::vector<double> moments(count, 0);
  for (double& moment : moments)
    for (const float value : values) moment += *weight++ * static_cast<double>(value);
  return moments;
}

std::vector<double> refined(std::span<const double> values) {
  static const std::vector<double> angle = stored_angles();
  SUITE_CHECK(values.size() == angle.size());
  const size_t n = angle.size();
  // Ascending angle here, ascending cosine outside.
  auto value = [&](size_t i) { return values[n - 1 - i]; };
  auto slope = [&](size_t i) {
    // At 0 and 180 degrees a phase function is even in the angle.
    if (i == 0 || i + 1 == n) return 0.0;
    const double left = angle[i] - angle[i - 1], right = angle[i + 1] - angle[i];
    return ((value(i) - value(i - 1)) / left * right + (value(i + 1) - value(i)) / right * left) / (left + right);
  };
  std::vector<double> fine;
  for (size_t i = 0; i + 1 < n; ++i) {
    const double h = angle[i + 1] - angle[i], a = slope(i) * h, b = slope(i + 1) * h, d = value(i + 1) - value(i);
    for (int k = 0; k < kBetween; ++k) {
      const double t = static_cast<double>(k) / kBetween;
      fine.push_back(value(i) + t * (a + t * (3 * d - 2 * a - b + t * (a + b - 2 * d))));
    }
  }
  fine.push_back(value(n - 1));
  std::reverse(fine.begin(), fine.end());
  return fine;
}

std::vector<double> refined_phase(std::span<const double> log_values) {
  std::vector<double> fine = refined(log_values);
  for (double& f : fine) f = std::exp(f);
  const double whole = phase_integral(fine);
  for (double& f : fine) f /= whole;
  return fine;
}

std::vector<PlaneBlocks> refined_matrices(std::span<const PlaneBlocks> over_first) {
  const auto element = [&](double PlaneBlocks::*of) {
    std::vector<double> stored;
    for (const PlaneBlocks& m : over_first) stored.push_back(m.*of);
    return refined(stored);
  };
  const std::vector<double> b = element(&PlaneBlocks::b), c = element(&PlaneBlocks::c), d = element(&PlaneBlocks::d);
  std::vector<PlaneBlocks> fine;
  for (size_t i = 0; i < b.size(); ++i) {
    const double keep = 1 / std::max(1.0, std::hypot(b[i], c[i], d[i]));
    fine.push_back(PlaneBlocks::of(1, keep * b[i], keep * c[i], keep * d[i]));
  }
  return fine;
}

}  // namespace suite
