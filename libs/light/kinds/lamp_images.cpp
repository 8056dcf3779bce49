#include "light/kinds/lamp_images.h"

#include <algorithm>
#include <cmath>

namespace suite {

namespace {
constexpr double kMostRings = 1e9;  // beyond, rings are as many as numbers can tell apart: none has a chance of its own
// The tail has at least this share: lamps beside a place light walls and air by r^-2.
constexpr double kLeastBeyond = 0.15, kMostBeyond = 0.9;
}  // namespace

LampImages::LampImages(const Periodic& cell, const Box3& lamps)
    : low_{cell.low.x, cell.low.y},
      size_{cell.size.x, cell.size.y},
      widest_(std::max(cell.size.x, cell.size.y)),
      lamps_(lamps) {
  for (int a = 0; a < 2; ++a) stretch_[a] = std::round(std::min(widest_ / size_[a], 1e6));
}

LampImages::Place LampImages::at(Vec3 from) const {
  Place p;
  const double f[2] = {from.x, from.y};
  for (int a = 0; a < 2; ++a) p.cell[a] = std::floor((f[a] - low_[a]) / size_[a]);
  // Of lamps at height h endlessly side by side, those farther than R give h / sqrt(R^2 + h^2) of the light.
  const double height =
      std::max({lamps_.low.z - from.z, from.z - lamps_.high.z, 0.0}) + 0.25 * (lamps_.high.z - lamps_.low.z);
  const double around = std::hypot(1.5 * widest_, height);
  p.beyond = std::clamp(height / around, kLeastBeyond, kMostBeyond);
  p.softness = around / widest_;
  const double least = 0.01 * size_[0] * size_[1] + height * height;
  double sum = 0;
  for (int i = 0; i < 9; ++i) {
    const double n[2] = {i / 3 - 1.0, i % 3 - 1.0},
                 box[2][2] = {{lamps_.low.x, lamps_.high.x}, {lamps_.low.y, lamps_.high.y}};
    double d2 = least;
    for (int a = 0; a < 2; ++a) {
      const double shift = (p.cell[a] + n[a]) * size_[a];
      const double d = std::max({box[a][0] + shift - f[a], f[a] - box[a][1] - shift, 0.0});
      d2 += d * d;
    }
    sum += p.near[i] = 1 / d2;
  }
  for (double& w : p.near) w *= (1 - p.beyond) / sum;
  return p;
}

LampImages::Image LampImages::draw(Vec3 from, double u) const {
  const Place p = at(from);
  double n[2] = {0, 0}, probability = 0;
  if (u < 1 - p.beyond) {
    int chosen = -1;
    for (int i = 0; i < 9 && (chosen < 0 || u >= 0); ++i) u -= p.near[i], chosen = i;
    probability = p.near[chosen];
    n[0] = chosen / 3 - 1, n[1] = chosen % 3 - 1;
  } else {
    // Rings from 2 on: softness / (k + softness) of the rest lies in the k-th of them or beyond.
    const double rest = std::clamp((1 - u) / p.beyond, 0x1p-53, 1.0), s = p.softness;
    const double k = std::min(std::floor(s * (1 / rest - 1)), kMostRings), m = k + 2;
    const double upper = s / (k + s), lower = k < kMostRings ? s / (k + 1 + s) : 0;
    const double inner = cells_to(m - 1), count = cells_to(m) - inner;
    double c = std::min(std::floor((upper - rest) / (upper - lower) * count), count - 1);
    c = std::max(c, 0.0);
    // Whole columns on both sides, then the ends of those between.
    const double rx = reach(0, m), ry = reach(1, m), qx = reach(0, m - 1), qy = reach(1, m - 1);
    const double column = 2 * ry + 1, side = (rx - qx) * column;
    if (c < 2 * side) {
      const double x = std::floor(c / column);
      n[0] = x < rx - qx ? -rx + x : qx + 1 + x - (rx - qx);
      n[1] = c - x * column - ry;
    } else {
      c -= 2 * side;
      const double ends = 2 * (ry - qy), x = std::floor(c / ends), y = c - x * ends;
      n[0] = x - qx;
      n[1] = y < ry - qy ? -ry + y : qy + 1 + y - (ry - qy);
    }
    probability = p.beyond * (upper - lower) / count;
  }
  return {{(p.cell[0] + n[0]) * size_[0], (p.cell[1] + n[1]) * size_[1], 0}, probability};
}

Vec3 LampImages::whole(Vec3 shift) const {
  return {std::round(shift.x / size_[0]) * size_[0], std::round(shift.y / size_[1]) * size_[1], 0};
}

double LampImages::probability(Vec3 from, Vec3 shift) const {
  const Place p = at(from);
  const double s[2] = {shift.x, shift.y};
  double n[2], m = 0;
  for (int a = 0; a < 2; ++a) {
    n[a] = std::round(s[a] / size_[a]) - p.cell[a];
    m = std::max(m, 1 + std::ceil((std::fabs(n[a]) - 1) / stretch_[a]));
  }
  if (m <= 1) return p.near[static_cast<int>(n[0] + 1) * 3 + static_cast<int>(n[1] + 1)];
  const double k = m - 2;
  if (k > kMostRings) return 0;
  const double upper = p.softness / (k + p.softness), lower = k < kMostRings ? p.softness / (k + 1 + p.softness) : 0;
  return p.beyond * (upper - lower) / (cells_to(m) - cells_to(m - 1));
}

}  // namespace suite
