#include "sensor/detectors/disk.h"

#include <algorithm>
#include <cmath>

namespace suite {

namespace {

// Area of x^2 + y^2 < 1 with y below a height.
double area_below(double y) {
  if (y <= -1) return 0;
  if (y >= 1) return kPi;
  return kPi / 2 + y * std::sqrt(1 - y * y) + std::asin(y);
}

}  // namespace

std::vector<double> over_disk(const std::vector<double>& light, uint32_t columns, Vec2 radius, double share) {
  const long width = columns, rows = static_cast<long>(light.size()) / width;
  std::vector<double> out(light.size());
  for (size_t i = 0; i < light.size(); ++i) out[i] = (1 - share) * light[i];
  // Of each row of the disk the share of its light, and the half width that is as wide as the row in the mean.
  const long reach = std::min(rows - 1, static_cast<long>(std::ceil(radius.y + 0.5)));
  std::vector<double> upto(static_cast<size_t>(width) + 1);
  for (long from = 0; from < rows; ++from) {
    upto[0] = 0;
    for (long c = 0; c < width; ++c)
      upto[static_cast<size_t>(c + 1)] = upto[static_cast<size_t>(c)] + light[static_cast<size_t>(from * width + c)];
    if (!(upto.back() > 0)) continue;
    const auto sum_to = [&](double x) {  // of the light left of x, pixels from the left edge
      if (x <= 0) return 0.0;
      if (x >= static_cast<double>(width)) return upto.back();
      const auto c = static_cast<size_t>(x);
      return upto[c] + (x - static_cast<double>(c)) * (upto[c + 1] - upto[c]);
    };
    for (long off = std::max(-reach, -from); off <= std::min(reach, rows - 1 - from); ++off) {
      const double low = (static_cast<double>(off) - 0.5) / radius.y,
                   high = (static_cast<double>(off) + 0.5) / radius.y, area = area_below(high) - area_below(low);
      if (!(area > 0)) continue;
      const double half = 0.5 * area / (std::min(high, 1.0) - std::max(low, -1.0)) * radius.x;
      for (long c = 0; c < width; ++c) {
        const double middle = static_cast<double>(c) + 0.5;
        // A source at x is seen with its share of light within `half` of it; the same about the pixel, by symmetry.
        const double near = sum_to(middle + half) - sum_to(middle - half);
        out[static_cast<size_t>((from + off) * width + c)] += share * area / kPi * std::max(0.0, near) / (2 * half);
      }
    }
  }
  return out;
}

}  // namespace suite
