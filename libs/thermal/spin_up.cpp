#include <algorithm>
#include <cmath>
#include <deque>
#include <functional>

#include "base/error.h"
#include "thermal/slab.h"

namespace suite {

namespace {

using Vector = std::vector<double>;
constexpr size_t kMemory = 8;  // differences Anderson's method looks back at

double dot(const Vector& a, const Vector& b) {
  double sum = 0;
  for (size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
  return sum;
}

// Anderson's acceleration of x -> g(x): combines the last images so that the residuals g - x, weighted by the root of
// the heat capacity, cancel as well as they can.
class Anderson {
 public:
  explicit Anderson(Vector weights) : weights_(std::move(weights)) {}

  // The next guess from x and its image g.
  Vector next(const Vector& x, const Vector& g) {
    Vector f(x.size());
    for (size_t i = 0; i < x.size(); ++i) f[i] = weights_[i] * (g[i] - x[i]);
    if (!last_f_.empty()) {
      Vector df(x.size()), dg(x.size());
      for (size_t i = 0; i < x.size(); ++i) df[i] = f[i] - last_f_[i], dg[i] = g[i] - last_g_[i];
      df_.push_front(df);
      dg_.push_front(dg);
      if (df_.size() > kMemory) df_.pop_back(), dg_.pop_back();
    }
    last_f_ = f;
    last_g_ = g;
    // Least squares by modified Gram-Schmidt, newest differences first; nearly dependent ones are left out. What is
    // done to df is done to dg, so no triangular system needs solving.
    Vector result = g;
    std::vector<Vector> q, r;
    for (size_t k = 0; k < df_.size(); ++k) {
      Vector a = df_[k], b = dg_[k];
      const double size = std::sqrt(dot(a, a));
      for (size_t m = 0; m < q.size(); ++m) {
        const double c = dot(q[m], a);
        for (size_t i = 0; i < a.size(); ++i) a[i] -= c * q[m][i], b[i] -= c * r[m][i];
      }
      const double rest = std::sqrt(dot(a, a));
      if (!(rest > 1e-6 * size)) continue;
      for (size_t i = 0; i < a.size(); ++i) a[i] /= rest, b[i] /= rest;
      const double c = dot(a, f);
      for (size_t i = 0; i < a.size(); ++i) f[i] -= c * a[i], result[i] -= c * b[i];
      q.push_back(std::move(a));
      r.push_back(std::move(b));
    }
    return result;
  }

 private:
  Vector weights_, last_f_, last_g_;
  std::deque<Vector> df_, dg_;
};

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
