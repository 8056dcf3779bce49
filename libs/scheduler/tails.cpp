#include "scheduler/tails.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "base/parallel.h"
#include "sensor/quality.h"

namespace suite {

namespace {

constexpr long kReach = 4;             // problems
constexpr double kAlike = 4;           // joint standard errors
constexpr double kFew = 12;            // events like the largest
constexpr double kLarge = 3;           // times the mean
constexpr uint32_t kFewestPaths = 16;  // below, the largest of them tells nothing about tails
constexpr double kPossible = 2;        // standard errors of a Poisson count; samples that an even deal may hide
constexpr double kAgreement = 0.1;     // of what one sample moves the mean by
constexpr double kBeyondOthers = 3;    // most of it, by the standard error that the neighbours saw
constexpr size_t kHalfPlanes = 8;

// Standard error after Poisson of a problem whose light is a few events; 0 for others.
double error_of_few(const TailSums& s) {
  const double n = s.paths, largest = s.largest;
  if (s.paths < kFewestPaths || !(largest > kLarge * s.mean) || !(n * s.mean < kFew * largest)) return 0;
  const double count = n * s.mean / largest, effect = (largest - s.mean) / n;
  return std::sqrt(count + 1) * effect;
}

// Standard error of a problem whose scrambles agree better than a tenth of what one sample moves the mean by: samples
// of few values dealt evenly, as an edge through a problem leaves them; 0 for others.
double error_of_agreement(const TailSums& s) {
  const double effect = (s.largest - s.mean) / s.paths;
  return s.paths >= kFewestPaths && s.error < kAgreement * effect ? kPossible * effect : 0;
}

double least_excess(const TailSums& s) { return s.share * std::max(s.mean, s.floor); }

// A problem as its neighbours see it.
struct Seen {
  double mean = 0, square = 0;  // square: of the standard error, that of few events where it is more
  double variance = 0;          // of one path, with that error
};

// A place in the window, and the half-planes that hold it.
struct Offset {
  long x, y;
  std::array<bool, kHalfPlanes> in;
};

const std::vector<Offset>& window() {
  static const std::vector<Offset> all = [] {
    constexpr std::array<std::array<long, 2>, kHalfPlanes> normals{
        {{1, 0}, {-1, 0}, {0, 1}, {0, -1}, {1, 1}, {-1, -1}, {1, -1}, {-1, 1}}};
    std::vector<Offset> made;
    for (long y = -kReach; y <= kReach; ++y)
      for (long x = -kReach; x <= kReach; ++x) {
        if (x == 0 && y == 0) continue;
        Offset o{x, y, {}};
        const bool beside = std::max(std::labs(x), std::labs(y)) == 1;
        for (size_t h = 0; h < kHalfPlanes; ++h) {
          const long side = normals[h][0] * x + normals[h][1] * y;
          o.in[h] = side > 0 || (side == 0 && beside);
        }
        made.push_back(o);
      }
    return made;
  }();
  return all;
}

struct Grid {
  long columns, rows;
  std::vector<Seen> seen;
};

// The least of the mean variances over the alike neighbours of each half-plane. A half-plane of which the picture holds
// less than a third of what it holds of another does not count. same: difference of means that is none.
double variance_around(const Grid& g, long x, long y, double same) {
  const Seen& here = g.seen[static_cast<size_t>(y * g.columns + x)];
  std::array<double, kHalfPlanes> sum{};
  std::array<int, kHalfPlanes> alike{}, there_are{};
  for (const Offset& o : window()) {
    const long u = x + o.x, v = y + o.y;
    if (u < 0 || v < 0 || u >= g.columns || v >= g.rows) continue;
    const Seen& there = g.seen[static_cast<size_t>(v * g.columns + u)];
    const double apart = std::fabs(there.mean - here.mean) - same;
    const bool counts = !(apart > 0) || apart * apart <= kAlike * kAlike * (there.square + here.square);
    for (size_t h = 0; h < kHalfPlanes; ++h) {
      there_are[h] += o.in[h];
      alike[h] += o.in[h] && counts;
      sum[h] += o.in[h] && counts ? there.variance : 0;
    }
  }
  const int most = *std::max_element(there_are.begin(), there_are.end());
  double least = INFINITY;
  for (size_t h = 0; h < kHalfPlanes; ++h)
    if (there_are[h] && 3 * there_are[h] >= most) least = std::min(least, sum[h] / std::max(alike[h], 1));
  return std::isfinite(least) ? least : 0;
}

// The largest variance in each problem's window: most problems need no closer look.
std::vector<double> largest_around(const Grid& g) {
  std::vector<double> along(g.seen.size()), largest(g.seen.size());
  const auto at = [&](long x, long y) { return static_cast<size_t>(y * g.columns + x); };
  parallel_for(0, static_cast<size_t>(g.rows), 16, [&](size_t begin, size_t end) {
    for (long y = static_cast<long>(begin); y < static_cast<long>(end); ++y)
      for (long x = 0; x < g.columns; ++x)
        for (long u = std::max(0L, x - kReach); u <= std::min(g.columns - 1, x + kReach); ++u)
          along[at(x, y)] = std::max(along[at(x, y)], g.seen[at(u, y)].variance);
  });
  parallel_for(0, static_cast<size_t>(g.rows), 16, [&](size_t begin, size_t end) {
    for (long y = static_cast<long>(begin); y < static_cast<long>(end); ++y)
      for (long v = std::max(0L, y - kReach); v <= std::min(g.rows - 1, y + kReach); ++v)
        for (long x = 0; x < g.columns; ++x) largest[at(x, y)] = std::max(largest[at(x, y)], along[at(x, v)]);
  });
  return largest;
}

// Does a standard error of `possible` exceed the reported one by more than the flag allows?
bool exceeds(double possible, const TailSums& s) { return possible > kTailFactor * s.error + least_excess(s); }

void flag_by_neighbours(std::span<const TailSums> of, long columns, std::span<uint8_t> quality) {
  Grid g{columns, static_cast<long>(of.size()) / columns, std::vector<Seen>(of.size())};
  for (size_t i = 0; i < of.size(); ++i) {
    g.seen[i].mean = of[i].mean;
    if (!std::isfinite(of[i].error)) continue;
    g.seen[i].square = std::pow(std::max(of[i].error, error_of_few(of[i])), 2);
    g.seen[i].variance = g.seen[i].square * of[i].paths;
  }
  const std::vector<double> most = largest_around(g);
  parallel_for(0, static_cast<size_t>(g.rows), 8, [&](size_t begin, size_t end) {
    for (long y = static_cast<long>(begin); y < static_cast<long>(end); ++y)
      for (long x = 0; x < columns; ++x) {
        const auto i = static_cast<size_t>(y * columns + x);
        const TailSums& s = of[i];
        const double few = error_of_few(s), reach = few > 0 ? kBeyondOthers : 1;
        if (!s.paths || !exceeds(reach * std::sqrt(most[i] / s.paths), s)) continue;
        const double theirs = std::sqrt(variance_around(g, x, y, least_excess(s)) / s.paths);
        if (exceeds(std::max(theirs, std::min(kPossible * few, kBeyondOthers * theirs)), s))
          quality[i] |= quality_heavy_tail;
      }
  });
}

}  // namespace

void flag_heavy_tails(std::span<const TailSums> of, uint32_t columns, bool neighbours, std::span<uint8_t> quality) {
  for (size_t i = 0; i < of.size(); ++i) {
    const double own = neighbours ? 0 : kPossible * error_of_few(of[i]);
    if (of[i].paths && exceeds(std::max(own, error_of_agreement(of[i])), of[i])) quality[i] |= quality_heavy_tail;
  }
  if (neighbours) flag_by_neighbours(of, columns, quality);
}

}  // namespace suite
