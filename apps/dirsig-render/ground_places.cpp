#include "ground_places.h"

#include <algorithm>

#include "base/run_app.h"
#include "motion/map_system.h"

namespace suite {

namespace {

constexpr double kUtmReach = 9;                      // degrees of longitude from the central meridian of a grid
constexpr double kDegreeM = 111.2e3;                 // of latitude
constexpr int kUtmNorth = 32600, kUtmSouth = 32700;  // EPSG: the zone is added

// The middle of all places, whose picture shows one side of the Earth. Error: nothing was hit.
Geodetic middle_of(const GroundPlaces& places) {
  double x = 0, y = 0, latitude = 0, count = 0;
  for (size_t i = 0; i < places.size(); ++i) {
    if (!places.known(i)) continue;
    const Geodetic p = places.geodetic(i);
    x += std::cos(p.longitude_deg * kDegree), y += std::sin(p.longitude_deg * kDegree);
    latitude += p.latitude_deg, ++count;
  }
  if (!(count > 0)) throw Error("nothing was hit");
  return {latitude / count, std::atan2(y, x) / kDegree, 0};
}

// The UTM grid of the middle. Error where UTM ends.
int utm_epsg(const GroundPlaces& places, const Geodetic& middle) {
  for (size_t i = 0; i < places.size(); ++i)
    if (places.known(i))
      if (const double latitude = places.geodetic(i).latitude_deg; latitude > 84 || latitude < -80)
        throw Error("it reaches beyond 84 N or 80 S, where UTM ends", "geolocation: {crs: degrees}");
  const UtmZone zone = standard_utm_zone(middle);
  return (zone.north ? kUtmNorth : kUtmSouth) + zone.zone;
}

void name_system(int epsg, const MapSystem& system, GroundMap& m) {
  const bool etrs = epsg == 4258 || (epsg > 25800 && epsg < 25900);
  const std::string datum = etrs ? "ETRS-89" : "WGS-84";
  m.epsg = epsg;
  m.geographic = !system.zone;
  if (!system.zone) {
    m.name = "Geographic Lat/Lon", m.remarks = {datum, "units=Degrees"}, m.unit_m = kDegreeM;
    return;
  }
  m.name = "UTM";
  m.remarks = {std::to_string(system.zone->zone), system.zone->north ? "North" : "South", datum, "units=Meters"};
}

void place_on_earth(const GroundPlaces& places, int epsg, GroundMap& m) {
  const Geodetic middle = middle_of(places);
  if (!epsg) epsg = utm_epsg(places, middle);
  const MapSystem system = map_system_of_epsg(epsg).value();
  name_system(epsg, system, m);
  const double about = system.zone ? 6 * system.zone->zone - 183 : middle.longitude_deg;
  for (size_t i = 0; i < places.size(); ++i) {
    if (!places.known(i)) {
      m.places.push_back({NAN, NAN});
      continue;
    }
    Geodetic p = places.geodetic(i);
    const double off = std::remainder(p.longitude_deg - about, 360);
    if (system.zone && std::fabs(off) > kUtmReach)
      throw Error(strf("it reaches beyond %g degrees from the meridian of UTM zone %d", kUtmReach, system.zone->zone));
    if (!system.zone) p.longitude_deg = about + off;  // in one piece across 180 degrees
    m.places.push_back(map_of_geodetic(system, p));
  }
}

}  // namespace

GroundPlaces::GroundPlaces(const std::vector<Vec3>& enu, uint32_t columns, const GeodeticOrigin& origin)
    : enu_(enu), columns_(columns) {
  if (origin.given) frame_.emplace(Geodetic{origin.latitude_deg, origin.longitude_deg, origin.ellipsoid_height_m});
}

std::array<double, 3> GroundPlaces::triple(size_t i) const {
  if (!known(i)) return {NAN, NAN, NAN};
  if (!on_earth()) return {enu_[i].x, enu_[i].y, enu_[i].z};
  const Geodetic g = geodetic(i);
  return {g.longitude_deg, g.latitude_deg, g.height_m};
}

GroundMap ground_map(const GroundPlaces& places, int epsg, double pixel) {
  GroundMap m;
  if (places.on_earth()) {
    place_on_earth(places, epsg, m);
  } else {
    for (size_t i = 0; i < places.size(); ++i) m.places.push_back({places.enu(i).x, places.enu(i).y});
    m.name = "Arbitrary", m.remarks = {"0", "units=Meters"};
  }
  auto grid =
      ground_grid(m.places, places.columns(), pixel > 0 ? pixel : spacing_of(m.places, places.columns()).pixel());
  if (!grid) throw Error("nothing was hit");
  m.grid = std::move(*grid);
  return m;
}

}  // namespace suite
