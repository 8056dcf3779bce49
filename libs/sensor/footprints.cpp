#include "sensor/footprints.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "base/error.h"

namespace suite {

namespace {

constexpr double kLeastSeen = 0.5;  // of a cell
constexpr double kLayer = 1.5;      // edges of a cell or a footprint: what lies so far below the top is another layer
constexpr int kWindow = 4;          // neighbours to either side that say which distance is usual here

using Quad = std::array<Vec2, 4>;

Vec2 plus(Vec2 a, Vec2 b, double share) { return {a.x + share * b.x, a.y + share * b.y}; }
Vec2 minus(Vec2 a, Vec2 b) { return {a.x - b.x, a.y - b.y}; }
double edge(Vec2 a) { return std::hypot(a.x, a.y); }

// A convex polygon cut by the half-plane on one side of a line along an axis.
template <size_t kMost>
struct Polygon {
  std::array<Vec2, kMost> corner;
  size_t count = 0;
  void cut(bool along_x, double at, double keep) {
    Polygon out;
    const auto inside = [&](Vec2 p) { return keep * ((along_x ? p.x : p.y) - at); };
    for (size_t i = 0; i < count; ++i) {
      const Vec2 a = corner[i], b = corner[(i + 1) % count];
      const double u = inside(a), v = inside(b);
      if (u >= 0) out.corner[out.count++] = a;
      if ((u < 0) != (v < 0)) out.corner[out.count++] = plus(a, minus(b, a), u / (u - v));
    }
    *this = out;
  }
  double area() const {
    double twice = 0;
    for (size_t i = 0; i < count; ++i) {
      const Vec2 a = minus(corner[i], corner[0]), b = minus(corner[(i + 1) % count], corner[0]);
      twice += a.x * b.y - a.y * b.x;
    }
    return 0.5 * std::fabs(twice);
  }
};

// Neighbours of a picture, and which of them show the same surface.
class Picture {
 public:
  Picture(std::span<const Vec2> places, uint32_t columns)
      : places_(places), columns_(columns), rows_(static_cast<int64_t>(places.size() / columns)) {}
  int64_t rows() const { return rows_; }
  int64_t columns() const { return columns_; }
  bool known(int64_t c, int64_t r) const {
    return c >= 0 && r >= 0 && c < columns_ && r < rows_ && std::isfinite(at(c, r).x);
  }
  Vec2 at(int64_t c, int64_t r) const { return places_[static_cast<size_t>(r * columns_ + c)]; }
  // Whether a pixel and the next one along an axis belong together: no further apart than kFarthest times what is usual
  // around them.
  bool joined(int64_t c, int64_t r, bool along_line, int64_t step) const {
    const int64_t dc = along_line ? 1 : 0, dr = 1 - dc;
    if (step < 0) c -= dc, r -= dr;
    if (!known(c, r) || !known(c + dc, r + dr)) return false;
    std::array<double, 2 * kWindow + 1> around;
    size_t n = 0;
    for (int64_t k = -kWindow; k <= kWindow; ++k)
      if (known(c + k * dc, r + k * dr) && known(c + (k + 1) * dc, r + (k + 1) * dr))
        around[n++] = edge(minus(at(c + (k + 1) * dc, r + (k + 1) * dr), at(c + k * dc, r + k * dr)));
    const auto middle = around.begin() + static_cast<long>(n / 2);
    std::nth_element(around.begin(), middle, around.begin() + static_cast<long>(n));
    return edge(minus(at(c + dc, r + dr), at(c, r))) <= kFarthest * *middle;
  }

