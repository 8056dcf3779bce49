#include "light/earth.h"

#include <cmath>

namespace suite {

SceneFrame frame_of(const Scene& scene, const Where& where, const char* what) {
  if (!scene.origin.given)
    throw Error(where, std::string(what) + " needs a scene with a geodetic origin",
                "give the scene an origin, or directions as {zenith_deg, azimuth_deg}");
  return SceneFrame({scene.origin.latitude_deg, scene.origin.longitude_deg, scene.origin.ellipsoid_height_m});
}

namespace {
Vec3 times(Vec3 a, Vec3 b) { return {a.x * b.x, a.y * b.y, a.z * b.z}; }
}  // namespace

Earth::Earth(const SceneFrame& frame, double height, uint32_t material) : frame_(frame), material_(material) {
  constexpr double a = 6378137, b = 6356752.314245179;
  if (!(height > -1e5 && height < 1e5))
    throw Error(strf("the Earth's surface at %g m is not between -100 and 100 km", height));
  scale_ = {1 / (a + height), 1 / (a + height), 1 / (b + height)};
}

std::optional<Earth::Meeting> Earth::meet(Vec3 origin, Dir direction, double reach) const {
  // In coordinates in which the Earth is the unit sphere: |o + t d|^2 = r^2.
  const Vec3 start = frame_.ecef_from_enu(origin), way = frame_.ecef_direction(direction);
  const Vec3 o = times(start, scale_), d = times(way, scale_);
  const double aa = dot(d, d), bb = dot(o, d), oo = dot(o, o);
  if (bb >= 0) return std::nullopt;  // away from the Earth
  // From inside, the surface is 3 m below the start.
  const double cc = oo > 1 ? oo - 1 : 1e-6 * oo;
  const double discriminant = bb * bb - aa * cc;
  if (!(discriminant > 0)) return std::nullopt;
  const double t = cc / (-bb + std::sqrt(discriminant));
  if (!(t <= reach)) return std::nullopt;
  const Vec3 point = start + way * t;
  const Vec3 normal = normalized(times(times(point, scale_), scale_));
  return Meeting{t, origin + direction * t, frame_.enu_direction(normal)};
}

}  // namespace suite
