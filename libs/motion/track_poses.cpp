// Orientations and places on the Earth as poses of a scene; see track.h.
#include <cmath>

#include "motion/track.h"

namespace suite {

Quat platform_rotation(double azimuth, double pitch, double roll) {
  return quat_about({0, 0, 1}, azimuth - kPi / 2) * quat_about({1, 0, 0}, pitch) * quat_about({0, 1, 0}, roll);
}

Pose pose_from_ecef(const SceneFrame& frame, Vec3 ecef, const Quat& rotation) {
  return {normalized(frame.to_ecef().rotation.conjugate() * rotation), frame.enu_from_ecef(ecef)};
}

Quat geodetic_axes(const SceneFrame& frame, const Geodetic& place) {
  return normalized(frame.to_ecef().rotation.conjugate() * SceneFrame(place).to_ecef().rotation);
}

Quat utm_axes(const SceneFrame& frame, const UtmPoint& point) {
  const Geodetic place = geodetic_from_utm(point);
  // The grid's north, seen from true north, from two points 20 m apart on the grid's north line.
  UtmPoint north = point, south = point;
  north.northing += 10;
  south.northing -= 10;
  const SceneFrame local(place);
  const Vec3 along = local.enu_from_utm(north) - local.enu_from_utm(south);
  return normalized(geodetic_axes(frame, place) * quat_about({0, 0, 1}, std::atan2(-along.x, along.y)));
}

Pose pose_from_geodetic(const SceneFrame& frame, const Geodetic& place, const Quat& rotation) {
  return {normalized(geodetic_axes(frame, place) * rotation), frame.enu_from_geodetic(place)};
}

Pose pose_from_utm(const SceneFrame& frame, const UtmPoint& point, const Quat& rotation) {
  return {normalized(utm_axes(frame, point) * rotation), frame.enu_from_utm(point)};
}

}  // namespace suite
