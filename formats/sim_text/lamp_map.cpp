#include "formats/sim_text/lamp_map.h"

#include <algorithm>
#include <cmath>

#include "base/files.h"
#include "base/run_app.h"
#include "formats/raster/raster.h"

namespace suite {

namespace {

void place(LampMap& map, const Params& p, const Params& file, const std::string& path) {
  if (const auto local = p.find("local")) {
    const std::vector<double> origin = local->at("origin").as_numbers();
    if (origin.size() != 2) throw local->at("origin").error("an origin is two numbers", "the outer corner [x, y], m");
    const Params size = local->at("gsd");
    const std::vector<double> gsd =
        size.kind() == Params::Kind::list ? size.as_numbers() : std::vector<double>(2, size.as_number());
    if (gsd.size() != 2 || !(gsd[0] > 0 && gsd[1] > 0)) throw size.error("a pixel has no size", "m, one number or two");
    map.to_map = {origin[0], gsd[0], 0, origin[1], 0, -gsd[1]};
    return;
  }
  const auto reference = [&] {
    try {
      return read_georeference(path);
    } catch (const Error& e) {
      throw file.error(e.message(), "a GeoTIFF, or 'local: {origin: [x, y], gsd: N}'");
    }
  }();
  map.system = map_system_of_epsg(reference.epsg);
  if (!map.system)
    throw file.error(strf("'%s' is in EPSG:%d, which is not known here", path.c_str(), reference.epsg),
                     "WGS84 or ETRS89, geographic or UTM: 'gdalwarp -t_srs EPSG:4326 IN.tif OUT.tif'");
  std::copy(std::begin(reference.to_map), std::end(reference.to_map), map.to_map.begin());
}

}  // namespace

std::shared_ptr<const LampMap> read_lamp_map(const Params& p) {
  const Params file = p.at("file");
  const std::string path = file.as_path();
  if (!file_exists(path))
    throw file.error("there is no file '" + path + "'", "relative names start at this file's folder");
  Raster raster = read_raster(path, size_t{1} << 26);
  if (raster.channels != 1)
    throw file.error(strf("'%s' has %u channels", path.c_str(), raster.channels), "one, of radiance");
  if (const auto mark = p.find("no_data")) raster.no_data = mark->as_number();
  auto map = std::make_shared<LampMap>();
  map->file = path, map->width = raster.width, map->height = raster.height;
  place(*map, p, file, path);
  map->values = values_of(std::move(raster), Numbers::scaled);
  size_t negative = 0;
  for (float& v : map->values) {
    negative += v < 0;
    if (!(v > 0)) v = 0;  // missing ones, too
    if (!std::isfinite(v)) throw file.error("'" + path + "' holds an infinite value");
  }
  if (std::none_of(map->values.begin(), map->values.end(), [](float v) { return v > 0; }))
    throw file.error("nothing glows in '" + path + "'");
  if (negative > 0)
    warn(strf("%s: %zu of %zu values are negative and count as dark", path.c_str(), negative, map->values.size()));
  return map;
}

}  // namespace suite
