#include "formats/tensor_tree/grid.h"

#include <algorithm>
#include <cmath>

namespace suite::tensor {

namespace {

// Points of the unit square and of the unit disk (Shirley & Chiu, the quadrants cut along the diagonals).
std::array<double, 2> disk_of(double x, double y) {
  const double a = 2 * x - 1, b = 2 * y - 1;
  if (a == 0 && b == 0) return {0, 0};
  const bool wide = std::fabs(a) > std::fabs(b);
  const double r = wide ? a : b, phi = wide ? kPi / 4 * b / a : kPi / 2 - kPi / 4 * a / b;
  return {r * std::cos(phi), r * std::sin(phi)};
}
std::array<double, 2> square_of(double x, double y) {
  const double r = std::hypot(x, y);
  double phi = std::atan2(y, x);
  if (phi < -kPi / 4) phi += 2 * kPi;
  const int quarter = std::min(3, static_cast<int>((phi + kPi / 4) / (kPi / 2)));
  const double along = (phi - quarter * kPi / 2) * r / (kPi / 4);
  const double a = quarter == 0 ? r : quarter == 1 ? -along : quarter == 2 ? -r : along;
  const double b = quarter == 0 ? along : quarter == 1 ? r : quarter == 2 ? -along : -r;
  return {0.5 * (a + 1), 0.5 * (b + 1)};
}

Dir raised(const std::array<double, 2>& disk) {
  return {disk[0], disk[1], std::sqrt(std::max(0.0, 1 - disk[0] * disk[0] - disk[1] * disk[1]))};
}

}  // namespace

std::pair<Dir, Dir> directions(const Point& at, size_t rank) {
  if (rank == 3) return {raised(disk_of(at[1], at[2])), raised({-std::clamp(1 - 2 * at[0], 0.0, 1.0), 0})};
  const auto in = disk_of(at[0], at[1]);
  return {raised(disk_of(at[2], at[3])), raised({-in[0], -in[1]})};
}

Point point_of(Dir out, Dir in, size_t rank) {
  if (rank == 4) {
    const auto i = square_of(-in.x, -in.y), o = square_of(out.x, out.y);
    return {i[0], i[1], o[0], o[1]};
  }
  // Turn both so that the incident direction has azimuth pi.
  const double sine = std::hypot(in.x, in.y), c = sine > 0 ? -in.x / sine : 1, s = sine > 0 ? -in.y / sine : 0;
  const auto o = square_of(c * out.x + s * out.y, c * out.y - s * out.x);
  return {std::max(0.0, 0.5 - 1e-6 - 0.5 * sine), o[0], o[1], 0};
}

}  // namespace suite::tensor
