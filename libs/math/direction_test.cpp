#include "math/direction_test.h"

#include <algorithm>
#include <cmath>

#include "math/stats.h"

namespace suite {

namespace {

// A cell of the sphere in equal-area coordinates: x = azimuth / 2 pi, y = (1 - |z|) of either hemisphere. y is kept as
// the distance from the pole so that lobes around the normal are resolved, and z = 0 is always a border.
struct Cell {
  int side;  // +1 upper, -1 lower
  double x0, x1, y0, y1;
  double solid_angle() const { return 2 * kPi * (x1 - x0) * (y1 - y0); }
};

// Integral of f over a cell by 3 x 3 Gauss points.
double gauss(const std::function<double(Dir)>& f, const Cell& c) {
  static constexpr double node[3] = {0.11270166537925831, 0.5, 0.88729833462074169},
                          weight[3] = {5.0 / 18, 8.0 / 18, 5.0 / 18};
  double drop[3], radius[3];
  for (int j = 0; j < 3; ++j) drop[j] = c.y0 + (c.y1 - c.y0) * node[j], radius[j] = std::sqrt(drop[j] * (2 - drop[j]));
  double sum = 0;
  for (int i = 0; i < 3; ++i) {
    const double phi = 2 * kPi * (c.x0 + (c.x1 - c.x0) * node[i]), x = std::cos(phi), y = std::sin(phi);
    for (int j = 0; j < 3; ++j)
      sum += weight[i] * weight[j] * f({radius[j] * x, radius[j] * y, c.side * (1 - drop[j])});
  }
  return sum * c.solid_angle();
}

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
  const bool guided = pilot.size() > 2 && depth < 100;
  const bool split_x = guided ? splits_x(cell, pilot, depth) : depth % 2 == 0;
  const auto [low, high] = halves(cell, split_x);
  if (!guided) {
    // Compare with the halves both ways: one way alone is blind to a kink along the other.
    const double whole = gauss(f, cell), one = gauss(f, low) + gauss(f, high);
    const auto agree_across = [&] {
      const auto [low2, high2] = halves(cell, !split_x);
      return std::fabs(gauss(f, low2) + gauss(f, high2) - whole) < tolerance;
    };
    if (blind >= 14 || (std::fabs(one - whole) < tolerance && agree_across())) return one;
  }
  std::vector<Point> below, above;
  for (const Point& p : pilot) ((split_x ? p.x < low.x1 : p.y < low.y1) ? below : above).push_back(p);
  return integrate(f, low, below, tolerance, depth + 1, blind + !guided) +
         integrate(f, high, above, tolerance, depth + 1, blind + !guided);
}

std::vector<Point> located(const std::vector<Dir>& dirs) {
  std::vector<Point> points;
  for (const Dir& d : dirs) points.push_back(locate(d));
  return points;
}

}  // namespace

struct DirectionHistogram::Impl {
  Impl(const std::vector<Dir>& pilot_dirs, size_t wanted)
      : pilot(located(pilot_dirs)), cells(pilot, wanted), observed(cells.cells().size()) {}
  std::vector<Point> pilot;
  Cells cells;
  std::vector<double> observed;
};

DirectionHistogram::DirectionHistogram(const std::vector<Dir>& pilot, size_t cells)
    : impl_(std::make_unique<Impl>(pilot, cells)) {}
DirectionHistogram::~DirectionHistogram() = default;

void DirectionHistogram::add(Dir d) { impl_->observed[impl_->cells.find(locate(d))] += 1; }

DirectionHistogram::Verdict DirectionHistogram::judge(const std::function<double(Dir)>& density, double samples) const {
  const size_t n = impl_->observed.size();
  std::vector<std::vector<Point>> pilots(n);
  for (const Point& p : impl_->pilot) pilots[impl_->cells.find(p)].push_back(p);
  std::vector<double> expected(n);
  Verdict v;
  for (size_t c = 0; c < n; ++c) {
    expected[c] = integrate(density, impl_->cells.cells()[c], pilots[c], 1e-4 / static_cast<double>(n), 0);
    v.mass += expected[c];
    v.added += impl_->observed[c];
  }
  if (v.added == 0) return v;
  // A cell that the quadrature finds empty may still hold a few samples of a corner it cannot see: 1e-6 of all.
  for (double& e : expected) e = std::max(v.mass > 0 ? e * v.added / v.mass : 0.0, 1e-6 * samples);
  v.p_value = chi_square_test(impl_->observed, expected, 20, &v.degrees);
  return v;
}

}  // namespace suite
