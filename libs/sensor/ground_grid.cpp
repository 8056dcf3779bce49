#include "sensor/ground_grid.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/error.h"

namespace suite {

namespace {

bool known(Vec2 p) { return std::isfinite(p.x) && std::isfinite(p.y); }
double distance(Vec2 a, Vec2 b) { return std::hypot(a.x - b.x, a.y - b.y); }

double median(std::vector<double>& values) {
  if (values.empty()) return 0;
  const auto middle = values.begin() + static_cast<long>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

// Fills a grid from the places of a picture.
class Filling {
 public:
  Filling(std::span<const Vec2> places, uint32_t columns, GroundGrid& grid)
      : places_(places),
        columns_(columns),
        grid_(grid),
        usual_(spacing_of(places, columns)),
        distance_(grid.sample.size(), std::numeric_limits<float>::infinity()) {}

  void run() {
    for (size_t i = 0; i < places_.size(); ++i)
      if (known(places_[i])) put(i, cell_of(places_[i].x - grid_.west), cell_of(grid_.north - places_[i].y), 1);
    direct_ = grid_.sample;
    const size_t rows = places_.size() / columns_;
    for (size_t r = 0; r + 1 < rows; ++r)
      for (size_t c = 0; c + 1 < columns_; ++c) {
        const size_t i = r * columns_ + c;
        const size_t corner[4] = {i, i + 1, i + columns_ + 1, i + columns_};
        // Two triangles cover four corners; of three known corners it is the one that they make.
        triangle(corner[0], corner[1], corner[2]);
        triangle(corner[0], corner[2], corner[3]);
        if (!known(places_[corner[2]])) triangle(corner[0], corner[1], corner[3]);
        if (!known(places_[corner[0]])) triangle(corner[1], corner[2], corner[3]);
      }
  }

 private:
  int64_t cell_of(double metres) const { return static_cast<int64_t>(std::floor(metres / grid_.cell)); }
  Vec2 middle_of(int64_t column, int64_t row) const {
    return {grid_.west + (static_cast<double>(column) + 0.5) * grid_.cell,
            grid_.north - (static_cast<double>(row) + 0.5) * grid_.cell};
  }
  // Takes a pixel for a cell when it is nearer than what is there.
  void put(size_t pixel, int64_t column, int64_t row, int sign) {
    column = std::clamp<int64_t>(column, 0, grid_.columns - 1), row = std::clamp<int64_t>(row, 0, grid_.rows - 1);
    const size_t cell = static_cast<size_t>(row) * grid_.columns + static_cast<size_t>(column);
    const auto far = static_cast<float>(distance(places_[pixel], middle_of(column, row)));
    if (!(far < distance_[cell])) return;
    distance_[cell] = far;
    grid_.sample[cell] = sign * static_cast<int32_t>(pixel % columns_ + 1);
    grid_.line[cell] = sign * static_cast<int32_t>(pixel / columns_ + 1);
  }
  bool torn(size_t i, size_t j) const {
    const bool row = i / columns_ == j / columns_, column = i % columns_ == j % columns_;
    const double limit = row ? usual_.along_line : column ? usual_.across : usual_.along_line + usual_.across;
    return distance(places_[i], places_[j]) > kFarthest * limit;
  }
  void triangle(size_t i, size_t j, size_t k) {
    const Vec2 a = places_[i], b = places_[j], c = places_[k];
    if (!known(a) || !known(b) || !known(c) || torn(i, j) || torn(j, k) || torn(i, k)) return;
    const double area = (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
    if (area == 0) return;
    const auto [west, east] = std::minmax({a.x, b.x, c.x});
    const auto [south, north] = std::minmax({a.y, b.y, c.y});
    for (int64_t row = cell_of(grid_.north - north); row <= cell_of(grid_.north - south); ++row)
      for (int64_t column = cell_of(west - grid_.west); column <= cell_of(east - grid_.west); ++column) {
        const Vec2 p = middle_of(column, row);
        const double u = ((b.x - p.x) * (c.y - p.y) - (b.y - p.y) * (c.x - p.x)) / area,
                     v = ((c.x - p.x) * (a.y - p.y) - (c.y - p.y) * (a.x - p.x)) / area;
        if (u < 0 || v < 0 || u + v > 1) continue;
        const size_t cell = static_cast<size_t>(row) * grid_.columns + static_cast<size_t>(column);
        if (direct_[cell]) continue;
        for (const size_t pixel : {i, j, k}) put(pixel, column, row, -1);
      }
  }

  std::span<const Vec2> places_;
  uint32_t columns_;
  GroundGrid& grid_;
  Spacing usual_;
  std::vector<float> distance_;
  std::vector<int32_t> direct_;
};

}  // namespace

double Spacing::pixel() const {
  const double edge = along_line > 0 && across > 0 ? std::sqrt(along_line * across) : std::max(along_line, across);
  if (!(edge > 0)) return 0;
  const double unit = std::pow(10.0, std::floor(std::log10(edge)) - 1);
  return std::round(edge / unit) * unit;
}

Spacing spacing_of(std::span<const Vec2> places, uint32_t columns) {
  std::vector<double> along, across;
  for (size_t i = 0; i < places.size(); ++i) {
    if (!known(places[i])) continue;
    if (i % columns && known(places[i - 1])) along.push_back(distance(places[i], places[i - 1]));
    if (i >= columns && known(places[i - columns])) across.push_back(distance(places[i], places[i - columns]));
  }
  return {median(along), median(across)};
}

std::optional<GroundGrid> ground_grid(std::span<const Vec2> places, uint32_t columns, double cell) {
  if (!(cell > 0)) throw Error("the cells of the lookup table have no size", "give geolocation: {pixel_m: N}");
  Vec2 low{INFINITY, INFINITY}, high{-INFINITY, -INFINITY};
  for (const Vec2 p : places) {
    if (!known(p)) continue;
    low = {std::min(low.x, p.x), std::min(low.y, p.y)}, high = {std::max(high.x, p.x), std::max(high.y, p.y)};
  }
  if (!known(low)) return std::nullopt;
  const double west = std::floor(low.x / cell), north = std::floor(high.y / cell) + 1;
  const double wide = std::floor(high.x / cell) - west + 1, tall = north - std::floor(low.y / cell);
  if (!(wide * tall <= static_cast<double>(kMostCells)))
    throw Error(strf("a lookup table of %.6g x %.6g cells of %g is too large", wide, tall, cell),
                strf("give geolocation: {pixel_m: %.2g} or more",
                     cell * std::sqrt(wide * tall / static_cast<double>(kMostCells))));
  GroundGrid grid{west * cell, north * cell, cell, static_cast<uint32_t>(wide), static_cast<uint32_t>(tall), {}, {}};
  grid.sample.assign(size_t{grid.columns} * grid.rows, 0);
  grid.line = grid.sample;
  Filling(places, columns, grid).run();
  return grid;
}

}  // namespace suite
