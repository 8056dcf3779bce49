#include "detection/decompose.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include "detection/pulse_shape.h"
#include "math/vec.h"

namespace suite {

namespace {

// A symmetric positive matrix, row by row, as its factor L of L L^T; false when it is none.
bool factor(std::vector<double>& a, size_t n) {
  for (size_t i = 0; i < n; ++i)
    for (size_t j = 0; j <= i; ++j) {
      double sum = a[i * n + j];
      for (size_t k = 0; k < j; ++k) sum -= a[i * n + k] * a[j * n + k];
      if (i == j) {
        if (!(sum > 0) || !std::isfinite(sum)) return false;
        a[i * n + i] = std::sqrt(sum);
      } else {
        a[i * n + j] = sum / a[j * n + j];
      }
    }
  return true;
}
void solve(const std::vector<double>& l, size_t n, std::vector<double>& x) {
  for (size_t i = 0; i < n; ++i) {
    for (size_t k = 0; k < i; ++k) x[i] -= l[i * n + k] * x[k];
    x[i] /= l[i * n + i];
  }
  for (size_t i = n; i-- > 0;) {
    for (size_t k = i + 1; k < n; ++k) x[i] -= l[k * n + i] * x[k];
    x[i] /= l[i * n + i];
  }
}

// Times in samples from here on: the sums are then of order one. p: baseline, then amplitude, centre, width of each.
struct Sums {
  std::vector<double> square, side;  // J^T W J and J^T W r
  double chi_square = 0;
};

struct Model {
  size_t samples, pulses;
  size_t size() const { return 1 + 3 * pulses; }
  // Value of a sample (its middle) and its slopes.
  double value(const std::vector<double>& p, size_t k, std::vector<double>& slope) const {
    double sum = p[0];
    slope.assign(size(), 0);
    slope[0] = 1;
    for (size_t g = 0; g < pulses; ++g) {
      const double a = p[1 + 3 * g], w = p[3 + 3 * g], z = (static_cast<double>(k) - p[2 + 3 * g]) / w;
      if (std::fabs(z) > 8) continue;
      const double e = std::exp(-0.5 * z * z);
      sum += a * e;
      slope[1 + 3 * g] = e, slope[2 + 3 * g] = a * e * z / w, slope[3 + 3 * g] = a * e * z * z / w;
    }
    return sum;
  }
  // weight(k, value): one over the variance.
  Sums sums(const std::vector<double>& p, std::span<const double> signal,
            const std::function<double(size_t, double)>& weight) const {
    const size_t n = size();
    Sums s{std::vector<double>(n * n, 0), std::vector<double>(n, 0), 0};
    std::vector<double> slope;
    std::vector<size_t> felt;  // parameters that a sample depends on: few, for pulses are short
    for (size_t k = 0; k < samples; ++k) {
      const double v = value(p, k, slope), w = weight(k, v), r = signal[k] - v;
      s.chi_square += w * r * r;
      felt.clear();
      for (size_t i = 0; i < n; ++i)
        if (slope[i] != 0) felt.push_back(i);
      for (const size_t i : felt) {
        s.side[i] += w * slope[i] * r;
        for (const size_t j : felt)
          if (j <= i) s.square[i * n + j] += w * slope[i] * slope[j];
      }
    }
    return s;
  }
};

double median_of(std::span<const double> values) {
  std::vector<double> v(values.begin(), values.end());
  std::nth_element(v.begin(), v.begin() + static_cast<std::ptrdiff_t>(v.size() / 2), v.end());
  return v[v.size() / 2];
}

struct Seeds {
  double baseline = 0;
  std::vector<std::array<double, 3>> pulses;  // amplitude, centre, width, in samples
};

// A signal smoothed by a Gaussian of the system's width: what is narrower is noise.
std::vector<double> smoothed(std::span<const double> signal, double width) {
  const auto reach = static_cast<std::ptrdiff_t>(std::ceil(3 * width)), n = static_cast<std::ptrdiff_t>(signal.size());
  std::vector<double> out(signal.size());
  for (std::ptrdiff_t k = 0; k < n; ++k) {
    double sum = 0, weights = 0;
    for (std::ptrdiff_t j = std::max<std::ptrdiff_t>(0, k - reach); j <= std::min(n - 1, k + reach); ++j) {
      const double z = static_cast<double>(j - k) / width, w = std::exp(-0.5 * z * z);
      sum += w * signal[static_cast<size_t>(j)], weights += w;
    }
    out[static_cast<size_t>(k)] = sum / weights;
  }
  return out;
}

Seeds find_seeds(std::span<const double> signal, double width, const DecomposeSpec& spec) {
  Seeds s{median_of(signal), {}};
  const std::vector<double> v = smoothed(signal, std::max(0.5, 0.35 * width));
  // Maxima, and minima of the second derivative: shoulders.
  std::vector<size_t> at;
  const auto bend = [&](size_t k) { return v[k + 1] - 2 * v[k] + v[k - 1]; };
  for (size_t k = 2; k + 2 < v.size(); ++k) {
    const bool top = v[k] > v[k - 1] && v[k] >= v[k + 1];
    const bool shoulder = bend(k) < 0 && bend(k) < bend(k - 1) && bend(k) <= bend(k + 1);
    if ((top || shoulder) && v[k] - s.baseline >= spec.least_amplitude) at.push_back(k);
  }
  std::sort(at.begin(), at.end(), [&](size_t a, size_t b) { return v[a] > v[b] || (v[a] == v[b] && a < b); });
  for (const size_t k : at) {
    if (s.pulses.size() == spec.most) break;
    const auto near = [&](const std::array<double, 3>& p) {
      return std::fabs(p[1] - static_cast<double>(k)) < 0.5 * kFwhmOfDeviation * width;
    };
    if (std::none_of(s.pulses.begin(), s.pulses.end(), near))
      s.pulses.push_back({v[k] - s.baseline, static_cast<double>(k), width});
  }
  return s;
}

// A seed where the signal, smoothed, is most above a model.
std::array<double, 3> most_left(const std::vector<double>& p, std::span<const double> signal, double width) {
  const Model model{signal.size(), (p.size() - 1) / 3};
  std::vector<double> rest(signal.size()), slope;
  for (size_t k = 0; k < signal.size(); ++k) rest[k] = signal[k] - model.value(p, k, slope);
  rest = smoothed(rest, std::max(0.5, 0.35 * width));
  const auto most = std::max_element(rest.begin(), rest.end());
  return {*most, static_cast<double>(most - rest.begin()), width};
}

// The result of parameters in samples, by their centres; cov: the inverse of the information, or empty.
Decomposition conclude(const std::vector<double>& p, const std::vector<double>& factor_of_information,
                       const SampleGrid& grid) {
  Decomposition d;
  d.baseline = p[0];
  const size_t n = p.size();
  for (size_t g = 0; 1 + 3 * g < n; ++g) {
    GaussianPulse pulse{p[1 + 3 * g], grid.middle(0) + p[2 + 3 * g] * grid.step, p[3 + 3 * g] * grid.step, {}};
    const double unit[3] = {1, grid.step, grid.step};
    for (size_t i = 0; i < 3 && !factor_of_information.empty(); ++i) {
      std::vector<double> column(n, 0);
      column[1 + 3 * g + i] = 1;
      solve(factor_of_information, n, column);
      for (size_t j = 0; j < 3; ++j) pulse.covariance[3 * i + j] = column[1 + 3 * g + j] * unit[i] * unit[j];
    }
    d.pulses.push_back(pulse);
  }
  std::sort(d.pulses.begin(), d.pulses.end(), [](const auto& a, const auto& b) { return a.centre < b.centre; });
  return d;
}

constexpr double kOnePulseMore = 16.27;  // 99.9 % quantile of chi-square with three degrees of freedom

void leave_out(std::vector<double>& p, size_t pulse) {
  const auto first = p.begin() + static_cast<std::ptrdiff_t>(1 + 3 * pulse);
  p.erase(first, first + 3);
}
// Puts pulse g into h.
void join(std::vector<double>& p, size_t g, size_t h) {
  const double a = p[1 + 3 * g], b = p[1 + 3 * h], t = (a * p[2 + 3 * g] + b * p[2 + 3 * h]) / (a + b);
  p[1 + 3 * h] = std::max(a, b), p[2 + 3 * h] = t, p[3 + 3 * h] = std::max(p[3 + 3 * g], p[3 + 3 * h]);
  leave_out(p, g);
}
// FWHMs of the narrower of two pulses between them.
double apart(const std::vector<double>& p, size_t g, size_t h) {
  return std::fabs(p[2 + 3 * g] - p[2 + 3 * h]) / (kFwhmOfDeviation * std::min(p[3 + 3 * g], p[3 + 3 * h]));
}

// Drops a pulse that is none, or joins two that are one; false when all may stay.
bool tidy(std::vector<double>& p, const DecomposeSpec& spec, double samples) {
  for (size_t g = 0; 1 + 3 * g < p.size(); ++g) {
    if (p[1 + 3 * g] < spec.least_amplitude || p[2 + 3 * g] < 0 || p[2 + 3 * g] > samples - 1) {
      leave_out(p, g);
      return true;
    }
    for (size_t h = 0; h < g; ++h) {
      if (apart(p, g, h) >= 0.5) continue;
      join(p, g, h);
      return true;
    }
  }
  return false;
}

// The two models with one pulse less that may do as well.
std::vector<std::vector<double>> simpler(const std::vector<double>& p) {
  const size_t pulses = (p.size() - 1) / 3;
  if (pulses < 2) return {};
  size_t weakest = 0, g = 1, h = 0;
  for (size_t k = 0; k < pulses; ++k) {
    if (p[1 + 3 * k] < p[1 + 3 * weakest]) weakest = k;
    for (size_t j = 0; j < k; ++j)
      if (apart(p, k, j) < apart(p, g, h)) g = k, h = j;
  }
  std::vector<std::vector<double>> both{p, p};
  join(both[0], g, h);
  leave_out(both[1], weakest);
  return both;
}

struct Fit {
  std::vector<double> p;
  double chi_square = 0;
  bool converged = false;
};

// Fits, adds pulses while one is worth its three parameters, and leaves out those that are not. left_over: a seed where
// the signal is most above the model; fit: of given seeds.
Fit parsimonious(std::vector<double> seeds, const DecomposeSpec& spec, double samples,
                 const std::function<std::array<double, 3>(const std::vector<double>&)>& left_over,
                 const std::function<Fit(std::vector<double>)>& fit) {
  const auto tidied = [&](std::vector<double> from) {
    Fit f = fit(std::move(from));
    while (tidy(f.p, spec, samples)) f = fit(std::move(f.p));
    return f;
  };
  Fit best = tidied(std::move(seeds));
  // What the seeds missed, such as a pulse behind the shoulder of another: where most is left over.
  while ((best.p.size() - 1) / 3 < spec.most) {
    std::vector<double> more = best.p;
    const std::array<double, 3> seed = left_over(best.p);
    if (!(seed[0] > 0)) break;
    more.insert(more.end(), seed.begin(), seed.end());
    Fit other = tidied(std::move(more));
    if (other.p.size() <= best.p.size() || best.chi_square - other.chi_square < kOnePulseMore) break;
    best = std::move(other);
  }
  for (bool less = true; less;) {
    less = false;
    for (std::vector<double>& p : simpler(best.p)) {
      Fit other = tidied(std::move(p));
      if (other.chi_square - best.chi_square >= kOnePulseMore) continue;
      best = std::move(other), less = true;
      break;
    }
  }
  return best;
}

Fit marquardt(std::vector<double> p, std::span<const double> signal,
              const std::function<double(size_t, double)>& weight, double least_width, int steps) {
  const Model model{signal.size(), (p.size() - 1) / 3};
  const size_t n = model.size();
  Sums now = model.sums(p, signal, weight);
  double damping = 1e-3;
  for (int step = 0; step < steps; ++step) {
    std::vector<double> a = now.square, x = now.side;
    for (size_t i = 0; i < n; ++i) a[i * n + i] += damping * a[i * n + i] + 1e-30;
    if (!factor(a, n)) {
      damping = std::max(10 * damping, 1e-6);
      if (damping > 1e12) return {p, now.chi_square, false};
      continue;
    }
    solve(a, n, x);
    std::vector<double> q = p;
    for (size_t i = 0; i < n; ++i) q[i] += x[i];
    for (size_t g = 0; g < model.pulses; ++g) q[3 + 3 * g] = std::max(q[3 + 3 * g], least_width);
    const Sums then = model.sums(q, signal, weight);
    if (then.chi_square <= now.chi_square) {
      const double fall = now.chi_square - then.chi_square;
      p = std::move(q), now = then, damping = std::max(damping / 10, 1e-12);
      if (fall <= 1e-10 * (now.chi_square + 1e-20)) return {p, now.chi_square, true};
    } else if ((damping *= 10) > 1e12) {
      return {p, now.chi_square, true};  // no step improves
    }
  }
  return {p, now.chi_square, false};
}

std::vector<double> parameters_of(const Seeds& s) {
  std::vector<double> p{s.baseline};
  for (const auto& g : s.pulses) p.insert(p.end(), g.begin(), g.end());
  return p;
}

std::vector<double> information(const std::vector<double>& p, std::span<const double> signal,
                                const std::function<double(size_t, double)>& weight) {
  std::vector<double> a = Model{signal.size(), (p.size() - 1) / 3}.sums(p, signal, weight).square;
  return factor(a, p.size()) ? a : std::vector<double>{};
}

}  // namespace

Decomposition decompose(std::span<const double> signal, std::span<const double> noise, const SampleGrid& grid,
                        const DecomposeSpec& spec) {
  SUITE_CHECK(signal.size() == grid.count && (noise.size() == 1 || noise.size() == grid.count));
  const auto weight = [&](size_t k, double) {
    const double s = noise[noise.size() == 1 ? 0 : k];
    return 1 / (s * s);
  };
  const double narrowest = std::max(0.5, spec.least_width / grid.step);
  const Fit fit = parsimonious(
      parameters_of(find_seeds(signal, narrowest, spec)), spec, static_cast<double>(grid.count),
      [&](const std::vector<double>& p) { return most_left(p, signal, narrowest); },
      [&](std::vector<double> p) { return marquardt(std::move(p), signal, weight, narrowest, spec.steps); });
  Decomposition d = conclude(fit.p, information(fit.p, signal, weight), grid);
  d.chi_square = fit.chi_square, d.converged = fit.converged;
  d.degrees = grid.count > fit.p.size() ? grid.count - fit.p.size() : 0;
  return d;
}

namespace {

// One step of EM: each count is shared out among baseline and pulses by what they expect there. Returns the
// log-likelihood before the step, without the constant of the counts.
double maximise(std::vector<double>& p, std::span<const double> counts, double least_width) {
  const size_t pulses = (p.size() - 1) / 3;
  std::vector<double> sum(pulses, 0), first(pulses, 0), second(pulses, 0), part(pulses);
  double even = 0, likelihood = 0;
  for (size_t k = 0; k < counts.size(); ++k) {
    double all = p[0];
    for (size_t g = 0; g < pulses; ++g) {
      const double z = (static_cast<double>(k) - p[2 + 3 * g]) / p[3 + 3 * g];
      all += part[g] = p[1 + 3 * g] * std::exp(-0.5 * z * z);
    }
    likelihood += (counts[k] > 0 ? counts[k] * std::log(all) : 0) - all;
    if (!(counts[k] > 0)) continue;
    even += counts[k] * p[0] / all;
    for (size_t g = 0; g < pulses; ++g) {
      const double share = counts[k] * part[g] / all, t = static_cast<double>(k) - p[2 + 3 * g];
      sum[g] += share, first[g] += share * t, second[g] += share * t * t;
    }
  }
  p[0] = even / static_cast<double>(counts.size());
  for (size_t g = 0; g < pulses; ++g) {
    if (!(sum[g] > 0)) {
      p[1 + 3 * g] = 0;
      continue;
    }
    const double mean = first[g] / sum[g];
    p[2 + 3 * g] += mean;
    p[3 + 3 * g] = std::max(least_width, std::sqrt(std::max(0.0, second[g] / sum[g] - mean * mean)));
    p[1 + 3 * g] = sum[g] / (p[3 + 3 * g] * std::sqrt(2 * kPi));
  }
  return likelihood;
}

}  // namespace

Decomposition decompose_counts(std::span<const double> counts, const SampleGrid& grid, const DecomposeSpec& spec,
                               std::vector<double>* log_likelihoods) {
  SUITE_CHECK(counts.size() == grid.count);
  const double narrowest = std::max(0.5, spec.least_width / grid.step);
  Seeds seeds = find_seeds(counts, narrowest, spec);
  double mean = 0, best = 0;  // best: of a model that expects what is counted
  for (const double c : counts) {
    mean += c / static_cast<double>(counts.size());
    best += c > 0 ? c * std::log(c) - c : 0;
  }
  seeds.baseline = std::max({seeds.baseline, 1e-3 * mean, 1e-12});  // what is 0 stays so
  const auto fit_of = [&](std::vector<double> p) {
    Fit fit{std::move(p), 0, false};
    double last = 0;
    for (int step = 0; step < 50 * spec.steps && !fit.converged; ++step) {
      const double now = maximise(fit.p, counts, narrowest);
      if (log_likelihoods) log_likelihoods->push_back(now);
      fit.converged = step > 0 && std::fabs(now - last) <= 1e-9;
      last = now;
    }
    if (log_likelihoods) log_likelihoods->push_back(std::nan(""));  // another model follows
    fit.chi_square = 2 * (best - last);
    return fit;
  };
  const Fit fit = parsimonious(
      parameters_of(seeds), spec, static_cast<double>(grid.count),
      [&](const std::vector<double>& p) { return most_left(p, counts, narrowest); }, fit_of);
  const auto weight = [&](size_t, double v) { return 1 / std::max(v, 1e-12); };
  Decomposition d = conclude(fit.p, information(fit.p, counts, weight), grid);
  d.chi_square = fit.chi_square, d.converged = fit.converged;
  d.degrees = grid.count > fit.p.size() ? grid.count - fit.p.size() : 0;
  return d;
}

std::vector<LidarReturn> returns_of(const Decomposition& d) {
  std::vector<LidarReturn> all;
  for (const GaussianPulse& p : d.pulses) {
    LidarReturn r;
    r.time = p.centre, r.amplitude = p.amplitude, r.width = p.width, r.baseline = d.baseline;
    r.deviation = std::sqrt(std::max(0.0, p.covariance[4]));
    all.push_back(r);
  }
  number_returns(all);
  return all;
}

}  // namespace suite
