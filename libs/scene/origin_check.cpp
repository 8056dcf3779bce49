#include "scene/origin_check.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "motion/scene_frame.h"

namespace suite {

namespace {

struct Extent {
  double south = 90, north = -90, west = 360, east = -360;  // deg

  void grow(double latitude, double longitude) {
    south = std::min(south, latitude), north = std::max(north, latitude);
    west = std::min(west, longitude), east = std::max(east, longitude);
  }
  bool holds(double latitude, double longitude, double margin) const {
    const double turned = longitude > 180 ? longitude - 360 : longitude;
    return latitude >= south - margin && latitude <= north + margin && turned >= west - margin &&
           turned <= east + margin;
  }
};

}  // namespace

std::optional<std::string> misplaced_origin(const TerrainGrid& terrain, const GeodeticOrigin& origin) {
  constexpr double kMargin = 2;  // deg
  const SceneFrame frame({origin.latitude_deg, origin.longitude_deg, origin.ellipsoid_height_m});
  Extent there;
  for (const Vec3& p : terrain.outline()) {
    const Geodetic g = frame.geodetic_from_enu(p);
    there.grow(g.latitude_deg, g.longitude_deg);
  }
  // Terrains across the date line are not looked at.
  if (there.south > there.north || there.east - there.west > 180) return std::nullopt;
  const double latitude = origin.latitude_deg, longitude = origin.longitude_deg;
  if (there.holds(latitude, longitude, kMargin)) return std::nullopt;
  const struct {
    double latitude, longitude;
    const char* what;
  } slips[] = {{longitude, latitude, "are latitude and longitude exchanged?"},
               {latitude, -longitude, "has the longitude the wrong sign?"},
               {-latitude, longitude, "has the latitude the wrong sign?"},
               {-latitude, -longitude, "have both the wrong sign?"}};
  std::string why = "give an origin in or near it";
  for (const auto& slip : slips)
    if (std::fabs(slip.latitude) <= 90 && there.holds(slip.latitude, slip.longitude, kMargin)) {
      why = slip.what;
      break;
    }
  return strf("it covers latitudes %.4f to %.4f and longitudes %.4f to %.4f, the origin is at %.4f, %.4f: ",
              there.south, there.north, there.west, there.east, latitude, longitude) +
         why;
}

}  // namespace suite
