#include "geolocation.h"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "base/run_app.h"
#include "formats/las_write/las_write.h"

namespace suite {

namespace {

void write_igm(const std::string& path, const LocatedImage& image, const GroundPlaces& places) {
  EnviHeader h = bare(image.header);
  h.type = EnviType::float64;
  h.interleave = Interleave::bsq;
  h.bands = 3;
  h.map_info.clear(), h.coordinate_system.clear();
  h.ignore_value = std::nan("");
  h.band_names = places.on_earth() ? std::vector<std::string>{"longitude [deg]", "latitude [deg]", "height [m]"}
                                   : std::vector<std::string>{"east [m]", "north [m]", "up [m]"};
  h.description = (places.on_earth() ? "input geometry: longitude, latitude and ellipsoidal height, WGS84"
                                     : "input geometry: east, north and up in scene ENU") +
                  std::string(" of the middle of what each pixel saw") + image.about;
  EnviWriter writer(path, h);
  std::vector<double> row;
  for (size_t i = 0; i < places.size(); ++i) {
    const std::array<double, 3> at = places.triple(i);
    row.insert(row.end(), at.begin(), at.end());
    if ((i + 1) % h.samples) continue;
    writer.append(row);
    row.clear();
  }
  writer.commit();
}

void write_glt(const std::string& path, const LocatedImage& image, const GroundMap& m) {
  const GroundGrid& grid = m.grid;
  EnviHeader h = bare(image.header);
  h.samples = grid.columns, h.lines = grid.rows, h.bands = 2;
  h.type = EnviType::int32;
  h.interleave = Interleave::bsq;
  h.coordinate_system = wkt_of_epsg(m.epsg);  // GDAL knows UTM on WGS84 alone by ENVI's words
  h.band_names = {"GLT Sample Lookup", "GLT Line Lookup"};
  h.ignore_value = 0;
  h.map_info = {m.name};
  for (const std::string& item : {std::string("1"), std::string("1"), strf("%.12g", grid.west),
                                  strf("%.12g", grid.north), strf("%.10g", grid.cell), strf("%.10g", grid.cell)})
    h.map_info.push_back(item);
  h.map_info.insert(h.map_info.end(), m.remarks.begin(), m.remarks.end());
  h.description = "geographic lookup table: sample and line of '" +
                  std::filesystem::path(image.base).filename().string() +
                  ".img' that show a cell; negative: the nearest neighbour, 0: not seen" + image.about;
  EnviWriter writer(path, h);
  std::vector<double> row(2 * size_t{grid.columns});
  for (size_t first = 0; first < grid.sample.size(); first += grid.columns) {
    for (size_t c = 0; c < grid.columns; ++c)
      row[2 * c] = grid.sample[first + c], row[2 * c + 1] = grid.line[first + c];
    writer.append(row);
  }
  writer.commit();
}

void write_vrt(const std::string& path, const LocatedImage& image) {
  const EnviHeader& h = image.header;
  const std::string name = std::filesystem::path(image.base).filename().string();
  FloatRaster raster;
  raster.width = static_cast<uint32_t>(h.samples), raster.height = static_cast<uint32_t>(h.lines);
  for (const std::string& band : h.band_names) raster.bands.push_back({band});
  raster.units = h.data_units;
  raster.no_data = h.ignore_value;
  write_located_vrt(path, raster,
                    h.type == EnviType::uint16    ? "UInt16"
                    : h.type == EnviType::float64 ? "Float64"
                                                  : "Float32",
                    image.scale, name + ".img", name + "_igm.img");
}

}  // namespace

std::vector<std::string> write_geolocation(const LocatedImage& image, const GroundPlaces& places,
                                           const GroundMap* map) {
  std::vector<std::string> files{image.base + "_igm.img"};
  write_igm(files[0], image, places);
  if (places.on_earth()) {
    files.push_back(image.base + "_geo.vrt");
    write_vrt(files.back(), image);
  }
  if (!map) return files;
  files.push_back(image.base + "_glt.img");
  write_glt(files.back(), image, *map);
  return files;
}

}  // namespace suite
