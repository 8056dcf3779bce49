#include "estimate/pooled_errors.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "base/parallel.h"

namespace suite {

namespace {

constexpr long kReach = 2;    // problems
constexpr size_t kMost = 24;  // around one

// The squares of the errors as they came in, of the rows around the one in work; those above are already changed.
class Rows {
 public:
  Rows(std::span<const double> errors, size_t width) : errors_(errors), width_(width), kept_((2 * kReach + 1) * width) {
    for (long row = 0; row < kReach; ++row) keep(row);
  }
  long rows() const { return static_cast<long>(errors_.size() / width_); }
  const double* row(long y) const { return &kept_[static_cast<size_t>(y % (2 * kReach + 1)) * width_]; }
  // Does it tell others anything? Whether it was changed already or not.
  bool is_informative(size_t problem, const PoolInput& in) const {
    return std::isfinite(errors_[problem * in.values + in.reference]);
  }
  void keep(long y) {
    if (y >= rows()) return;
    double* const to = &kept_[static_cast<size_t>(y % (2 * kReach + 1)) * width_];
    const double* const from = &errors_[static_cast<size_t>(y) * width_];
    for (size_t i = 0; i < width_; ++i) to[i] = std::isfinite(from[i]) ? from[i] * from[i] : 0;
  }

 private:
  std::span<const double> errors_;
  size_t width_;
  std::vector<double> kept_;
};

double likeness(double theirs, double mine) {
  const double octaves = std::log2(theirs / mine);
  return 1 / (1 + octaves * octaves);
}

// The problems around one: the squares of their errors, and what each counts, so that the weighted sum is the variance
// of the prior; the degrees of freedom of that, 0 where there is none.
struct Neighbours {
  std::array<const double*, kMost> square{};
  std::array<double, kMost> weight{};
  size_t count = 0;
  double degrees = 0;
};

// Returns the degrees of freedom.
double weigh(const Rows& squares, const PoolInput& in, long x, long y, Neighbours& n) {
  const long columns = in.columns;
  const auto here = static_cast<size_t>(y * columns + x);
  const double mine = in.scatter[here];
  double alike = 0, scatter = 0, like = 0, all = 0;
  n.count = 0;
  for (long v = std::max(0L, y - kReach); v <= std::min(squares.rows() - 1, y + kReach); ++v)
    for (long u = std::max(0L, x - kReach); u <= std::min(columns - 1, x + kReach); ++u) {
      if (u == x && v == y) continue;
      const auto there = static_cast<size_t>(v * columns + u);
      n.square[n.count] = squares.row(v) + static_cast<size_t>(u) * in.values;
      const double square = n.square[n.count][in.reference];
      const double theirs = in.scatter[there];
      const double w = !squares.is_informative(there, in) ? 0
                       : mine > 0 && theirs > 0           ? likeness(theirs, mine)
                                                          : mine == theirs;
      alike += w, scatter += w * theirs, like += w * square, all += square;
      n.weight[n.count++] = w;
    }
  const double own_kind = scatter > 0 ? like * mine / scatter : 0, around = in.around[here] * in.around[here];
  if (around > own_kind && all > 0) {
    std::fill_n(n.weight.begin(), n.count, around / all);
    return kPriorDegrees;
  }
  if (!(alike > 0)) return 0;
  const double share = scatter > 0 ? mine / scatter : 1 / alike;
  for (size_t k = 0; k < n.count; ++k) n.weight[k] *= share;
  return kPriorDegrees * std::min(1.0, alike);
}

// Values of a problem that are worked on together: their sums over the neighbours stay in registers, and what a row of
// problems shares in the nearest cache.
constexpr size_t kTogether = 32;

// Sums the neighbours' squares of N values from `first` on by weight; N a multiple of four.
template <size_t N>
void sum_prior(const Neighbours& around, size_t first, double* prior) {
  using Four = double __attribute__((vector_size(32), aligned(8), may_alias));
  Four sum[N / 4] = {};
  for (size_t k = 0; k < around.count; ++k) {
    const auto* const square = reinterpret_cast<const Four*>(around.square[k] + first);
    for (size_t i = 0; i < N / 4; ++i) sum[i] += around.weight[k] * square[i];
  }
  for (size_t i = 0; i < N / 4; ++i) reinterpret_cast<Four*>(prior)[i] = sum[i];
}
void sum_prior(const Neighbours& around, size_t first, size_t count, double* prior) {
  if (count == kTogether) return sum_prior<kTogether>(around, first, prior);
  std::fill_n(prior, count, 0.0);
  for (size_t k = 0; k < around.count; ++k)
    for (size_t b = 0; b < count; ++b) prior[b] += around.weight[k] * around.square[k][first + b];
}

// own: squares of the errors.
void join(const Neighbours& around, double own_degrees, const double* __restrict own, const double* __restrict prior,
          size_t count, double* __restrict error) {
  const double p = around.degrees, per = 1 / (own_degrees + p);
  for (size_t b = 0; b < count; ++b) {
    const double pooled = std::sqrt((own_degrees * own[b] + p * prior[b]) * per);
    error[b] = error[b] < INFINITY ? pooled : error[b];
  }
}

}  // namespace

void pool_errors(const PoolInput& in, double own_degrees, std::span<double> errors) {
  Rows squares(errors, in.columns * in.values);
  for (long y = 0; y < squares.rows(); ++y) {
    squares.keep(y + kReach);
    parallel_for(0, in.columns, 64, [&](size_t begin, size_t end) {
      std::vector<Neighbours> around(end - begin);
      for (size_t x = begin; x < end; ++x)
        around[x - begin].degrees = weigh(squares, in, static_cast<long>(x), y, around[x - begin]);
      std::array<double, kTogether> prior;
      for (size_t first = 0; first < in.values; first += kTogether)
        for (size_t x = begin; x < end; ++x) {
          const Neighbours& n = around[x - begin];
          if (!(n.degrees > 0)) continue;
          const size_t count = std::min(kTogether, in.values - first), at = x * in.values + first;
          sum_prior(n, first, count, prior.data());
          join(n, own_degrees, squares.row(y) + at, prior.data(), count,
               &errors[static_cast<size_t>(y) * in.columns * in.values + at]);
        }
    });
  }
}

}  // namespace suite
