// Sums of the problems of a capture, and what follows from them.
#include <algorithm>
#include <cmath>

#include "base/memory.h"
#include "radiometry/pipeline.h"

namespace suite {

namespace {
constexpr double kRounding = 1e-12;  // relative variance of equal samples, from their sums
}

Accumulators::Accumulators(size_t problems, size_t bands, int scrambles, size_t truth_slots, bool missing)
    : bands_(bands),
      scrambles_(scrambles),
      paths_(problems),
      failures_(problems * static_cast<size_t>(scrambles)),
      truncated_(problems),
      largest_(problems),
      squares_(problems),
      truth_slots_(truth_slots) {
  resize_large(sums_, problems * bands * static_cast<size_t>(scrambles));
  resize_large(truth_, problems * truth_slots);
  if (!missing) return;
  resize_large(missing_, problems * bands);
  missing_of_.resize(2 * problems);
}

uint32_t Accumulators::failures(size_t problem) const {
  uint32_t sum = 0;
  for (int s = 0; s < scrambles_; ++s) sum += failures(problem, s);
  return sum;
}

namespace {

// How the samples that were averaged in share out among the scrambles, and what the squared deviation of each one's
// mean weighs in the variance of the mean of all.
struct Shares {
  Shares(const Accumulators& sums, size_t problem) {
    const double n = sums.accepted(problem);
    double sum = 0;
    bool half = false;
    for (int s = 0; s < sums.scrambles(); ++s) {
      count[s] = sums.accepted(problem, s);
      const double share = count[s] / n;
      used += count[s] > 0;
      half = half || share >= 0.5;
      weight[s] = share * share / (1 - 2 * share);
      sum += weight[s];
    }
    for (int s = 0; s < sums.scrambles(); ++s)
      weight[s] = half ? 1.0 / (used * std::max(1, used - 1)) : weight[s] / (1 + sum);
  }
  double count[8], weight[8];
  int used = 0;
};

}  // namespace

void Accumulators::estimate(size_t problem, size_t band, double& mean, double& standard_error) const {
  mean = standard_error = 0;
  const uint32_t n = accepted(problem);
  if (!n) return;
  double total = 0;
  for (int s = 0; s < scrambles_; ++s) total += sums(problem, s)[band];
  mean = total / n;  // rejected samples are not averaged in
  double square = 0;
  const Shares shares(*this, problem);
  for (int s = 0; s < scrambles_; ++s) {
    if (!(shares.count[s] > 0)) continue;
    const double d = sums(problem, s)[band] / shares.count[s] - mean;
    square += shares.weight[s] * d * d;
  }
  standard_error = shares.used < 2 ? INFINITY : std::sqrt(square);  // one scramble tells nothing about its own error
}

void Accumulators::estimate(size_t problem, std::span<double> means, std::span<double> errors) const {
  std::fill(means.begin(), means.end(), 0.0);
  std::fill(errors.begin(), errors.end(), 0.0);
  const uint32_t n = accepted(problem);
  if (!n) return;
  double* __restrict const mean = means.data();
  double* __restrict const square = errors.data();
  for (int s = 0; s < scrambles_; ++s) {
    const double* __restrict sum = sums(problem, s);
    for (size_t b = 0; b < bands_; ++b) mean[b] += sum[b];
  }
  for (size_t b = 0; b < bands_; ++b) mean[b] /= n;
  const Shares shares(*this, problem);
  for (int s = 0; s < scrambles_; ++s) {
    if (!(shares.count[s] > 0)) continue;
    const double* __restrict sum = sums(problem, s);
    const double count = shares.count[s], weight = shares.weight[s];
    for (size_t b = 0; b < bands_; ++b) {
      const double d = sum[b] / count - mean[b];
      square[b] += weight * d * d;
    }
  }
  for (size_t b = 0; b < bands_; ++b) square[b] = shares.used < 2 ? INFINITY : std::sqrt(square[b]);
}

Accumulators::Shortfall Accumulators::shortfall(size_t problem) const {
  Shortfall of;
  const uint32_t n = accepted(problem);
  if (!n) return of;
  const double share = std::min(0.999, double{truncated_[problem]} / n);
  of.cut = share / (1 - share);
  if (!keeps_missing()) return of;
  const double sum = missing_of_[2 * problem], square = missing_of_[2 * problem + 1];
  if (!(square > 0)) return of;
  const double meetings = sum * (sum / square);
  if (!(meetings >= kEnoughMeetings)) of.missing = std::min(1.0, 1 / std::sqrt(meetings));
  return of;
}

std::vector<double> Accumulators::lacking(size_t problem, std::span<const double> means) const {
  const Shortfall of = shortfall(problem);
  if (of.cut == 0 && of.missing == 0) return {};
  std::vector<double> light(means.size());
  const double missing = of.missing / accepted(problem);
  for (size_t b = 0; b < light.size(); ++b)
    light[b] = of.cut * means[b] + (of.missing > 0 ? missing * missing_light(problem)[b] : 0);
  return light;
}

double Accumulators::scatter(size_t problem, double mean) const {
  const double n = accepted(problem);
  if (n < 2) return 0;
  const double variance = squares_[problem] / n - mean * mean;
  return variance > kRounding * mean * mean ? variance / (n - 1) : 0;
}

void Accumulators::clear() {
  std::fill(sums_.begin(), sums_.end(), 0.0);
  std::fill(paths_.begin(), paths_.end(), 0u);
  std::fill(failures_.begin(), failures_.end(), 0u);
  std::fill(truncated_.begin(), truncated_.end(), 0.0f);
  std::fill(largest_.begin(), largest_.end(), 0.0f);
  std::fill(squares_.begin(), squares_.end(), 0.0);
  std::fill(truth_.begin(), truth_.end(), 0.0);
  std::fill(missing_.begin(), missing_.end(), 0.0);
  std::fill(missing_of_.begin(), missing_of_.end(), 0.0);
}

}  // namespace suite
