#include "support/conformance.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

#include "math/sampling.h"
#include "math/stats.h"
#include "math/warps.h"

namespace suite::test {

namespace {

// A cell of the sphere in equal-area coordinates: x = azimuth / 2 pi, y = (1 - |z|) of either hemisphere. y is kept as
// the distance from the pole so that lobes around the normal are resolved, and z = 0 is always a border.
struct Cell {
  int side;  // +1 upper, -1 lower
  double x0, x1, y0, y1;
  double solid_angle() const { return 2 * kPi * (x1 - x0) * (y1 - y0); }
  Dir at(double u, double v) const {
    const double drop = y0 + (y1 - y0) * v, phi = 2 * kPi * (x0 + (x1 - x0) * u), r = std::sqrt(drop * (2 - drop));
    return {r * std::cos(phi), r * std::sin(phi), side * (1 - drop)};
  }
};

struct Point {
  int side;
  double x, y;
};
Point locate(Dir d) {
  const double turn = std::atan2(d.y, d.x) / (2 * kPi), s2 = d.x * d.x + d.y * d.y;
  return {d.z > 0 ? 1 : -1, turn < 0 ? turn + 1 : turn, s2 / (1 + std::fabs(d.z))};
}

// Which way to halve a cell so as to close in on its points: across the axis along which they lie more to one side.
bool splits_x(const Cell& c, const std::vector<Point>& points, int depth) {
  const double xm = 0.5 * (c.x0 + c.x1), ym = 0.5 * (c.y0 + c.y1), half = 0.5 * static_cast<double>(points.size());
  double left = 0, below = 0;
  for (const Point& p : points) left += p.x < xm, below += p.y < ym;
  const double dx = std::fabs(left - half), dy = std::fabs(below - half);
  return std::fabs(dx - dy) > 0.25 * half ? dx > dy : depth % 2 == 0;
}
std::pair<Cell, Cell> halves(const Cell& cell, bool split_x) {
  Cell low = cell, high = cell;
  (split_x ? low.x1 : low.y1) = split_x ? 0.5 * (cell.x0 + cell.x1) : 0.5 * (cell.y0 + cell.y1);
  (split_x ? high.x0 : high.y0) = split_x ? low.x1 : low.y1;
  return {low, high};
}

// A tree of cells, each holding at most a given share of the pilot samples.
class Cells {
 public:
  Cells(const std::vector<Point>& pilot, size_t wanted) {
    const size_t most = std::max<size_t>(1, 2 * pilot.size() / wanted);
    for (const int side : {1, -1}) {
      std::vector<Point> mine;
      std::copy_if(pilot.begin(), pilot.end(), std::back_inserter(mine),
                   [&](const Point& p) { return p.side == side; });
      roots_[side > 0 ? 0 : 1] = build({side, 0, 1, 0, 1}, mine, most, 0);
    }
  }
  size_t find(const Point& p) const {
    const Node* node = &nodes_[roots_[p.side > 0 ? 0 : 1]];
    while (node->child[0]) {
      const bool high = node->split_x ? p.x >= node->middle : p.y >= node->middle;
      node = &nodes_[node->child[high ? 1 : 0]];
    }
    return node->cell;
  }
  const std::vector<Cell>& cells() const { return cells_; }

 private:
  struct Node {
    bool split_x = false;
    double middle = 0;
    size_t child[2] = {0, 0};
    size_t cell = 0;
  };
  size_t build(const Cell& cell, std::vector<Point>& points, size_t most, int depth) {
    const size_t index = nodes_.size();
    nodes_.push_back({});
    if (points.size() <= most || depth >= 60) {
      nodes_[index].cell = cells_.size();
      cells_.push_back(cell);
      return index;
    }
    const bool split_x = splits_x(cell, points, depth);
    const auto [low, high] = halves(cell, split_x);
    const double middle = split_x ? low.x1 : low.y1;
    std::vector<Point> below, above;
    for (const Point& p : points) ((split_x ? p.x : p.y) < middle ? below : above).push_back(p);
    points.clear();
    const size_t a = build(low, below, most, depth + 1), b = build(high, above, most, depth + 1);
    nodes_[index] = {split_x, middle, {a, b}, 0};
    return index;
  }
  std::vector<Node> nodes_{Node{}};  // index 0 is unused so that child 0 means "leaf"
  size_t roots_[2] = {0, 0};
  std::vector<Cell> cells_;
};

// Integral of f over a cell by adaptive subdivision of 3 x 3 Gauss points. Wherever more than two pilot samples lie
// together the cell is halved in any case, or a narrow lobe would fall between the nodes. The tolerance is that of
// every piece: densities that jump (cells) leave errors of either sign, which average out over their many pieces.
double integrate(const std::function<double(Dir)>& f, const Cell& cell, const std::vector<Point>& pilot,
                 double tolerance, int depth, int blind = 0) {
  static constexpr double node[3] = {0.11270166537925831, 0.5, 0.88729833462074169},
                          weight[3] = {5.0 / 18, 8.0 / 18, 5.0 / 18};
  auto gauss = [&](const Cell& c) {
    double sum = 0;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) sum += weight[i] * weight[j] * f(c.at(node[i], node[j]));
    return sum * c.solid_angle();
  };
  const bool guided = pilot.size() > 2 && depth < 100;
  const bool split_x = guided ? splits_x(cell, pilot, depth) : depth % 2 == 0;
  const auto [low, high] = halves(cell, split_x);
  if (!guided) {
    // Compare with the halves both ways: one way alone is blind to a kink along the other.
    const auto [low2, high2] = halves(cell, !split_x);
    const double whole = gauss(cell), one = gauss(low) + gauss(high), two = gauss(low2) + gauss(high2);
    if (blind >= 14 || std::max(std::fabs(one - whole), std::fabs(two - whole)) < tolerance) return one;
  }
  std::vector<Point> below, above;
  for (const Point& p : pilot) ((split_x ? p.x < low.x1 : p.y < low.y1) ? below : above).push_back(p);
  return integrate(f, low, below, tolerance, depth + 1, blind + !guided) +
         integrate(f, high, above, tolerance, depth + 1, blind + !guided);
}

// How far an estimate lies beyond a tolerance, in standard errors.
double excess(double mean, double expected, double tolerance, double standard_error) {
  const double beyond = std::fabs(mean - expected) - tolerance;
  return beyond <= 0 ? 0 : standard_error > 0 ? beyond / standard_error : 1e9;
}

// Bookkeeping of one run.
class Run {
 public:
  Run(const ScatterModel& model, const SpectralState& state, Dir out, int knot, const ConformanceOptions& options)
      : model_(model),
        state_(state),
        out_(out),
        knot_(knot),
        o_(options),
        w_(state.size()),
        p_(state.knots.size()),
        total_(state.size()),
        weights_(state.size()) {}