 private:
  std::span<const Vec2> places_;
  int64_t columns_, rows_;
};

// The way from a pixel to its neighbour along an axis; from what it is to the other side where that one is torn off.
std::optional<Vec2> way(const Picture& p, int64_t c, int64_t r, bool along_line, int64_t step) {
  const int64_t dc = along_line ? step : 0, dr = along_line ? 0 : step;
  if (p.joined(c, r, along_line, step)) return minus(p.at(c + dc, r + dr), p.at(c, r));
  if (p.joined(c, r, along_line, -step)) return minus(p.at(c, r), p.at(c - dc, r - dr));
  return std::nullopt;
}

// Nothing for a pixel without any neighbour along one of the axes.
std::optional<Quad> footprint(const Picture& p, int64_t c, int64_t r) {
  if (!p.known(c, r)) return std::nullopt;
  Quad quad;
  constexpr int64_t kCorner[4][2] = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
  for (size_t i = 0; i < 4; ++i) {
    const auto [dc, dr] = kCorner[i];
    const bool together = p.joined(c, r, true, dc) && p.joined(c, r, false, dr) && p.joined(c, r + dr, true, dc) &&
                          p.joined(c + dc, r, false, dr);
    if (together) {
      const Vec2 a = p.at(c, r), b = p.at(c + dc, r), d = p.at(c, r + dr), e = p.at(c + dc, r + dr);
      quad[i] = {(a.x + b.x + d.x + e.x) / 4, (a.y + b.y + d.y + e.y) / 4};
      continue;
    }
    const auto along = way(p, c, r, true, dc), across = way(p, c, r, false, dr);
    if (!along || !across) return std::nullopt;
    quad[i] = plus(plus(p.at(c, r), *along, 0.5), *across, 0.5);
  }
  return quad;
}

// Calls `to` (cell, area as a share of the cell) for all cells that a footprint meets.
template <class To>
void share_out(const Quad& quad, const GroundGrid& g, To&& to) {
  const auto [west, east] = std::minmax({quad[0].x, quad[1].x, quad[2].x, quad[3].x});
  const auto [south, north] = std::minmax({quad[0].y, quad[1].y, quad[2].y, quad[3].y});
  const auto index = [&](double away, uint32_t most) {
    return static_cast<int64_t>(std::clamp(std::floor(away / g.cell), -1.0, static_cast<double>(most)));
  };
  const int64_t c0 = std::max<int64_t>(index(west - g.west, g.columns), 0),
                c1 = std::min<int64_t>(index(east - g.west, g.columns), g.columns - 1),
                r0 = std::max<int64_t>(index(g.north - north, g.rows), 0),
                r1 = std::min<int64_t>(index(g.north - south, g.rows), g.rows - 1);
  for (int64_t r = r0; r <= r1; ++r) {
    // Cells as the unit, from the corner of the row's first one: areas are shares of a cell.
    Polygon<12> row;
    for (const Vec2 p : quad)
      row.corner[row.count++] = {(p.x - g.west) / g.cell, (g.north - p.y) / g.cell - static_cast<double>(r)};
    row.cut(false, 0, 1), row.cut(false, 1, -1);
    for (int64_t c = c0; c <= c1 && row.count; ++c) {
      Polygon<12> cell = row;
      cell.cut(true, static_cast<double>(c), 1), cell.cut(true, static_cast<double>(c + 1), -1);
      if (const double area = cell.count ? cell.area() : 0; area > 1e-6)
        to(static_cast<size_t>(r) * g.columns + static_cast<size_t>(c), static_cast<float>(area));
    }
  }
}

double size_of(const Quad& q) { return std::max(edge(minus(q[2], q[0])), edge(minus(q[3], q[1]))) / std::sqrt(2.0); }

}  // namespace

Footprints::Footprints(std::span<const Vec2> places, std::span<const double> heights_m, uint32_t columns,
                       const GroundGrid& grid, double unit_m) {
  SUITE_CHECK_EQ(places.size(), heights_m.size());
  const Picture picture(places, columns);
  const auto each = [&](auto&& to) {
    for (int64_t r = 0; r < picture.rows(); ++r)
      for (int64_t c = 0; c < picture.columns(); ++c)
        if (const auto quad = footprint(picture, c, r)) to(static_cast<uint32_t>(r * columns + c), *quad);
  };
  // Find the top of every cell, then count and keep what belongs to it.
  const size_t cells = grid.sample.size();
  std::vector<float> top(cells, -INFINITY);
  each([&](uint32_t pixel, const Quad& quad) {
    share_out(quad, grid, [&](size_t cell, float) { top[cell] = std::max(top[cell], float(heights_m[pixel])); });
  });
  const auto belongs = [&](uint32_t pixel, const Quad& quad, size_t cell) {
    return heights_m[pixel] >= top[cell] - kLayer * unit_m * std::max(grid.cell, size_of(quad));
  };
  count_.assign(cells, 0);
  each([&](uint32_t pixel, const Quad& quad) {
    share_out(quad, grid, [&](size_t cell, float) { count_[cell] += belongs(pixel, quad, cell); });
  });
  begin_.assign(cells, 0);
  size_t all = 0;
  for (size_t i = 0; i < cells; ++i) begin_[i] = all, all += count_[i], count_[i] = 0;
  shares_.resize(all);
  each([&](uint32_t pixel, const Quad& quad) {
    share_out(quad, grid, [&](size_t cell, float area) {
      if (belongs(pixel, quad, cell)) shares_[begin_[cell] + count_[cell]++] = {pixel, area};
    });
  });
  for (size_t i = 0; i < cells; ++i) {
    double seen = 0;
    for (const Share& s : cell(i)) seen += s.area;
    if (seen < kLeastSeen) count_[i] = 0;
  }
}

}  // namespace suite
