#include "motion/map_system.h"

#include <algorithm>
#include <cctype>
#include <cstdlib>

namespace suite {

std::optional<MapSystem> map_system_of_epsg(int epsg) {
  using enum MapSystem::Heights;
  if (const auto zone = utm_zone_of_epsg(epsg)) return MapSystem{zone, unknown};
  struct Row {
    int epsg, zone;  // 0: geographic
    MapSystem::Heights heights;
  };
  // From the EPSG dataset (names and axes checked with pyproj's); heights over EVRF2007 (7423), EGM2008 (9518), JGD2011
  // (6697), NN2000 (5942, 5971 to 5975), DHHN92 (5554 to 5556) and DVR90 (7416, 7417).
  constexpr Row rows[] = {{4326, 0, unknown}, {4979, 0, ellipsoid}, {4258, 0, unknown}, {4937, 0, ellipsoid},
                          {6668, 0, unknown}, {6697, 0, geoid},     {9518, 0, geoid},   {7423, 0, geoid},
                          {5942, 0, geoid},   {5554, 31, geoid},    {5555, 32, geoid},  {5556, 33, geoid},
                          {5971, 31, geoid},  {5972, 32, geoid},    {5973, 33, geoid},  {5974, 34, geoid},
                          {5975, 35, geoid},  {7416, 32, geoid},    {7417, 33, geoid}};
  const auto* row = std::find_if(std::begin(rows), std::end(rows), [&](const Row& r) { return r.epsg == epsg; });
  if (row == std::end(rows)) return std::nullopt;
  return MapSystem{row->zone ? std::optional(UtmZone{row->zone, true}) : std::nullopt, row->heights};
}

std::optional<int> epsg_of_name(const std::string& name) {
  std::string upper = name;
  std::transform(upper.begin(), upper.end(), upper.begin(),
                 [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  const size_t at = upper.find("EPSG");
  if (at == upper.npos) {
    // As German surveys name theirs: urn:adv:crs:ETRS89_UTM32*DE_DHHN2016_NH.
    const size_t utm = upper.find("ETRS89_UTM");
    if (utm == upper.npos) return std::nullopt;
    const int epsg = 25800 + std::atoi(upper.substr(utm + 10, 2).c_str());
    return utm_zone_of_epsg(epsg) ? std::optional(epsg) : std::nullopt;
  }
  // Behind EPSG: a version between colons or slashes, then the code, up to that of the heights.
  const std::string tail = upper.substr(at + 4, upper.find_first_of(",+&", at) - at - 4);
  const size_t last = tail.find_last_of("0123456789");
  if (last == tail.npos) return std::nullopt;
  size_t first = last;
  while (first > 0 && std::isdigit(static_cast<unsigned char>(tail[first - 1]))) --first;
  if (last - first > 6) return std::nullopt;
  return std::atoi(tail.substr(first, last - first + 1).c_str());
}

Vec2 map_of_geodetic(const MapSystem& system, const Geodetic& place) {
  if (!system.zone) return {place.longitude_deg, place.latitude_deg};
  const UtmPoint u = utm_from_geodetic(place, *system.zone);
  return {u.easting, u.northing};
}

std::function<Vec3(Vec3)> enu_of_map(const MapSystem& system, const SceneFrame& frame, double separation_m,
                                     std::optional<Geoid> geoid) {
  return [=](Vec3 p) {
    Geodetic g;
    if (system.zone)
      g = geodetic_from_utm({*system.zone, p.x, p.y, p.z});
    else
      g = {p.x, p.y, p.z};
    check_geodetic(g);
    g.height_m += geoid ? geoid->height_m(g.latitude_deg, g.longitude_deg) : separation_m;
    return frame.enu_from_geodetic(g);
  };
}

}  // namespace suite