  ConformanceResult operator()() {
    model_.total(out_, total_);
    for (const float t : total_)
      if (!(t >= 0) || !std::isfinite(t)) result_.fault = strf("total = %g", static_cast<double>(t));
    const Cells cells = shape_cells();
    std::vector<double> observed(cells.cells().size()), expected(cells.cells().size());
    double deltas = 0;
    Pcg32 random(o_.seed, 2);
    for (uint64_t n = 0; n < o_.samples; ++n) {
      const auto drawn = draw(random);
      const size_t knot = drawn.first;
      if (!drawn.second) {
        for (RunningStats& s : weights_) s.add(0);
        continue;
      }
      if (drawn.second->delta)
        deltas += 1, weigh_delta(*drawn.second, knot);
      else
        observed[cells.find(locate(drawn.second->in))] += 1, weigh(*drawn.second, knot);
    }
    judge_directions(cells, observed, expected, deltas);
    judge_totals();
    return result_;
  }

 private:
  std::pair<size_t, std::optional<ScatterModel::Sample>> draw(Pcg32& random) {
    const size_t knots = state_.knots.size();
    const size_t knot = knot_ >= 0
                            ? static_cast<size_t>(knot_)
                            : std::min(knots - 1, static_cast<size_t>(random.uniform() * static_cast<double>(knots)));
    const Vec2 u{random.uniform(), random.uniform()};
    return {knot, model_.sample(out_, u, random.uniform(), static_cast<int>(knot))};
  }
  Cells shape_cells() {
    Pcg32 random(o_.seed, 1);
    for (uint64_t n = 0; n < o_.pilot; ++n)
      if (const auto s = draw(random).second; s && !s->delta) pilot_.push_back(locate(s->in));
    return Cells(pilot_, o_.cells);
  }
  // Density of what was drawn: of the knot, or the mean over the knots when the knot is drawn too.
  double density(std::span<const float> p) const {
    if (knot_ >= 0) return p[static_cast<size_t>(knot_)];
    double sum = 0;
    for (const float x : p) sum += x;
    return sum / static_cast<double>(p.size());
  }
  void weigh(const ScatterModel::Sample& s, size_t knot) {
    model_.eval(out_, s.in, w_);
    model_.pdf(out_, s.in, p_);
    const double p = density(p_);
    if (!(p > 0) || !std::isfinite(p)) result_.fault = strf("a sampled direction has pdf %g", p);
    if (std::fabs(length(s.in) - 1) > 1e-9) result_.fault = strf("a sampled direction has length %.12g", length(s.in));
    add_weights(p, knot);
  }
  void weigh_delta(const ScatterModel::Sample& s, size_t knot) {
    model_.delta_weight(out_, s.lobe, static_cast<int>(knot), w_);
    model_.delta_probability(out_, s.lobe, static_cast<int>(knot), p_);
    const double p = density(p_);
    if (!(p > 0) || p > 1 + 1e-6) result_.fault = strf("a sampled Dirac lobe has probability %g", p);
    add_weights(p, knot);
  }
  void add_weights(double p, size_t knot) {
    for (size_t i = 0; i < w_.size(); ++i) {
      if (!(w_[i] >= 0) || !std::isfinite(w_[i])) result_.fault = strf("w = %g", static_cast<double>(w_[i]));
      weights_[i].add(p > 0 ? w_[i] / p : 0);
    }
    result_.worst_weight = std::max(result_.worst_weight, p > 0 ? w_[state_.knots[knot]] / p : 0.0);
  }
  void judge_directions(const Cells& cells, std::vector<double>& observed, std::vector<double>& expected,
                        double deltas) {
    const std::function<double(Dir)> f = [&](Dir in) {
      model_.pdf(out_, in, p_);
      for (const float p : p_)
        if (!(p >= 0) || !std::isfinite(p)) result_.fault = strf("pdf = %g", static_cast<double>(p));
      return density(p_);
    };
    const double n = static_cast<double>(o_.samples);
    double captured = 0, mass = 0;
    std::vector<std::vector<Point>> pilots(expected.size());
    for (const Point& p : pilot_) pilots[cells.find(p)].push_back(p);
    for (size_t c = 0; c < expected.size(); ++c) {
      expected[c] = integrate(f, cells.cells()[c], pilots[c], 1e-4 / static_cast<double>(expected.size()), 0);
      mass += expected[c];
      captured += observed[c];
    }
    // The share that is captured is one question, how it is spread another: conditional on the number captured.
    const double share = mass + deltas / n;
    result_.lost_z = excess(captured / n + deltas / n, share, o_.total_tolerance,
                            std::sqrt(std::max(share * (1 - share), 1e-6) / n));
    if (captured == 0) return;
    // A cell that the quadrature finds empty may still hold a few samples of a corner it cannot see: 1e-6 of all.
    for (double& e : expected) e = std::max(e * captured / mass, 1e-6 * n);
    result_.chi_square_p = chi_square_test(observed, expected, 20, &result_.degrees);
  }
  void judge_totals() {
    for (size_t i = 0; i < weights_.size(); ++i) {
      // One knot's samples answer for that knot's wavelength only: elsewhere the weights may be unbounded.
      if (knot_ >= 0 && i != state_.knots[static_cast<size_t>(knot_)]) continue;
      result_.total_z = std::max(result_.total_z,
                                 excess(weights_[i].mean(), total_[i], o_.total_tolerance * std::max(total_[i], 1e-3f),
                                        weights_[i].stderr_of_mean()));
    }
  }

