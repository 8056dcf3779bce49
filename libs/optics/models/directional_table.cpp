#include "optics/models/directional_table.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"

namespace suite {

DirectionalTable::DirectionalTable(double ax, double ay, size_t rows, size_t width,
                                   const std::function<void(Dir, std::span<float>)>& fill)
    : ax_(ax), ay_(ay), rows_(rows), columns_(ax == ay ? 1 : 33), width_(width), values_(rows * columns_ * width) {
  parallel_for(0, columns_ * rows_, 4, [&](size_t begin, size_t end) {
    for (size_t e = begin; e < end; ++e) {
      // Columns are even in the azimuth of the ellipse of roughness.
      const double turn =
          columns_ == 1 ? 0 : kPi / 2 * static_cast<double>(e % columns_) / static_cast<double>(columns_ - 1);
      const double phi = columns_ == 1 ? 0 : std::atan2(ax * std::sin(turn), ay * std::cos(turn));
      const double roughness = std::hypot(ax * std::cos(phi), ay * std::sin(phi));
      const double wanted = static_cast<double>(e / columns_) / static_cast<double>(rows_ - 1);
      // Find the angle of the row by bisection; the coordinate is monotone.
      double low = 0, high = kPi / 2 - 1e-5;
      for (int step = 0; step < 60; ++step)
        (coordinate(0.5 * (low + high), roughness) < wanted ? low : high) = 0.5 * (low + high);
      fill(dir_from_angles(wanted == 0 ? 0 : high, phi), {values_.data() + e * width_, width_});
    }
  });
}

double DirectionalTable::coordinate(double theta, double roughness) const {
  return 0.5 * (std::sqrt(2.0) * std::sin(theta / 2) + 1 - 1 / std::sqrt(1 + roughness * std::tan(theta)));
}

DirectionalTable::Place DirectionalTable::locate(Dir out) const {
  const double scaled = std::sqrt(ax_ * ax_ * out.x * out.x + ay_ * ay_ * out.y * out.y),
               v = 1 - std::sqrt(out.z / (out.z + scaled));
  const double half = std::sqrt((out.x * out.x + out.y * out.y) / (1 + out.z));  // sqrt(2) sin(theta / 2)
  const double row = std::min(1.0, 0.5 * (half + v)) * static_cast<double>(rows_ - 1);
  const size_t r = std::min(rows_ - 2, static_cast<size_t>(row));
  const double t = row - static_cast<double>(r), t2 = t * t, t3 = t2 * t;
  // The first row is a turning point (the pole), the last one an end: the value beyond is mirrored, and extrapolated.
  const size_t before = r == 0 ? r + 1 : r - 1, after = r + 2 < rows_ ? r + 2 : r + 1;
  double w[4] = {0.5 * (-t3 + 2 * t2 - t), 0.5 * (3 * t3 - 5 * t2 + 2), 0.5 * (-3 * t3 + 4 * t2 + t), 0.5 * (t3 - t2)};
  if (after == r + 1) w[2] += 2 * w[3], w[1] -= w[3], w[3] = 0;
  const size_t rows[4] = {before, r, r + 1, after};
  const double column = columns_ == 1 ? 0
                                      : std::atan2(ay_ * std::fabs(out.y), ax_ * std::fabs(out.x)) / (kPi / 2) *
                                            static_cast<double>(columns_ - 1);
  const size_t c = columns_ == 1 ? 0 : std::min(columns_ - 2, static_cast<size_t>(column));
  Place p{};
  for (int k = 0; k < 4; ++k)
    for (size_t side = 0; side < (columns_ == 1 ? 1 : 2); ++side) {
      const double across = column - static_cast<double>(c);
      p.entry[p.count] = rows[k] * columns_ + c + side;
      p.weight[p.count++] = w[k] * (side ? across : 1 - across);
    }
  return p;
}

void DirectionalTable::at(Dir out, std::span<float> v) const {
  const Place p = locate(out);
  std::fill(v.begin(), v.end(), 0.0f);
  for (int k = 0; k < p.count; ++k) {
    const float w = static_cast<float>(p.weight[k]);
    const float* entry = values_.data() + p.entry[k] * width_;
    for (size_t i = 0; i < width_; ++i) v[i] += w * entry[i];
  }
}

float DirectionalTable::at(const Place& p, size_t index) const {
  double sum = 0;
  for (int k = 0; k < p.count; ++k) sum += p.weight[k] * values_[p.entry[k] * width_ + index];
  return static_cast<float>(sum);
}

}  // namespace suite
