#include "motion/scene_frame.h"

#include <GeographicLib/Geocentric.hpp>
#include <GeographicLib/Geodesic.hpp>
#include <GeographicLib/TransverseMercator.hpp>
#include <GeographicLib/UTMUPS.hpp>
#include <cctype>

#include "base/error.h"

namespace suite {

namespace {

constexpr double kFalseEasting = 500000, kFalseNorthing = 1e7;  // m, the southern grids count from the equator + 1e7

double central_meridian_deg(int zone) { return 6.0 * zone - 183; }

double normalized_longitude_deg(double lon) {
  const double wrapped = std::remainder(lon, 360.0);
  return wrapped == 180 ? -180 : wrapped;
}

void check_zone(UtmZone grid) {
  if (grid.zone < 1 || grid.zone > 60) throw Error(strf("UTM zone %d does not exist", grid.zone), "zones are 1 to 60");
}

// East, north, up at a place, in ECEF (rows).
Frame axes_at(double latitude_deg, double longitude_deg) {
  const double phi = latitude_deg * kDegree, lambda = longitude_deg * kDegree;
  const double sp = std::sin(phi), sl = std::sin(lambda), cl = std::cos(lambda);
  const double cp = std::fabs(latitude_deg) == 90 ? 0.0 : std::cos(phi);
  return {{-sl, cl, 0}, {-sp * cl, -sp * sl, cp}, {cp * cl, cp * sl, sp}};
}

Pose pose_of(const Frame& f, Vec3 translation) {
  return {quat_from_matrix({{f.x.x, f.y.x, f.z.x, f.x.y, f.y.y, f.z.y, f.x.z, f.y.z, f.z.z}, {}}), translation};
}

constexpr double kReach = 5e6;  // m, how far the curved plane may extend

}  // namespace

void check_geodetic(const Geodetic& g) {
  if (!(g.latitude_deg >= -90 && g.latitude_deg <= 90))
    throw Error(strf("latitude %g is outside its range", g.latitude_deg), "give -90 to 90 degrees, north positive");
  if (!(g.longitude_deg >= -180 && g.longitude_deg <= 360))
    throw Error(strf("longitude %g is outside its range", g.longitude_deg), "give -180 to 360 degrees, east positive");
  if (!(g.height_m >= -1e5 && g.height_m <= 1e10))
    throw Error(strf("height %g is outside its range", g.height_m), "give -1e5 to 1e10 m above the ellipsoid");
}

Vec3 ecef_from_geodetic(const Geodetic& g) {
  check_geodetic(g);
  Vec3 p;
  GeographicLib::Geocentric::WGS84().Forward(g.latitude_deg, g.longitude_deg, g.height_m, p.x, p.y, p.z);
  return p;
}

Geodetic geodetic_from_ecef(Vec3 p) {
  Geodetic g;
  GeographicLib::Geocentric::WGS84().Reverse(p.x, p.y, p.z, g.latitude_deg, g.longitude_deg, g.height_m);
  g.longitude_deg = normalized_longitude_deg(g.longitude_deg);
  return g;
}

UtmZone standard_utm_zone(const Geodetic& g) {
  check_geodetic(g);
  const int zone = GeographicLib::UTMUPS::StandardZone(g.latitude_deg, g.longitude_deg);
  if (zone < 1)
    throw Error(strf("UTM does not reach latitude %g", g.latitude_deg), "UTM covers 80 degrees south to 84 north");
  return {zone, g.latitude_deg >= 0};
}

UtmPoint utm_from_geodetic(const Geodetic& g, UtmZone grid) {
  check_geodetic(g);
  check_zone(grid);
  const double from_center = normalized_longitude_deg(g.longitude_deg - central_meridian_deg(grid.zone));
  if (std::fabs(from_center) > 30)
    throw Error(
        strf("longitude %g is %g degrees from the middle of UTM zone %d", g.longitude_deg, from_center, grid.zone),
        "use a zone within 30 degrees");
  UtmPoint u{grid, 0, 0, g.height_m};
  GeographicLib::TransverseMercator::UTM().Forward(0, g.latitude_deg, from_center, u.easting, u.northing);
  u.easting += kFalseEasting;
  if (!grid.north) u.northing += kFalseNorthing;
  return u;
}

Geodetic geodetic_from_utm(const UtmPoint& u) {
  check_zone(u.grid);
  if (!(u.easting >= -2.5e6 && u.easting <= 3.5e6))
    throw Error(strf("UTM easting %g is outside its range", u.easting),
                "give metres, about 166000 to 834000 inside a zone");
  if (!(u.northing >= -1e7 && u.northing <= 2e7))
    throw Error(strf("UTM northing %g is outside its range", u.northing), "give metres, 0 to 1e7");
  Geodetic g;
  g.height_m = u.height_m;
  const double northing = u.grid.north ? u.northing : u.northing - kFalseNorthing;
  GeographicLib::TransverseMercator::UTM().Reverse(central_meridian_deg(u.grid.zone), u.easting - kFalseEasting,
                                                   northing, g.latitude_deg, g.longitude_deg);
  g.longitude_deg = normalized_longitude_deg(g.longitude_deg);
  return g;
}

std::optional<UtmZone> utm_zone_of_epsg(int epsg) {
  if (epsg >= 32601 && epsg <= 32660) return UtmZone{epsg - 32600, true};
  if (epsg >= 32701 && epsg <= 32760) return UtmZone{epsg - 32700, false};
  if (epsg >= 25828 && epsg <= 25838) return UtmZone{epsg - 25800, true};
  return std::nullopt;
}

std::optional<UtmZone> utm_zone_of_text(const std::string& text) {
  size_t i = 0;
  int zone = 0;
  while (i < text.size() && i < 2 && std::isdigit(static_cast<unsigned char>(text[i])))
    zone = zone * 10 + (text[i++] - '0');
  while (i < text.size() && text[i] == ' ') ++i;
  std::string side = text.substr(i);
  for (char& c : side) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  const bool north = side == "n" || side == "north", south = side == "s" || side == "south";
  if (zone < 1 || zone > 60 || !(north || south)) return std::nullopt;
  return UtmZone{zone, north};
}

SceneFrame::SceneFrame(const Geodetic& origin) : origin_(origin) {
  check_geodetic(origin);
  origin_.longitude_deg = normalized_longitude_deg(origin.longitude_deg);
  axes_ = axes_at(origin_.latitude_deg, origin_.longitude_deg);
  to_ecef_ = pose_of(axes_, ecef_from_geodetic(origin_));
}

Frame SceneFrame::local_axes(Vec3 enu) const {
  const Geodetic g = geodetic_from_enu(enu);
  const Frame ecef = axes_at(g.latitude_deg, g.longitude_deg);
  return {enu_direction(ecef.x), enu_direction(ecef.y), enu_direction(ecef.z)};
}

// Length along the ellipsoid per length along the surface at the origin's height: R/(R + h), with Euler's radius of
// curvature R of the normal section in that azimuth.
double SceneFrame::surface_scale(double azimuth_deg) const {
  const auto& earth = GeographicLib::Geocentric::WGS84();
  const double a = earth.EquatorialRadius(), e2 = earth.Flattening() * (2 - earth.Flattening());
  const double s = std::sin(origin_.latitude_deg * kDegree), w2 = 1 - e2 * s * s;
  const double meridian = a * (1 - e2) / (w2 * std::sqrt(w2)), normal = a / std::sqrt(w2);
  const double sa = std::sin(azimuth_deg * kDegree), ca = std::cos(azimuth_deg * kDegree);
  const double radius = 1 / (ca * ca / meridian + sa * sa / normal);
  return radius / (radius + origin_.height_m);
}

SceneFrame::Landing SceneFrame::land(Vec3 plane) const {
  const double r = std::hypot(plane.x, plane.y);
  if (!(r <= kReach))
    throw Error(strf("a point %g m from the scene origin cannot be laid onto the curved Earth", r),
                "the flat plane may extend 5000 km from the origin");
  Landing l;
  l.azimuth_here_deg = std::atan2(plane.x, plane.y) / kDegree;
  GeographicLib::Geodesic::WGS84().Direct(origin_.latitude_deg, origin_.longitude_deg, l.azimuth_here_deg,
                                          r * surface_scale(l.azimuth_here_deg), l.place.latitude_deg,
                                          l.place.longitude_deg, l.azimuth_there_deg);
  l.place.height_m = origin_.height_m + plane.z;
  return l;
}

Vec3 SceneFrame::curved(Vec3 plane) const { return enu_from_geodetic(land(plane).place); }

Vec3 SceneFrame::flattened(Vec3 enu) const {
  const Geodetic g = geodetic_from_enu(enu);
  double distance = 0, azimuth_here = 0, azimuth_there = 0;
  GeographicLib::Geodesic::WGS84().Inverse(origin_.latitude_deg, origin_.longitude_deg, g.latitude_deg, g.longitude_deg,
                                           distance, azimuth_here, azimuth_there);
  const double r = distance / surface_scale(azimuth_here), azimuth = azimuth_here * kDegree;
  return {r * std::sin(azimuth), r * std::cos(azimuth), g.height_m - origin_.height_m};
}

Quat SceneFrame::curved_rotation(Vec3 plane) const {
  const Landing l = land(plane);
  const Frame ecef = axes_at(l.place.latitude_deg, l.place.longitude_deg);
  // The plane's axes at the landing place: the azimuth there counts from true north, here from the plane's y.
  const double turn = (l.azimuth_here_deg - l.azimuth_there_deg) * kDegree, c = std::cos(turn), s = std::sin(turn);
  const Vec3 x = ecef.x * c + ecef.y * s, y = ecef.y * c - ecef.x * s;
  return pose_of({enu_direction(x), enu_direction(y), enu_direction(ecef.z)}, {}).rotation;
}

}  // namespace suite
