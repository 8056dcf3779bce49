// The periodic state of a batch: a start from harmonics, then periods with the slow remainder removed.
#include <algorithm>
#include <cmath>
#include <complex>

#include "base/error.h"
#include "heat/slab_batch.h"
#include "math/vec.h"

namespace suite {

namespace {

using Complex = std::complex<double>;
constexpr int kHarmonics = 6;

double cube(double x) { return x * x * x; }
// An element that nothing holds has no periodic state; this keeps its equations solvable until that is told.
constexpr double kLeastExchange = 1e-9;  // W/(m2 K)

// (diagonal C + weight (K + faces)) x = right, in place; C and K of a grid with constant properties.
template <class Number>
void solve(const SlabGrid& grid, Number capacity, double weight, double top, double bottom, std::vector<Number>& x) {
  const std::vector<double>&k = grid.conductance[0], &c = grid.heat[0];
  const size_t n = x.size();
  std::vector<Number> diagonal(n);
  for (size_t i = 0; i < n; ++i) {
    const double conduction = (i > 0 ? k[i - 1] : top) + (i + 1 < n ? k[i] : bottom);
    diagonal[i] = capacity * c[i] + weight * conduction;
    if (i == 0) continue;
    const Number ratio = -weight * k[i - 1] / diagonal[i - 1];
    diagonal[i] += ratio * weight * k[i - 1];
    x[i] -= ratio * x[i - 1];
  }
  x[n - 1] /= diagonal[n - 1];
  for (size_t i = n - 1; i-- > 0;) x[i] = (x[i] + weight * k[i] * x[i + 1]) / diagonal[i];
}

// Mean and harmonics over a period of the lines of one face.
struct FaceHarmonics {
  std::vector<Complex> constant, linear;
  explicit FaceHarmonics(size_t elements) : constant(elements * (kHarmonics + 1)), linear(constant.size()) {}
  // The element's k-th harmonic of what drives it: losses at the mean temperature are loads.
  Complex drive(size_t e, int k, double mean) const {
    const size_t i = e * (kHarmonics + 1) + static_cast<size_t>(k);
    return constant[i] - mean * linear[i];
  }
  double mean_constant(size_t e) const { return constant[e * (kHarmonics + 1)].real(); }
  double mean_linear(size_t e) const { return linear[e * (kHarmonics + 1)].real(); }
  void add(const FaceLines& lines, const std::vector<Complex>& waves) {
    for (size_t e = 0; e < lines.constant.size(); ++e)
      for (size_t k = 0; k < waves.size(); ++k) {
        constant[e * waves.size() + k] += lines.constant[e].mean() * waves[k];
        linear[e * waves.size() + k] += lines.linear[e].mean() * waves[k];
      }
  }
};

// The mean state under the mean loads, by Newton's method from x.
void solve_mean(const SlabGrid& grid, const FaceHarmonics& top, const FaceHarmonics& bottom, double top_quartic,
                double bottom_quartic, size_t e, std::vector<double>& x) {
  const std::vector<double>& k = grid.conductance[0];
  const size_t n = x.size();
  for (int turn = 0; turn < 50; ++turn) {
    std::vector<double> gain(grid.source);
    for (size_t i = 0; i + 1 < n; ++i) gain[i] -= k[i] * (x[i] - x[i + 1]), gain[i + 1] += k[i] * (x[i] - x[i + 1]);
    const double t = x[0], b = x[n - 1], qt = top_quartic * t * t * t, qb = bottom_quartic * b * b * b;
    gain[0] += top.mean_constant(e) - t * (top.mean_linear(e) + qt);
    gain[n - 1] += bottom.mean_constant(e) - b * (bottom.mean_linear(e) + qb);
    solve(grid, 0.0, 1.0, top.mean_linear(e) + 4 * qt + kLeastExchange, bottom.mean_linear(e) + 4 * qb, gain);
    double largest = 0;
    for (size_t i = 0; i < n; ++i) {
      x[i] = std::clamp(x[i] + gain[i], std::fmax(1.0, 0.2 * x[i]), std::fmin(1e4, 5 * x[i]));
      largest = std::fmax(largest, std::fabs(gain[i]));
    }
    if (largest < 1e-6) return;
  }
}

// The same of elements that conduct to each other, all at once: [element][node].
void solve_mean_lateral(const SlabBatch& batch, const FaceHarmonics& top, const FaceHarmonics& bottom,
                        const FaceLines& top_lines, const FaceLines& bottom_lines, std::vector<double>& x) {
  const size_t elements = batch.elements(), n = batch.nodes();
  std::vector<double> top_slope(elements), bottom_slope(elements), gain(x.size());
  SlabGrid buffer;
  double largest = INFINITY;
  for (int turn = 0; turn < 50 && largest > 1e-3; ++turn) {
    for (size_t e = 0; e < elements; ++e) {
      const SlabGrid& grid = batch.linearised(e, buffer);
      const std::vector<double>& k = grid.conductance[0];
      double *g = &gain[e * n], *T = &x[e * n];
      std::copy(grid.source.begin(), grid.source.end(), g);
      for (size_t i = 0; i + 1 < n; ++i) g[i] -= k[i] * (T[i] - T[i + 1]), g[i + 1] += k[i] * (T[i] - T[i + 1]);
      const double t = T[0], b = T[n - 1], qt = top_lines.quartic[e] * cube(t), qb = bottom_lines.quartic[e] * cube(b);
      g[0] += top.mean_constant(e) - t * (top.mean_linear(e) + qt);
      g[n - 1] += bottom.mean_constant(e) - b * (bottom.mean_linear(e) + qb);
      top_slope[e] = top.mean_linear(e) + 4 * qt + kLeastExchange, bottom_slope[e] = bottom.mean_linear(e) + 4 * qb;
    }
    batch.add_from_neighbours(x, gain);
    batch.solve_lateral(0, 1, top_slope, bottom_slope, gain);
    largest = 0;
    for (size_t i = 0; i < x.size(); ++i) {
      x[i] = std::clamp(x[i] + gain[i], std::fmax(1.0, 0.2 * x[i]), std::fmin(1e4, 5 * x[i]));
      largest = std::fmax(largest, std::fabs(gain[i]));
    }
  }
}

// Harmonics are those of each element for itself: for those that neighbours hold, the periods that follow mend them.
void start_from_harmonics(SlabBatch& batch, double t0, std::span<const double> steps, const BatchLoads& loads) {
  const size_t elements = batch.elements(), n = batch.nodes();
  FaceHarmonics top(elements), bottom(elements);
  FaceLines top_lines(elements), bottom_lines(elements);
  double period = 0, t = 0;
  for (const double dt : steps) period += dt;
  batch.restart(t0);
  for (const double dt : steps) {
    loads(t0 + t, t0 + t + dt, batch, top_lines, bottom_lines);
    std::vector<Complex> waves;
    for (int k = 0; k <= kHarmonics; ++k)
      waves.push_back((k == 0 ? 1 : 2) * dt / period * std::polar(1.0, -2 * kPi * k * (t + dt / 2) / period));
    top.add(top_lines, waves);
    bottom.add(bottom_lines, waves);
    t += dt;
  }
  std::vector<double> all(elements * n);
  for (size_t e = 0; e < elements; ++e)
    for (size_t i = 0; i < n; ++i) all[e * n + i] = batch.kelvin(e, i);
  if (batch.has_neighbours()) solve_mean_lateral(batch, top, bottom, top_lines, bottom_lines, all);
  for (size_t e = 0; e < elements; ++e) {
    SlabGrid buffer;
    const SlabGrid& grid = batch.linearised(e, buffer);
    std::vector<double> x(all.begin() + static_cast<std::ptrdiff_t>(e * n),
                          all.begin() + static_cast<std::ptrdiff_t>((e + 1) * n));
    if (!batch.has_neighbours()) solve_mean(grid, top, bottom, top_lines.quartic[e], bottom_lines.quartic[e], e, x);
    const double t_mean = x[0], b_mean = x[n - 1];
    const double t_slope = top.mean_linear(e) + 4 * top_lines.quartic[e] * cube(t_mean),
                 b_slope = bottom.mean_linear(e) + 4 * bottom_lines.quartic[e] * cube(b_mean);
    std::vector<double> start(x);
    for (int k = 1; k <= kHarmonics; ++k) {
      std::vector<Complex> wave(n);
      wave[0] = top.drive(e, k, t_mean);
      wave[n - 1] += bottom.drive(e, k, b_mean);
      solve(grid, Complex(0, 2 * kPi * k / period), 1.0, t_slope, b_slope, wave);
      for (size_t i = 0; i < n; ++i) start[i] += wave[i].real();
    }
    for (size_t i = 0; i < n; ++i)
      batch.set_kelvin(e, i, std::clamp(start[i], std::fmax(1.0, 0.5 * x[i]), std::fmin(1e4, 2 * x[i])));
  }
}

// Sums over a period of dt times the slope of the losses of a face.
struct FaceSlopes {
  std::vector<double> top, bottom;
};

void add_slopes(const SlabBatch& batch, double dt, FaceSlopes& sums) {
  for (size_t e = 0; e < batch.elements(); ++e) {
    const FaceLines &t = batch.top_lines(), &b = batch.bottom_lines();
    sums.top[e] += dt * (t.linear[e].mean() + 4 * t.quartic[e] * cube(batch.top_mean(e)));
    sums.bottom[e] += dt * (b.linear[e].mean() + 4 * b.quartic[e] * cube(batch.bottom_mean(e)));
  }
}

// What is left of an element's way to the periodic state, from its change over a period.
void remaining(const SlabGrid& grid, double period, double top, double bottom, std::vector<double>& change) {
  const size_t n = change.size();
  for (size_t i = 0; i < n; ++i) change[i] *= grid.heat[0][i] / period;
  solve(grid, 0.0, 1.0, top + kLeastExchange, bottom, change);
  for (size_t i = 0; i < n; ++i) change[i] *= grid.heat[0][i];
  solve(grid, 1.0, period / 2, top, bottom, change);
}

// The same of all elements, as they are at present: [element][node].
void remaining(const SlabBatch& batch, double period, const FaceSlopes& slopes, std::vector<double>& change) {
  const size_t elements = batch.elements(), n = batch.nodes();
  SlabGrid buffer;
  if (!batch.has_neighbours()) {
    std::vector<double> one(n);
    for (size_t e = 0; e < elements; ++e) {
      const auto begin = change.begin() + static_cast<std::ptrdiff_t>(e * n);
      std::copy_n(begin, n, one.begin());
      remaining(batch.linearised(e, buffer), period, slopes.top[e] / period, slopes.bottom[e] / period, one);
      std::copy(one.begin(), one.end(), begin);
    }
    return;
  }
  std::vector<double> top(elements), bottom(elements);
  for (size_t e = 0; e < elements; ++e)
    top[e] = slopes.top[e] / period + kLeastExchange, bottom[e] = slopes.bottom[e] / period;
  const auto times_heat = [&](double factor) {
    for (size_t e = 0; e < elements; ++e) {
      const SlabGrid& grid = batch.linearised(e, buffer);
      for (size_t i = 0; i < n; ++i) change[e * n + i] *= grid.heat[0][i] * factor;
    }
  };
  times_heat(1 / period), batch.solve_lateral(0, 1, top, bottom, change);
  times_heat(1), batch.solve_lateral(1, period / 2, top, bottom, change);
}

}  // namespace

PeriodicResult find_periodic(SlabBatch& batch, double t0, std::span<const double> steps, const BatchLoads& loads,
                             const PeriodicOptions& options, const std::function<void(size_t step)>& after) {
  SUITE_CHECK(!steps.empty() && options.tolerance > 0);
  if (options.harmonics) start_from_harmonics(batch, t0, steps, loads);
  const size_t elements = batch.elements(), n = batch.nodes();
  double period = 0, last = INFINITY;
  for (const double dt : steps) period += dt;
  PeriodicResult result;
  for (;;) {
    std::vector<double> begin(elements * n);
    for (size_t e = 0; e < elements; ++e)
      for (size_t i = 0; i < n; ++i) begin[e * n + i] = batch.kelvin(e, i);
    FaceSlopes slopes{std::vector<double>(elements), std::vector<double>(elements)};
    batch.restart(t0);
    for (size_t k = 0; k < steps.size(); ++k) {
      batch.step(steps[k], loads);
      add_slopes(batch, steps[k], slopes);
      if (after) after(k);
    }
    ++result.sweeps;
    result.distance = 0;
    std::vector<double> left(elements * n);
    for (size_t e = 0; e < elements; ++e)
      for (size_t i = 0; i < n; ++i) left[e * n + i] = batch.kelvin(e, i) - begin[e * n + i];
    remaining(batch, period, slopes, left);
    for (const double d : left) result.distance = std::fmax(result.distance, std::fabs(d));
    if (result.distance <= options.tolerance) return result;
    if (result.sweeps >= options.most_sweeps)
      throw Error(strf("slabs are not periodic after %d periods: %g K are left", result.sweeps, result.distance),
                  "something has to hold their temperature, or allow more periods");
    // Far from linear the correction may overshoot: then a period is simulated without one.
    const bool correct = result.distance < last;
    last = correct ? result.distance : INFINITY;
    for (size_t e = 0; correct && e < elements; ++e)
      for (size_t i = 0; i < n; ++i) batch.set_kelvin(e, i, std::clamp(batch.kelvin(e, i) + left[e * n + i], 1.0, 1e4));
    if (result.sweeps == options.enough) return result;
  }
}

}  // namespace suite
