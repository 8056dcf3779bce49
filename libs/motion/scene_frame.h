// The scene's ENU plane pinned to the Earth: scene ENU <-> Earth-centred Earth-fixed (ECEF) <-> geodetic WGS84 <-> UTM.
//
// Assumes: the WGS84 ellipsoid; heights are ellipsoidal (a geoid height is added by the caller, who knows its datum).
// ETRS89 and WGS84 are taken as one frame (they differ by plate motion, below 1 m), GRS80 as WGS84 (0.1 mm in b).
// Latitudes and longitudes are in degrees here, as their names say: they are labels of places, not angles computed
// with. Based on: C. F. F. Karney, "Transverse Mercator with an accuracy of a few nanometers", J. Geodesy 85, 2011
// (Krueger's series); C. F. F. Karney, "Algorithms for geodesics", J. Geodesy 87, 2013; both as implemented by
// GeographicLib.
#pragma once
#include <optional>
#include <string>

#include "math/dualquat.h"
#include "math/vec.h"

namespace suite {

// A place on WGS84. Latitude -90..90, longitude -180..360 accepted (east positive), -180..180 returned.
struct Geodetic {
  double latitude_deg = 0, longitude_deg = 0;
  double height_m = 0;  // above the ellipsoid
};

// A UTM grid: zone 1..60 and hemisphere.
struct UtmZone {
  int zone = 1;
  bool north = true;
  bool operator==(const UtmZone&) const = default;
};

// A place in a UTM grid, metres; height above the ellipsoid.
struct UtmPoint {
  UtmZone grid;
  double easting = 0, northing = 0, height_m = 0;
};

// Error when latitude, longitude or height is not finite or out of range (height -1e5 .. 1e10 m).
void check_geodetic(const Geodetic& place);

// Metres from the Earth's centre, x through (0, 0), z through the north pole. Errors as check_geodetic.
Vec3 ecef_from_geodetic(const Geodetic& place);
// Any finite point; at the Earth's centre the latitude is 90 by convention.
Geodetic geodetic_from_ecef(Vec3 ecef);

// The grid a place belongs to, with the exceptions of Norway and Svalbard. Error beyond 84 N and 80 S, where UTM ends.
UtmZone standard_utm_zone(const Geodetic& place);
// UTM coordinates in the given grid, also outside its own strip. Error: zone not 1..60, or further than 30 degrees of
// longitude from its central meridian (the series is exact to nanometres up to there).
UtmPoint utm_from_geodetic(const Geodetic& place, UtmZone grid);
// Error: zone not 1..60, or easting outside -2.5e6..3.5e6 or northing outside -1e7..2e7 m.
Geodetic geodetic_from_utm(const UtmPoint& point);
// The grid of an EPSG code: 32601-32660 (north), 32701-32760 (south), 25828-25838 (ETRS89); nullopt for any other.
std::optional<UtmZone> utm_zone_of_epsg(int epsg);
// "33N" or "33 south" etc. to a grid; nullopt when it is none.
std::optional<UtmZone> utm_zone_of_text(const std::string& text);

// An ENU plane tangent at a place: x east, y north, z up (along the ellipsoid's normal), metres, origin at the place.
// Immutable; all members may be called from many threads.
class SceneFrame {
 public:
  // Errors as check_geodetic.
  explicit SceneFrame(const Geodetic& origin);

  const Geodetic& origin() const { return origin_; }
  // The rigid motion from ENU to ECEF (its rotation turns directions).
  const Pose& to_ecef() const { return to_ecef_; }

  // Points, metres.
  Vec3 ecef_from_enu(Vec3 enu) const { return ecef_direction(enu) + to_ecef_.translation; }
  Vec3 enu_from_ecef(Vec3 ecef) const { return enu_direction(ecef - to_ecef_.translation); }
  Geodetic geodetic_from_enu(Vec3 enu) const { return geodetic_from_ecef(ecef_from_enu(enu)); }
  Vec3 enu_from_geodetic(const Geodetic& place) const { return enu_from_ecef(ecef_from_geodetic(place)); }
  UtmPoint utm_from_enu(Vec3 enu, UtmZone grid) const { return utm_from_geodetic(geodetic_from_enu(enu), grid); }
  Vec3 enu_from_utm(const UtmPoint& point) const { return enu_from_geodetic(geodetic_from_utm(point)); }

  // Directions (vectors, any length): rotated only.
  Vec3 ecef_direction(Vec3 enu) const { return axes_.x * enu.x + axes_.y * enu.y + axes_.z * enu.z; }
  Vec3 enu_direction(Vec3 ecef) const { return axes_.to_local(ecef); }

  // East, north and up at another place, expressed in this frame. At the poles east is taken along longitude 90.
  Frame local_axes(Vec3 enu) const;

  // Earth curvature for content modelled on a flat plane: the plane is laid onto the ellipsoid of the origin's height
  // by the azimuthal equidistant map, z becoming height above it. Distances from the origin along the surface keep
  // their length, and the direction from the origin its azimuth. Valid to 5000 km from the origin (Error beyond).
  Vec3 curved(Vec3 plane) const;
  // The inverse of curved().
  Vec3 flattened(Vec3 enu) const;
  // The rotation that goes with curved(): turns what stood upright at `plane` upright at curved(plane), keeping its
  // direction as seen along the line from the origin.
  Quat curved_rotation(Vec3 plane) const;

 private:
  struct Landing {
    Geodetic place;
    double azimuth_there_deg = 0;  // of the geodesic from the origin, continued
    double azimuth_here_deg = 0;   // the same at the origin
  };
  Landing land(Vec3 plane) const;
  double surface_scale(double azimuth_deg) const;

  Geodetic origin_;
  Frame axes_;  // east, north, up in ECEF
  Pose to_ecef_;
};

}  // namespace suite
