#include "light/night/glow_shells.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

namespace suite {

namespace {

constexpr double kEquator = 6378137.0, kPole = 6356752.314245179;  // m, WGS84
constexpr double kAboveAir = 60e3;                                 // m

// Where a line runs within the ellipsoid of a height: from and to, m along it; nothing where it does not.
std::optional<std::pair<double, double>> within(Vec3 p, Dir d, double height) {
  const double scale = (kEquator + height) / (kPole + height), r = kEquator + height;
  p.z *= scale;
  const Vec3 u{d.x, d.y, d.z * scale};
  const double a = dot(u, u), middle = -dot(p, u) / a;
  const Vec3 lowest = p + u * middle;
  const double h = std::sqrt(dot(lowest, lowest)), half2 = (r - h) * (r + h) / a;
  if (!(half2 > 0)) return std::nullopt;
  return std::pair{middle - std::sqrt(half2), middle + std::sqrt(half2)};
}

// m of [begin, end] within [from, to].
double overlap(double begin, double end, double from, double to) {
  return std::max(0.0, std::min(end, to) - std::max(begin, from));
}

}  // namespace

GlowShells::GlowShells(const SceneFrame& frame, std::span<const double> heights)
    : heights_(heights.begin(), heights.end()), frame_(frame) {}

double GlowShells::thickness(double height) { return height < 200e3 ? 10e3 : height / 3; }

bool GlowShells::is_below(Vec3 place) const {
  const Vec3 p = frame_.ecef_from_enu(place);
  const double x = std::hypot(p.x, p.y) / (kEquator + kAboveAir), z = p.z / (kPole + kAboveAir);
  return x * x + z * z > 1;
}

bool GlowShells::meets_earth(Vec3 from, Dir direction) const {
  const auto met = within(frame_.ecef_from_enu(from), frame_.ecef_direction(direction), 0);
  return met && met->second > 0;
}

GlowShells::Share GlowShells::share(size_t layer, Vec3 from, Dir direction, double length) const {
  const Vec3 p = frame_.ecef_from_enu(from), d = frame_.ecef_direction(direction);
  const double height = heights_[layer], thick = thickness(height);
  const auto outer = within(p, d, height + thick / 2);
  if (!outer) return {};
  const double middle = 0.5 * (outer->first + outer->second);
  const auto inner = within(p, d, height - thick / 2).value_or(std::pair{middle, middle});
  return {(overlap(outer->first, inner.first, 0, length)) / thick,
          overlap(inner.second, outer->second, 0, length) / thick};
}

}  // namespace suite
