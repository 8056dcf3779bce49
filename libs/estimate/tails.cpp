#include "estimate/tails.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/parallel.h"
#include "estimate/around.h"
#include "sensor/quality.h"

namespace suite {

namespace {

constexpr long kNear = 2, kReach = 4;  // problems
constexpr double kFew = 12;            // events like the largest
constexpr double kLarge = 3;           // times the mean
constexpr uint32_t kFewestPaths = 16;  // below, the largest of them tells nothing about tails
constexpr double kPossible = 2;        // standard errors of a Poisson count; samples that an even deal may hide
constexpr double kAgreement = 0.1;     // of what one sample moves the mean by
constexpr double kBeyondOthers = 3;    // most of it, by the standard error that the neighbours saw

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
  return s.paths >= kFewestPaths && s.sampled < kAgreement * effect ? kPossible * effect : 0;
}

double least_excess(const TailSums& s) { return s.share * std::max(s.mean, s.floor); }

// The largest variance in each problem's window: most problems need no closer look.
std::vector<double> largest_around(const SeenGrid& g) {
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

SeenGrid grid_of(std::span<const TailSums> of, long columns) {
  SeenGrid g{columns, static_cast<long>(of.size()) / columns, std::vector<Seen>(of.size())};
  for (size_t i = 0; i < of.size(); ++i) {
    g.seen[i].mean = of[i].mean;
    if (!std::isfinite(of[i].sampled)) continue;
    g.seen[i].square = std::pow(std::max(of[i].sampled, error_of_few(of[i])), 2);
    g.seen[i].variance = g.seen[i].square * of[i].paths;
  }
  return g;
}

// Does a standard error of `possible` exceed the reported one by more than the flag allows?
bool exceeds(double possible, const TailSums& s) { return possible > kTailFactor * s.error + least_excess(s); }

void flag_by_neighbours(std::span<const TailSums> of, long columns, std::span<uint8_t> quality) {
  const SeenGrid g = grid_of(of, columns);
  const std::vector<double> most = largest_around(g);
  parallel_for(0, static_cast<size_t>(g.rows), 8, [&](size_t begin, size_t end) {
    for (long y = static_cast<long>(begin); y < static_cast<long>(end); ++y)
      for (long x = 0; x < columns; ++x) {
        const auto i = static_cast<size_t>(y * columns + x);
        const TailSums& s = of[i];
        const double few = error_of_few(s), reach = few > 0 ? kBeyondOthers : 1;
        if (!s.paths || !exceeds(reach * std::sqrt(most[i] / s.paths), s)) continue;
        const double theirs = std::sqrt(variance_around(g, x, y, least_excess(s), kReach) / s.paths);
        if (exceeds(std::max(theirs, std::min(kPossible * few, kBeyondOthers * theirs)), s))
          quality[i] |= quality_heavy_tail;
      }
  });
}

}  // namespace

std::vector<double> errors_around(std::span<const TailSums> of, uint32_t columns) {
  const SeenGrid g = grid_of(of, columns);
  std::vector<double> errors(of.size());
  parallel_for(0, static_cast<size_t>(g.rows), 8, [&](size_t begin, size_t end) {
    for (size_t i = begin * columns; i < end * columns; ++i)
      if (of[i].paths) {
        const long x = static_cast<long>(i % columns), y = static_cast<long>(i / columns);
        // Light so rare that on some side nobody near met it: further out somebody did.
        double variance = variance_around(g, x, y, least_excess(of[i]), kNear);
        if (!(variance > 0)) variance = variance_around(g, x, y, least_excess(of[i]), kReach);
        // A standard error of 0 is wrong where anybody like it saw something.
        if (!(variance > 0) && !(of[i].sampled > 0)) variance = variance_nearby(g, x, y, least_excess(of[i]));
        errors[i] = std::sqrt(variance / of[i].paths);
      }
  });
  return errors;
}

void flag_heavy_tails(std::span<const TailSums> of, uint32_t columns, bool neighbours, std::span<uint8_t> quality) {
  for (size_t i = 0; i < of.size(); ++i) {
    const double own = neighbours ? 0 : kPossible * error_of_few(of[i]);
    if (of[i].paths && exceeds(std::max(own, error_of_agreement(of[i])), of[i])) quality[i] |= quality_heavy_tail;
  }
  if (neighbours) flag_by_neighbours(of, columns, quality);
}

}  // namespace suite