  const ScatterModel& model_;
  const SpectralState& state_;
  Dir out_;
  int knot_;
  ConformanceOptions o_;
  std::vector<float> w_, p_, total_;
  std::vector<RunningStats> weights_;
  std::vector<Point> pilot_;
  ConformanceResult result_;
};

}  // namespace

bool ConformanceResult::passes(const ConformanceOptions& o) const {
  return fault.empty() && chi_square_p >= o.significance && normal_two_sided(lost_z) >= o.significance &&
         normal_two_sided(total_z) >= o.significance;
}

std::string ConformanceResult::text() const {
  return strf("chi-square p = %.3g (%d degrees), lost z = %.2f, total z = %.2f, largest weight %.3g%s%s", chi_square_p,
              degrees, lost_z, total_z, worst_weight, fault.empty() ? "" : ", fault: ", fault.c_str());
}

ConformanceResult conform(const ScatterModel& model, const SpectralState& state, Dir out, int knot,
                          const ConformanceOptions& options) {
  return Run(model, state, out, knot, options)();
}

double worst_reciprocity_error(const ScatterModel& model, const SpectralState& state, int pairs, uint64_t seed) {
  std::vector<float> there(state.size()), back(state.size());
  Pcg32 random(seed);
  double worst = 0;
  for (int n = 0; n < pairs; ++n) {
    Dir a = cosine_hemisphere({random.uniform(), random.uniform()}),
        b = cosine_hemisphere({random.uniform(), random.uniform()});
    if (n % 2) {  // narrow lobes: stay near the mirror direction
      const Dir around{-a.x, -a.y, a.z};
      b = normalized(around + (b - Dir{0, 0, 1}) * 1e-2);
    }
    if (!(a.z > 1e-3 && b.z > 1e-3)) continue;
    model.eval(a, b, there);
    model.eval(b, a, back);
    for (size_t i = 0; i < there.size(); ++i) {
      const double f = there[i] / b.z, g = back[i] / a.z;
      if (f + g > 1e-20) worst = std::max(worst, std::fabs(f - g) / (f + g));
    }
  }
  return worst;
}

SpectralState test_state(size_t knots) {
  const std::vector<Band> bands{Band::rectangular("b", 0.45, 0.02), Band::rectangular("r", 0.65, 0.02),
                                Band::rectangular("n", 0.85, 0.02), Band::rectangular("s", 1.65, 0.02)};
  return make_state(bands, 0.02, 0.65, knots);
}

std::vector<Dir> test_directions(const ScatterModel& model) {
  std::vector<Dir> d;
  for (const double deg : {0.0, 20.0, 60.0, 80.0, 89.9}) d.push_back(dir_from_angles(deg * kDegree, 0.4));
  if (model.opaque()) d.push_back(dir_from_angles((180 - 35) * kDegree, 0.4));
  for (size_t i = 0; i < 5 && !model.opaque(); ++i) d.push_back({d[i].x, d[i].y, -d[i].z});
  return d;
}

}  // namespace suite::test
