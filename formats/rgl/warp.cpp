#include "formats/rgl/warp.h"

#include <algorithm>

namespace suite::rgl {

namespace {

struct Cell {
  size_t column, row;
  double x, y;  // position within the patch, 0..1
};

Cell cell_of(Vec2 p, size_t rows, size_t columns) {
  const double x = std::clamp(p.x, 0.0, 1.0) * static_cast<double>(columns - 1),
               y = std::clamp(p.y, 0.0, 1.0) * static_cast<double>(rows - 1);
  const size_t i = std::min(columns - 2, static_cast<size_t>(x)), j = std::min(rows - 2, static_cast<size_t>(y));
  return {i, j, x - static_cast<double>(i), y - static_cast<double>(j)};
}

double lerp(double a, double b, double t) { return a + (b - a) * t; }

}  // namespace

double Bilinear::at(Vec2 p, const SliceMix& mix, size_t channels, size_t channel) const {
  const Cell c = cell_of(p, rows_, columns_);
  double sum = 0;
  for (int m = 0; m < mix.count; ++m) {
    const float* v = values_.data() + ((mix.slice[m] * channels + channel) * rows_ + c.row) * columns_ + c.column;
    sum += mix.weight[m] * lerp(lerp(v[0], v[1], c.x), lerp(v[columns_], v[columns_ + 1], c.x), c.y);
  }
  return sum;
}

Warp::Warp(size_t rows, size_t columns, std::span<const float> values)
    : rows_(rows), columns_(columns), density_(values.begin(), values.end()), conditional_(values.size()) {
  const size_t slices = values.size() / (rows * columns);
  marginal_.resize(slices * rows);
  for (size_t s = 0; s < slices; ++s) {
    float* density = density_.data() + s * rows * columns;
    float* conditional = conditional_.data() + s * rows * columns;
    float* marginal = marginal_.data() + s * rows;
    std::vector<double> along(rows * columns), up(rows);
    auto integrate = [&] {
      for (size_t r = 0; r < rows; ++r)
        for (size_t c = 1; c < columns; ++c)
          along[r * columns + c] = along[r * columns + c - 1] +
                                   0.5 * (static_cast<double>(density[r * columns + c - 1]) + density[r * columns + c]);
      for (size_t r = 1; r < rows; ++r)
        up[r] = up[r - 1] + 0.5 * (along[r * columns - 1] + along[(r + 1) * columns - 1]);
    };
    integrate();
    if (!(up.back() > 0)) {
      std::fill_n(density, rows * columns, 1.0f);
      integrate();
    }
    const double scale = 1 / up.back();
    for (size_t i = 0; i < rows * columns; ++i) {
      density[i] = static_cast<float>(density[i] * scale);
      conditional[i] = static_cast<float>(along[i] * scale);
    }
    for (size_t r = 0; r < rows; ++r) marginal[r] = static_cast<float>(up[r] * scale);
  }
}

Vec2 Warp::invert(Vec2 p, const SliceMix& mix) const {
  const Cell c = cell_of(p, rows_, columns_);
  // Mix the slices at the corners of the patch: densities, integrals to its left, whole rows, rows below.
  double v[4] = {}, left[2] = {}, whole[2] = {}, below = 0;
  for (int m = 0; m < mix.count; ++m) {
    const double w = mix.weight[m];
    const size_t row = (mix.slice[m] * rows_ + c.row) * columns_, at = row + c.column;
    v[0] += w * density_[at];
    v[1] += w * density_[at + 1];
    v[2] += w * density_[at + columns_];
    v[3] += w * density_[at + columns_ + 1];
    left[0] += w * conditional_[at];
    left[1] += w * conditional_[at + columns_];
    whole[0] += w * conditional_[row + columns_ - 1];
    whole[1] += w * conditional_[row + 2 * columns_ - 1];
    below += w * marginal_[mix.slice[m] * rows_ + c.row];
  }
  // Share of the interpolated row to the left of p; then share of the square below p.
  const double c0 = lerp(v[0], v[2], c.y), c1 = lerp(v[1], v[3], c.y);
  const double row = lerp(whole[0], whole[1], c.y);
  const double x = lerp(left[0], left[1], c.y) + c.x * (c0 + 0.5 * c.x * (c1 - c0));
  const double y = below + c.y * (whole[0] + 0.5 * c.y * (whole[1] - whole[0]));
  return {row > 0 ? std::clamp(x / row, 0.0, 1.0) : p.x, std::clamp(y, 0.0, 1.0)};
}

}  // namespace suite::rgl
