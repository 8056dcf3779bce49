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
  const double* of(size_t problem, size_t columns, size_t values) const {
    return row(static_cast<long>(problem / columns)) + problem % columns * values;
  }
  // Does it tell others anything? Whether it was changed already or not.
  bool tells(size_t problem, const PoolInput& in) const {
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

// The problems around one, and what each counts.
struct Neighbours {
  std::array<size_t, kMost> problem{};
  std::array<double, kMost> weight{};
  size_t count = 0;
};

// Weights such that the weighted sum of the squares of errors is the prior's variance; returns its degrees of freedom,
// 0 where there is none.
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
      const double square = squares.row(v)[static_cast<size_t>(u) * in.values + in.reference];
      const double theirs = in.scatter[there];
      const double w = !squares.tells(there, in) ? 0 : mine > 0 && theirs > 0 ? likeness(theirs, mine) : mine == theirs;
      alike += w, scatter += w * theirs, like += w * square, all += square;
      n.problem[n.count] = there, n.weight[n.count++] = w;
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

}  // namespace

void pool_errors(const PoolInput& in, double own_degrees, std::span<double> errors) {
  Rows squares(errors, in.columns * in.values);
  for (long y = 0; y < squares.rows(); ++y) {
    squares.keep(y + kReach);
    parallel_for(0, in.columns, 64, [&](size_t begin, size_t end) {
      std::vector<double> prior(in.values);
      Neighbours around;
      for (size_t x = begin; x < end; ++x) {
        const double p = weigh(squares, in, static_cast<long>(x), y, around);
        if (!(p > 0)) continue;
        std::fill(prior.begin(), prior.end(), 0.0);
        for (size_t k = 0; k < around.count; ++k) {
          const double* const square = squares.of(around.problem[k], in.columns, in.values);
          for (size_t b = 0; b < in.values; ++b) prior[b] += around.weight[k] * square[b];
        }
        const double* const own = squares.row(y) + x * in.values;
        double* const error = &errors[(static_cast<size_t>(y) * in.columns + x) * in.values];
        for (size_t b = 0; b < in.values; ++b)
          if (std::isfinite(error[b])) error[b] = std::sqrt((own_degrees * own[b] + p * prior[b]) / (own_degrees + p));
      }
    });
  }
}

}  // namespace suite
