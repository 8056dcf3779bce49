#include "estimate/accumulators.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "base/error.h"
#include "base/memory.h"

namespace suite {

namespace {
constexpr double kRounding = 1e-12;  // relative variance of equal samples, from their sums
}

size_t Accumulators::Shape::bytes() const {
  const size_t row = bands * (missing ? 2 : 1) * sizeof(double) + (missing ? 2 * sizeof(double) : 0) +
                     truth_slots * sizeof(double) + 2 * sizeof(uint32_t) + 2 * sizeof(float) + sizeof(double);
  return problems * static_cast<size_t>(scrambles) * row;
}

Accumulators::Accumulators(const Shape& shape) : shape_(shape) {
  const size_t rows = shape.problems * static_cast<size_t>(shape.scrambles);
  resize_large(sums_, rows * shape.bands);
  resize_large(taken_, rows);
  resize_large(failures_, rows);
  resize_large(truncated_, rows);
  resize_large(largest_, rows);
  resize_large(squares_, rows);
  resize_large(truth_, rows * shape.truth_slots);
  if (!shape.missing) return;
  resize_large(missing_, rows * shape.bands);
  resize_large(missing_of_, 2 * rows);
}

void Accumulators::join(const Accumulators& part, size_t first) {
  SUITE_CHECK(first + part.problems() <= problems());
  for (size_t i = 0; i < part.problems(); ++i) join_problem(first + i, part, i);
}

void Accumulators::join_problem(size_t problem, const Accumulators& part, size_t there) {
  SUITE_CHECK(part.scrambles() <= scrambles());
  const auto into = columns();
  const auto from = part.columns();
  for (int s = 0; s < part.scrambles(); ++s) {
    if (part.taken(there, s) <= taken(problem, s)) continue;
    const size_t to = row(problem, s), of = part.row(there, s);
    for (size_t c = 0; c < kColumns; ++c) {
      SUITE_CHECK(into[c].width == from[c].width);
      if (from[c].width)
        std::memcpy(into[c].data + to * into[c].width, from[c].data + of * from[c].width, from[c].width);
    }
  }
}

uint32_t Accumulators::paths(size_t problem) const {
  uint32_t sum = 0;
  for (int s = 0; s < shape_.scrambles; ++s) sum += taken(problem, s);
  return sum;
}

void Accumulators::set_paths(size_t problem, uint32_t n) {
  for (int s = 0; s < shape_.scrambles; ++s) taken_[row(problem, s)] = dealt(n, static_cast<uint32_t>(s));
}

uint32_t Accumulators::next(size_t problem, Scrambles of) const {
  uint32_t first = UINT32_MAX;
  for (int s = 0; s < shape_.scrambles; ++s)
    if (of >> s & 1) first = std::min(first, sample_of({static_cast<uint32_t>(s), taken(problem, s)}));
  return first;
}

uint32_t Accumulators::failures(size_t problem) const {
  uint32_t sum = 0;
  for (int s = 0; s < shape_.scrambles; ++s) sum += failures(problem, s);
  return sum;
}

float Accumulators::largest(size_t problem) const {
  float most = 0;
  for (int s = 0; s < shape_.scrambles; ++s) most = std::max(most, largest_[row(problem, s)]);
  return most;
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

// One pass over values of a problem. S: scrambles. sum: theirs, from the first value on.
template <int S>
void estimate_values(const std::array<const double*, 8>& sum, const Shares& shares, double n, std::span<double> means,
                     std::span<double> errors) {
  double per[S], weight[S];
  for (int s = 0; s < S; ++s) {
    per[s] = shares.count[s] > 0 ? 1 / shares.count[s] : 0;
    weight[s] = shares.count[s] > 0 ? shares.weight[s] : 0;
  }
  const double per_sample = 1 / n;
  double* __restrict const mean = means.data();
  double* __restrict const error = errors.data();
  for (size_t b = 0; b < means.size(); ++b) {
    double total = 0, square = 0;
    for (int s = 0; s < S; ++s) total += sum[s][b];
    const double middle = total * per_sample;
    for (int s = 0; s < S; ++s) {
      const double d = sum[s][b] * per[s] - middle;
      square += weight[s] * (d * d);
    }
    mean[b] = middle;
    error[b] = std::sqrt(square);
  }
}

}  // namespace

void Accumulators::estimate(size_t problem, size_t first, std::span<double> means, std::span<double> errors) const {
  const uint32_t n = accepted(problem);
  if (!n) {
    std::fill(means.begin(), means.end(), 0.0);
    std::fill(errors.begin(), errors.end(), 0.0);
    return;
  }
  std::array<const double*, 8> sum{};
  for (int s = 0; s < shape_.scrambles; ++s) sum[static_cast<size_t>(s)] = sums(problem, s) + first;
  const Shares shares(*this, problem);
  if (shape_.scrambles == 4)
    estimate_values<4>(sum, shares, n, means, errors);
  else
    estimate_values<8>(sum, shares, n, means, errors);
  // One scramble tells nothing about its own error.
  if (shares.used < 2) std::fill(errors.begin(), errors.end(), INFINITY);
}

double Accumulators::covariance(size_t problem, size_t a, size_t b) const {
  const uint32_t n = accepted(problem);
  if (!n) return 0;
  const Shares shares(*this, problem);
  if (shares.used < 2) return 0;
  double mean_a = 0, mean_b = 0, sum = 0;
  for (int s = 0; s < shape_.scrambles; ++s) mean_a += sums(problem, s)[a] / n, mean_b += sums(problem, s)[b] / n;
  for (int s = 0; s < shape_.scrambles; ++s) {
    if (!(shares.count[s] > 0)) continue;
    const double* const of = sums(problem, s);
    sum += shares.weight[s] * (of[a] / shares.count[s] - mean_a) * (of[b] / shares.count[s] - mean_b);
  }
  return sum;
}

Accumulators::Shortfall Accumulators::shortfall(size_t problem) const {
  Shortfall of;
  const uint32_t n = accepted(problem);
  if (!n) return of;
  double truncated = 0, sum = 0, square = 0;
  for (int s = 0; s < shape_.scrambles; ++s) {
    const size_t r = row(problem, s);
    truncated += double{truncated_[r]};
    if (keeps_missing()) sum += missing_of_[2 * r], square += missing_of_[2 * r + 1];
  }
  const double share = std::min(0.999, truncated / n);
  of.cut = share / (1 - share);
  if (!(square > 0)) return of;
  const double meetings = sum * (sum / square);
  if (!(meetings >= kEnoughMeetings)) of.missing = std::min(1.0, 1 / std::sqrt(meetings));
  return of;
}

double Accumulators::missing_light(size_t problem, size_t value) const {
  double sum = 0;
  for (int s = 0; s < shape_.scrambles; ++s) sum += missing_[row(problem, s) * shape_.bands + value];
  return sum;
}

std::vector<double> Accumulators::lacking(size_t problem, std::span<const double> means) const {
  const Shortfall of = shortfall(problem);
  if (of.cut == 0 && of.missing == 0) return {};
  std::vector<double> light(means.size());
  const double missing = of.missing / accepted(problem);
  for (size_t b = 0; b < light.size(); ++b)
    light[b] = of.cut * means[b] + (of.missing > 0 ? missing * missing_light(problem, b) : 0);
  return light;
}

double Accumulators::scatter(size_t problem, double mean) const {
  const double n = accepted(problem);
  if (n < 2) return 0;
  double squares = 0;
  for (int s = 0; s < shape_.scrambles; ++s) squares += squares_[row(problem, s)];
  const double variance = squares / n - mean * mean;
  return variance > kRounding * mean * mean ? variance / (n - 1) : 0;
}

void Accumulators::clear() {
  const size_t rows = problems() * static_cast<size_t>(shape_.scrambles);
  for (const auto& c : columns())
    if (c.width) std::memset(c.data, 0, rows * c.width);
}

}  // namespace suite
