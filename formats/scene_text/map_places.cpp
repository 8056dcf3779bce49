// Where coordinates of maps are in the scene, and heights above the geoid.
#include <cmath>

#include "formats/scene_text/reader.h"

namespace suite::scene_text {

// The grid of geoid heights is read first: the origin's own height may count from it.
void Reader::read_origin(const Params& p) {
  GeodeticOrigin& origin = draft_.origin;
  origin.latitude_deg = p.number_in("latitude_deg", -90, 90, "degrees");
  origin.longitude_deg = p.number_in("longitude_deg", -180, 360, "degrees");
  origin.ellipsoid_height_m = p.number_in("height_m", -12000, 1e7, "m above the WGS84 ellipsoid", 0);
  if (const auto grid = p.find("geoid")) {
    try {
      geoid_ = Geoid(inputs_.path_of(grid->as_text()));
      input(*grid);
    } catch (const Error& e) {
      throw Error(grid->where(), "'" + grid->as_text() + "': " + e.message(), e.hint(), "SP003");
    }
  }
  if (const auto height = p.find("height"); height && height->as_choice({"ellipsoid", "geoid"}) == 1) {
    if (!geoid_) throw height->error("a height above the geoid needs 'geoid', the file of a grid");
    origin.ellipsoid_height_m += geoid_->height_m(origin.latitude_deg, origin.longitude_deg);
  }
  origin.given = true;
}

Reader::GeoidRule Reader::read_heights_rule(const Params& p) {
  GeoidRule rule;
  const auto height = p.find("height");
  rule.geoid = height && height->as_choice({"ellipsoid", "geoid"}) == 1;
  if (!rule.geoid) return rule;
  if (p.has("geoid_separation_m")) {
    rule.separation_m = p.number_in("geoid_separation_m", -200, 200, "m, geoid above ellipsoid");
  } else if (!geoid_) {
    throw height->error("heights above the geoid need to know how high that is",
                        "give 'geoid_separation_m', or the origin a 'geoid', the file of a grid (egm96-5.pgm, ...)");
  }
  return rule;
}

std::function<Vec3(Vec3)> Reader::on_earth(const MapSystem& system, const GeoidRule& rule) const {
  const SceneFrame frame({draft_.origin.latitude_deg, draft_.origin.longitude_deg, draft_.origin.ellipsoid_height_m});
  const bool grid = rule.geoid && !rule.separation_m;
  return enu_of_map(system, frame, rule.separation_m.value_or(0), grid ? geoid_ : std::nullopt);
}

// What to do with other systems (NAD83, national grids): the program that warps to UTM around the origin.
std::string Reader::known_systems() const {
  const double longitude = draft_.origin.longitude_deg;
  const int zone = static_cast<int>(std::floor((longitude + 180) / 6)) % 60 + 1;
  return strf(
      "WGS84 or ETRS89, geographic or UTM, are; 'gdalwarp -t_srs EPSG:%d IN.tif OUT.tif' brings a raster there "
      "(heights stay "
      "as they are: NAVD88, EVRF and others count from the geoid, 'height: geoid')",
      (draft_.origin.latitude_deg < 0 ? 32700 : 32600) + zone);
}

// system: as the file names it, which `epsg` replaces. longitude_first: the file has degrees in this order.
std::function<Vec3(Vec3)> Reader::map_place(const Params& p, const std::string& system, const Params& file,
                                            bool longitude_first) {
  const auto tell = [&](const std::string& what) { report_.add("SP707", file.as_text(), {file.where(), what}); };
  if (const auto local = p.find("local")) {
    const auto at = local->as_vec3();
    if (draft_.origin.given)
      tell("the map is taken as flat around 'local': its north and its scale are not turned and corrected");
    return [at](Vec3 v) { return v - Vec3{at[0], at[1], at[2]}; };
  }
  std::optional<int> epsg = epsg_of_name(system);
  if (const auto given = p.find("epsg")) epsg = static_cast<int>(given->as_integer(1, 999999));
  const auto known = epsg ? map_system_of_epsg(*epsg) : std::nullopt;
  const std::string named = system.empty() ? "names no reference system" : "is in '" + printable(system) + "'";
  if (!known)
    throw file.error(
        "'" + file.as_text() + "' " + (epsg ? strf("is in EPSG:%d, which is not known here", *epsg) : named),
        "WGS84, ETRS89, JGD2011, geographic or UTM, are; or give 'local: [x, y, z]', what of its map is "
        "the scene's origin",
        "SP504");
  if (!draft_.origin.given)
    throw file.error("what is on a map needs the scene's 'origin'", "or 'local: [x, y, z]'", "SP504");
  if (known->heights == MapSystem::Heights::geoid && !p.has("height"))
    throw file.error(strf("heights of EPSG:%d count from the geoid", *epsg),
                     "say 'height: geoid', or 'ellipsoid' to take them as they are", "SP504");
  const GeoidRule rule = read_heights_rule(p);
  if (known->heights == MapSystem::Heights::unknown && !p.has("height"))
    tell(
        strf("EPSG:%d says nothing of heights; they are taken as above the ellipsoid ('height: geoid' if not)", *epsg));
  const auto place = [on = on_earth(*known, rule), file](Vec3 v) {
    try {
      return on(v);
    } catch (const Error& e) {
      throw file.error(
          strf("'%s' has a place at (%.9g, %.9g, %.9g): ", file.as_text().c_str(), v.x, v.y, v.z) + e.message(),
          e.hint(), "SP504");
    }
  };
  if (known->zone || !longitude_first) return place;
  return [place](Vec3 v) { return place({v.y, v.x, v.z}); };
}

}  // namespace suite::scene_text
