#include "heat/passing_edges.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace suite {

namespace {

constexpr size_t kMost = 4;          // places' coordinates
constexpr double kRidge = 1e-9;      // of the largest variance: directions that all points share count for nothing
constexpr double kWorthwhile = 0.5;  // a line that leaves more of the scatter than this tells too little

using Matrix = std::array<std::array<double, kMost + 1>, kMost>;

// Elimination of the first n rows, which are positive definite; the last column is the right side.
std::array<double, kMost> solved(Matrix& m, size_t n) {
  for (size_t k = 0; k < n; ++k)
    for (size_t i = k + 1; i < n; ++i) {
      const double by = m[i][k] / m[k][k];
      for (size_t j = k; j <= kMost; ++j) m[i][j] -= by * m[k][j];
    }
  std::array<double, kMost> x{};
  for (size_t k = n; k-- > 0;) {
    x[k] = m[k][kMost];
    for (size_t j = k + 1; j < n; ++j) x[k] -= m[k][j] * x[j];
    x[k] /= m[k][k];
  }
  return x;
}

std::pair<bool, size_t> sequence(const PointDay& day) { return {day.lit_first, day.changes.size()}; }

}  // namespace

PassingEdges::PassingEdges(std::span<const PointDay* const> points, bool wide_sun, double finest) {
  std::map<std::pair<bool, size_t>, std::vector<const PointDay*>> by_sequence;
  for (const PointDay* p : points) by_sequence[sequence(*p)].push_back(p);
  const auto common = std::ranges::max_element(by_sequence, {}, [](const auto& entry) { return entry.second.size(); });
  if (common == by_sequence.end()) return;
  const std::vector<const PointDay*>& known = common->second;
  lit_first_ = common->first.first;
  for (const PointDay* p : known)
    for (size_t k = 0; k < kMost; ++k) centre_[k] += p->place[k] / static_cast<double>(known.size());
  for (size_t change = 0; change < common->first.second; ++change) {
    double scatter = 0, best = 0;
    Line line = fit(known, change, 0, scatter);
    best = kWorthwhile * scatter;
    for (const size_t dimensions : {size_t{2}, size_t{4}}) {
      if (known.size() < dimensions + 3 || (dimensions > 2 && !wide_sun) || !(scatter > finest * finest)) continue;
      double score = 0;
      if (const Line l = fit(known, change, dimensions, score); score < best) best = score, line = l, moves_ = true;
    }
    lines_.push_back(line);
  }
}

// score: squared scatter (s2) that is to be expected of another point (generalised cross-validation, P. Craven & G.
// Wahba, Numer. Math. 31, 1979).
PassingEdges::Line PassingEdges::fit(std::span<const PointDay* const> points, size_t change, size_t dimensions,
                                     double& score) const {
  const auto n = static_cast<double>(points.size());
  Line line;
  for (const PointDay* p : points) line.mean += p->changes[change] / n;
  Matrix m{};
  double largest = 0;
  for (const PointDay* p : points)
    for (size_t i = 0; i < dimensions; ++i) {
      const double x = p->place[i] - centre_[i];
      for (size_t j = 0; j < dimensions; ++j) m[i][j] += x * (p->place[j] - centre_[j]);
      m[i][kMost] += x * (p->changes[change] - line.mean);
      largest = std::max(largest, m[i][i]);
    }
  for (size_t i = 0; i < dimensions; ++i) m[i][i] += kRidge * largest + 1e-300;
  line.slope = solved(m, dimensions);
  score = 0;
  for (const PointDay* p : points) {
    double left = p->changes[change] - line.mean;
    for (size_t i = 0; i < dimensions; ++i) left -= line.slope[i] * (p->place[i] - centre_[i]);
    score += left * left;
  }
  const double free = n - 1 - static_cast<double>(dimensions);
  score = free > 0 ? score * n / (free * free) : INFINITY;
  return line;
}

double PassingEdges::passes(const Line& line, const std::array<double, 4>& place) const {
  double t = line.mean;
  for (size_t k = 0; k < kMost; ++k) t += line.slope[k] * (place[k] - centre_[k]);
  return t;
}

PointDay PassingEdges::at(const std::array<double, 4>& place, double begin, double end) const {
  PointDay day{place, lit_first_, {}};
  double before = begin;
  for (const Line& line : lines_) day.changes.push_back(before = std::clamp(passes(line, place), before, end));
  return day;
}

// As at() has it: a change is not before the one before it, so that the last one that has not passed hides others.
bool PassingEdges::lit_at(const std::array<double, 4>& place, double t) const {
  bool lit = lit_first_;
  for (const Line& line : lines_) {
    if (passes(line, place) > t) break;
    lit = !lit;
  }
  return lit;
}

}  // namespace suite
