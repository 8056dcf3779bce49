#include "detection/decompose.h"

#include <algorithm>
#include <cmath>

#include "detection/gaussian_sum.h"
#include "detection/pulse_shape.h"
#include "math/vec.h"

namespace suite {

namespace {

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
  const GaussianSum model{signal.size(), (p.size() - 1) / 3};
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
      solve_factored(factor_of_information, n, column);
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

// Fits, adds pulses while one is worth its three parameters, and leaves out those that are not. left_over: a seed where
// the signal is most above the model; fit: of given seeds.
SumFit parsimonious(std::vector<double> seeds, const DecomposeSpec& spec, double samples,
                    const std::function<std::array<double, 3>(const std::vector<double>&)>& left_over,
                    const std::function<SumFit(std::vector<double>)>& fit) {
  const auto tidied = [&](std::vector<double> from) {
    SumFit f = fit(std::move(from));
    while (tidy(f.p, spec, samples)) f = fit(std::move(f.p));
    return f;
  };
  SumFit best = tidied(std::move(seeds));
  // What the seeds missed, such as a pulse behind the shoulder of another: where most is left over.
  while ((best.p.size() - 1) / 3 < spec.most) {
    std::vector<double> more = best.p;
    const std::array<double, 3> seed = left_over(best.p);
    if (!(seed[0] > 0)) break;
    more.insert(more.end(), seed.begin(), seed.end());
    SumFit other = tidied(std::move(more));
    if (other.p.size() <= best.p.size() || best.chi_square - other.chi_square < kOnePulseMore) break;
    best = std::move(other);
  }
  for (bool less = true; less;) {
    less = false;
    for (std::vector<double>& p : simpler(best.p)) {
      SumFit other = tidied(std::move(p));
      if (other.chi_square - best.chi_square >= kOnePulseMore) continue;
      best = std::move(other), less = true;
      break;
    }
  }
  return best;
}

std::vector<double> parameters_of(const Seeds& s) {
  std::vector<double> p{s.baseline};
  for (const auto& g : s.pulses) p.insert(p.end(), g.begin(), g.end());
  return p;
}

std::vector<double> information(const std::vector<double>& p, std::span<const double> signal,
                                const SampleWeight& weight) {
  std::vector<double> a = GaussianSum{signal.size(), (p.size() - 1) / 3}.sums(p, signal, weight).square;
  return factor_matrix(a, p.size()) ? a : std::vector<double>{};
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
  // Which pulses there are is a matter of 16.27; at the end a millionth of what one degree of freedom expects is a
  // thousandth of a parameter's deviation.
  constexpr double kRough = 0.05, kFine = 1e-6;
  constexpr int kRoughSteps = 30;
  const SumFit rough = parsimonious(
      parameters_of(find_seeds(signal, narrowest, spec)), spec, static_cast<double>(grid.count),
      [&](const std::vector<double>& p) { return most_left(p, signal, narrowest); },
      [&](std::vector<double> p) {
        return fit_gaussians(std::move(p), signal, weight, narrowest, kRoughSteps, kRough);
      });
  const SumFit fit = fit_gaussians(rough.p, signal, weight, narrowest, spec.steps, kFine);
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
    SumFit fit{std::move(p), 0, false};
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
  const SumFit fit = parsimonious(
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
