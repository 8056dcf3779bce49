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

Reader::EarthMap Reader::earth_map(int epsg, const Where& where) const {
  if (const auto system = map_system_of_epsg(epsg)) return {system, nullptr};
  try {
    return {std::nullopt, std::make_shared<const MapProjection>(epsg)};
  } catch (const Error& e) {
    throw Error(where, strf("EPSG:%d is not known here, and ", epsg) + e.message(),
                (e.hint().empty() ? "" : e.hint() + "; ") + known_systems(), "SP504");
  }
}

void Reader::report_projection(const EarthMap& map, int epsg, const Params& file) {
  if (!map.projection) return;
  report_.add("SP707", file.as_text(),
              {file.where(), strf("EPSG:%d, '", epsg) + printable(map.projection->name()) + "', is brought to WGS84 " +
                                 map.projection->description()});
}

std::function<Vec3(Vec3)> Reader::on_earth(const EarthMap& map, const GeoidRule& rule) const {
  const SceneFrame frame({draft_.origin.latitude_deg, draft_.origin.longitude_deg, draft_.origin.ellipsoid_height_m});
  const bool grid = rule.geoid && !rule.separation_m;
  if (map.system) return enu_of_map(*map.system, frame, rule.separation_m.value_or(0), grid ? geoid_ : std::nullopt);
  const double separation = rule.separation_m.value_or(0);
  return [=, by = map.projection, geoid = grid ? geoid_ : std::nullopt](Vec3 p) {
    Geodetic g = by->geographic() ? by->place(p.y, p.x, p.z) : by->place(p.x, p.y, p.z);
    check_geodetic(g);
    g.height_m += geoid ? geoid->height_m(g.latitude_deg, g.longitude_deg) : separation;
    return frame.enu_from_geodetic(g);
  };
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
  const auto add_finding = [&](const std::string& what) { report_.add("SP707", file.as_text(), {file.where(), what}); };
  if (const auto local = p.find("local")) {
    const auto at = local->as_vec3();
    if (draft_.origin.given)
      add_finding("the map is taken as flat around 'local': its north and its scale are not turned and corrected");
    return [at](Vec3 v) { return v - Vec3{at[0], at[1], at[2]}; };
  }
  std::optional<int> epsg = epsg_of_name(system);
  if (const auto given = p.find("epsg")) epsg = static_cast<int>(given->as_integer(1, 999999));
  if (!epsg)
    throw file.error("'" + file.as_text() + "' " +
                         (system.empty() ? "names no reference system" : "is in '" + printable(system) + "'"),
                     "give 'epsg', or 'local: [x, y, z]', what of its map is the scene's origin", "SP504");
  const EarthMap known = earth_map(*epsg, file.where());
  if (!draft_.origin.given)
    throw file.error("what is on a map needs the scene's 'origin'", "or 'local: [x, y, z]'", "SP504");
  if (known.heights() == MapSystem::Heights::geoid && !p.has("height"))
    throw file.error(strf("heights of EPSG:%d count from ", *epsg) + printable(known.heights_name()),
                     "say 'height: geoid', or 'ellipsoid' to take them as they are", "SP504");
  const GeoidRule rule = read_heights_rule(p);
  if (known.heights() == MapSystem::Heights::unknown && !p.has("height"))
    add_finding(
        strf("EPSG:%d says nothing of heights; they are taken as above the ellipsoid ('height: geoid' if not)", *epsg));
  report_projection(known, *epsg, file);
  const auto place = [on = on_earth(known, rule), file](Vec3 v) {
    try {
      return on(v);
    } catch (const Error& e) {
      throw file.error(
          strf("'%s' has a place at (%.9g, %.9g, %.9g): ", file.as_text().c_str(), v.x, v.y, v.z) + e.message(),
          e.hint(), "SP504");
    }
  };
  if (!known.geographic() || !longitude_first) return place;
  return [place](Vec3 v) { return place({v.y, v.x, v.z}); };
}

}  // namespace suite::scene_text
