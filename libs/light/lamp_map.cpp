#include "light/lamp_map.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"

namespace suite {

PlacedLampMap::PlacedLampMap(std::shared_ptr<const LampMap> map, const std::optional<SceneFrame>& frame)
    : map_(std::move(map)) {
  if (map_->system) frame_ = frame;
  const auto& m = map_->to_map;
  const double determinant = m[1] * m[5] - m[2] * m[4];
  if (!(std::fabs(determinant) > 0)) throw Error("'" + map_->file + "': its pixels have no extent");
  inverse_ = {m[5] / determinant, -m[2] / determinant, -m[4] / determinant, m[1] / determinant};
}

std::optional<Vec2> PlacedLampMap::pixel(Vec3 enu) const {
  Vec2 at{enu.x, enu.y};
  if (map_->system) {
    try {
      at = map_of_geodetic(*map_->system, frame_->geodetic_from_enu(enu));
    } catch (const Error&) {
      return std::nullopt;
    }
    // Longitudes of maps may go on beyond 180 degrees.
    const double middle = map_->to_map[0] + 0.5 * map_->to_map[1] * map_->width;
    if (!map_->system->zone) at.x += 360 * std::round((middle - at.x) / 360);
  }
  const double x = at.x - map_->to_map[0], y = at.y - map_->to_map[3];
  return Vec2{inverse_[0] * x + inverse_[1] * y, inverse_[2] * x + inverse_[3] * y};
}

double PlacedLampMap::at(Vec3 enu) const {
  const auto p = pixel(enu);
  if (!p || !(p->x >= 0 && p->y >= 0 && p->x < map_->width && p->y < map_->height)) return 0;
  const auto column = static_cast<size_t>(p->x), row = static_cast<size_t>(p->y);
  return static_cast<double>(map_->values[row * map_->width + column]);
}

double PlacedLampMap::mean_over(const Box3& box) const {
  Vec2 low{1e300, 1e300}, high{-1e300, -1e300};
  for (int corner = 0; corner < 8; ++corner) {
    const auto p = pixel({corner & 1 ? box.high.x : box.low.x, corner & 2 ? box.high.y : box.low.y,
                          corner & 4 ? box.high.z : box.low.z});
    if (!p) continue;
    low = {std::min(low.x, p->x), std::min(low.y, p->y)};
    high = {std::max(high.x, p->x), std::max(high.y, p->y)};
  }
  // A pixel more to every side: edges of the box may be curves on the map.
  const auto clamped = [](double v, uint32_t size) {
    return static_cast<size_t>(std::clamp(v, 0.0, static_cast<double>(size)));
  };
  const size_t left = clamped(std::floor(low.x) - 1, map_->width), right = clamped(std::ceil(high.x) + 1, map_->width),
               top = clamped(std::floor(low.y) - 1, map_->height),
               bottom = clamped(std::ceil(high.y) + 1, map_->height);
  double sum = 0;
  for (size_t row = top; row < bottom; ++row)
    for (size_t column = left; column < right; ++column)
      sum += static_cast<double>(map_->values[row * map_->width + column]);
  const double touched = std::max(1.0, (high.x - low.x + 2) * (high.y - low.y + 2));
  return sum / touched;
}

}  // namespace suite
