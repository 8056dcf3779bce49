#include "light/night/satellites.h"

#include <algorithm>
#include <cmath>

namespace suite {

SunlitPoint::SunlitPoint(TrackPtr track, const SceneFrame& frame, Dir to_sun, double reflecting)
    : track_(std::move(track)), centre_(frame.enu_from_ecef({0, 0, 0})), to_sun_(to_sun), reflecting_(reflecting) {}

double SunlitPoint::share(double time, Vec3 from) const {
  constexpr double kEarth = 6371e3;  // m
  const Vec3 place = at(time), out = place - centre_, away = from - place;
  const double along = dot(out, to_sun_);
  if (along < 0 && dot(out, out) - along * along < kEarth * kEarth) return 0;
  const double d2 = dot(away, away);
  if (!(d2 > 0)) return 0;
  const double c = std::clamp(dot(away, to_sun_) / std::sqrt(d2), -1.0, 1.0), p = std::acos(c);
  return reflecting_ / d2 * 2 / (3 * kPi * kPi) * (std::sin(p) + (kPi - p) * c);
}

}  // namespace suite
