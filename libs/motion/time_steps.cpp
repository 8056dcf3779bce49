// How finely a motion must be cut so that linear interpolation of its matrices stays close to it.
//
// Based on: the equivalence of |A x| <= s(A) |x|, s the largest singular value, so that a point at distance r from the
// body's origin errs by at most |db| + r s(dA); the eigenvalues of a symmetric 3 x 3 matrix after O. K. Smith,
// "Eigenvalues of a symmetric 3 x 3 matrix", Comm. ACM 4(4), 1961.
#include <algorithm>

#include "base/error.h"
#include "motion/track.h"

namespace suite {

namespace {

constexpr size_t kMostSteps = 1000001;

// Largest singular value of a 3 x 3 matrix.
double largest_stretch(const std::array<double, 9>& a) {
  double m[3][3];
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) m[i][j] = a[i] * a[j] + a[3 + i] * a[3 + j] + a[6 + i] * a[6 + j];
  const double mean = (m[0][0] + m[1][1] + m[2][2]) / 3;
  const double off = m[0][1] * m[0][1] + m[0][2] * m[0][2] + m[1][2] * m[1][2];
  const double d0 = m[0][0] - mean, d1 = m[1][1] - mean, d2 = m[2][2] - mean;
  const double p = std::sqrt((d0 * d0 + d1 * d1 + d2 * d2 + 2 * off) / 6);
  if (!(p > 1e-12 * mean)) return std::sqrt(mean);
  const double det = d0 * (d1 * d2 - m[1][2] * m[1][2]) - m[0][1] * (m[0][1] * d2 - m[1][2] * m[0][2]) +
                     m[0][2] * (m[0][1] * m[1][2] - d1 * m[0][2]);
  const double angle = std::acos(std::clamp(det / (2 * p * p * p), -1.0, 1.0)) / 3;
  return std::sqrt(std::fmax(0.0, mean + 2 * p * std::cos(angle)));
}

// How far a point within `radius` may be from its true place when `t` is interpolated between two keys.
double deviation(const Affine3& truth, const Affine3& a, const Affine3& b, double s, double radius) {
  std::array<double, 9> d;
  for (int i = 0; i < 9; ++i) d[i] = a.a[i] * (1 - s) + b.a[i] * s - truth.a[i];
  return length(a.b * (1 - s) + b.b * s - truth.b) + radius * largest_stretch(d);
}

// The largest error found with that many keys (1: the pose at the start throughout); stops early above `bound`.
double blend_error(const MovingFrame& frame, std::span<const double> kinks, TimeSpan window, size_t steps,
                   double radius, double bound) {
  std::vector<Affine3> keys = time_keys(frame, window, steps);
  if (steps == 1) keys.push_back(keys[0]);
  const size_t segments = keys.size() - 1;
  const double segment = (window.end - window.begin) / static_cast<double>(segments);
  double worst = 0;
  auto check = [&](double t) {
    const double x = std::clamp((t - window.begin) / segment, 0.0, static_cast<double>(segments));
    const size_t i = std::min(static_cast<size_t>(x), segments - 1);
    const double e = deviation(frame(t), keys[i], keys[i + 1], x - static_cast<double>(i), radius);
    worst = std::fmax(worst, e);
  };
  // The middle, where a smooth motion errs most, and places at golden-ratio fractions, which no whole number of turns
  // per segment can hide from.
  constexpr int kProbes = 12;
  for (size_t i = 0; i < segments && worst <= bound; ++i) {
    const double begin = window.begin + segment * static_cast<double>(i);
    check(begin + 0.5 * segment);
    for (int k = 1; k <= kProbes; ++k) check(begin + segment * std::fmod(k * 0.61803398874989485, 1.0));
  }
  for (const double t : kinks) check(t);
  check(window.end);
  return worst;
}

}  // namespace

std::vector<Affine3> time_keys(const MovingFrame& frame, TimeSpan window, size_t steps) {
  SUITE_CHECK(steps >= 1);
  std::vector<Affine3> keys(steps);
  for (size_t i = 0; i < steps; ++i) {
    const double s = steps == 1 ? 0 : static_cast<double>(i) / static_cast<double>(steps - 1);
    keys[i] = frame(i + 1 == steps && steps > 1 ? window.end : window.begin + (window.end - window.begin) * s);
  }
  return keys;
}

size_t time_steps_for(const MovingFrame& frame, std::span<const double> kinks, TimeSpan window, double radius,
                      double bound) {
  if (!(bound > 0)) throw Error(strf("a bound of %g m on the error of moving geometry", bound), "give more than 0");
  if (!(radius >= 0 && std::isfinite(radius)))
    throw Error(strf("a moving body of radius %g m", radius), "give 0 or more");
  auto holds = [&](size_t steps) { return blend_error(frame, kinks, window, steps, radius, bound) <= bound; };
  if (window.begin == window.end) return 1;

  // Few keys one by one, since a kink may happen to lie on a key; then double until the bound holds and halve the gap.
  constexpr size_t kFew = 16;
  for (size_t steps = 1; steps <= kFew; ++steps)
    if (holds(steps)) return steps;
  size_t low = kFew, high = 2 * kFew - 1;
  while (!holds(high)) {
    low = high;
    if (high >= kMostSteps)
      throw Error(strf("a moving body of radius %g m needs more than a million steps in %g s", radius,
                       window.end - window.begin),
                  "a shorter exposure, or a slower motion");
    high = std::min(2 * high - 1, kMostSteps);
  }
  while (high - low > 1) {
    const size_t middle = low + (high - low) / 2;
    (holds(middle) ? high : low) = middle;
  }
  return high;
}

std::vector<Affine3> time_keys(const Track& track, TimeSpan window, size_t steps) {
  return time_keys([&](double t) { return track.at(t).affine(); }, window, steps);
}

size_t time_steps_for(const Track& track, TimeSpan window, double radius, double bound) {
  const TimeSpan c = track.covered();
  if (!(window.begin <= window.end) || !c.contains(window.begin) || !c.contains(window.end))
    throw Error(strf("a motion is needed from %.9g to %.9g s", window.begin, window.end),
                strf("it covers %.9g to %.9g s", c.begin, c.end));
  return time_steps_for([&](double t) { return track.at(t).affine(); }, track.kinks(window), window, radius, bound);
}

}  // namespace suite
