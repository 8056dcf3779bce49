#include <algorithm>
#include <cmath>
#include <functional>

#include "base/error.h"
#include "math/anderson.h"
#include "thermal/slab.h"

namespace suite {

namespace {

using Vector = std::vector<double>;

double largest_difference(const Vector& a, const Vector& b) {
  double d = 0;
  for (size_t i = 0; i < a.size(); ++i) d = std::fmax(d, std::fabs(a[i] - b[i]));
  return d;
}

Vector present(const Slab& slab) { return {slab.kelvin().begin(), slab.kelvin().end()}; }

// A period with the steps the error estimate asks for.
Vector adaptive_period(Slab& slab, const Vector& x, double t0, double period, Vector& steps) {
  slab.start(t0, x);
  slab.record_steps(true);
  slab.advance(t0 + period);
  steps = slab.recorded_steps();
  slab.record_steps(false);
  return present(slab);
}

// A period with given steps; false when one of them cannot be taken from these temperatures.
bool replayed_period(Slab& slab, const Vector& x, double t0, const Vector& steps, Vector& end) {
  slab.start(t0, x);
  for (const double dt : steps)
    if (!slab.step(dt)) return false;
  end = present(slab);
  return true;
}

bool plausible(const Vector& x) {
  return std::all_of(x.begin(), x.end(), [](double T) { return T >= 1 && T <= 5000; });
}

// Moves x to the fixed point of a period with the given steps and leaves the slab at the end of one; false when the
// steps cannot be taken from somewhere on the way.
bool find_fixed_point(Slab& slab, Vector& x, double t0, const Vector& steps, const Vector& weights, double tolerance,
                      const std::function<void()>& count, SpinUpResult& result) {
  Anderson anderson(weights);
  for (Vector image;;) {
    count();
    if (!replayed_period(slab, x, t0, steps, image)) return false;
    result.change = largest_difference(x, image);
    if (result.change <= tolerance) return true;
    Vector guess = anderson.next(x, image);
    x = plausible(guess) ? std::move(guess) : image;
  }
}

}  // namespace

SpinUpResult spin_up(Slab& slab, double t0, double period, const SpinUpOptions& options) {
  if (!(period > 0 && std::isfinite(period)))
    throw Error(strf("a spin-up over a period of %g s", period), "more than 0");
  if (!(options.tolerance > 0)) throw Error(strf("a spin-up to %g K", options.tolerance), "more than 0");
  Vector x = present(slab), weights(slab.heat_capacities().begin(), slab.heat_capacities().end());
  for (double& w : weights) w = std::sqrt(w);
  SpinUpResult result;
  const std::function<void()> count = [&] {
    if (++result.periods > options.max_periods)
      throw Error(
          strf("a slab is not periodic after %d periods: it still changes by %g K", options.max_periods, result.change),
          "allow more periods, a larger tolerance, or a thinner slab");
  };
  // Steps chosen on the way to the fixed point suit it only roughly: choose them again from there, until that moves the
  // fixed point by less than steps can tell apart.
  constexpr double kSameOrbit = 0.1;  // K
  Vector last_fixed_point;
  for (;;) {
    Vector steps;
    count();
    x = adaptive_period(slab, x, t0, period, steps);
    count();
    adaptive_period(slab, x, t0, period, steps);
    if (!find_fixed_point(slab, x, t0, steps, weights, options.tolerance, count, result)) {
      last_fixed_point.clear();  // too far away for these steps
      continue;
    }
    if (!last_fixed_point.empty() && largest_difference(x, last_fixed_point) < kSameOrbit) {
      result.steps = steps;
      return result;
    }
    last_fixed_point = x;
  }
}

}  // namespace suite
