#include "geolocation.h"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "base/run_app.h"
#include "motion/scene_frame.h"
#include "sensor/ground_grid.h"

namespace suite {

namespace {

constexpr double kUtmReach = 9;  // degrees of longitude from the central meridian of a grid

// Pixels as places of a map, and what the map is called in a header.
struct Mapped {
  std::vector<Vec2> places;
  std::vector<std::string> name;     // of the projection
  std::vector<std::string> remarks;  // what follows the size of a pixel
};

// Where the pixels are, in the words of the scene: on the Earth, or on a plane.
class Places {
 public:
  Places(const std::vector<Vec3>& enu, const GeodeticOrigin& origin) : enu_(enu) {
    if (origin.given) frame_.emplace(Geodetic{origin.latitude_deg, origin.longitude_deg, origin.ellipsoid_height_m});
  }
  bool on_earth() const { return frame_.has_value(); }
  size_t size() const { return enu_.size(); }
  bool known(size_t i) const { return std::isfinite(enu_[i].x); }
  const Vec3& enu(size_t i) const { return enu_[i]; }
  Geodetic geodetic(size_t i) const { return frame_->geodetic_from_enu(enu_[i]); }
  // Longitude, latitude and height, or east, north and up; NaN when unknown.
  std::array<double, 3> triple(size_t i) const {
    if (!known(i)) return {NAN, NAN, NAN};
    if (!on_earth()) return {enu_[i].x, enu_[i].y, enu_[i].z};
    const Geodetic g = geodetic(i);
    return {g.longitude_deg, g.latitude_deg, g.height_m};
  }

 private:
  const std::vector<Vec3>& enu_;
  std::optional<SceneFrame> frame_;
};

// The UTM grid of the middle of all places; the picture shows one side of the Earth. Error where UTM ends.
UtmZone zone_of(const Places& places) {
  double x = 0, y = 0, latitude = 0, count = 0, most = 0;
  for (size_t i = 0; i < places.size(); ++i) {
    if (!places.known(i)) continue;
    const Geodetic p = places.geodetic(i);
    x += std::cos(p.longitude_deg * kDegree), y += std::sin(p.longitude_deg * kDegree);
    latitude += p.latitude_deg, ++count;
    most = std::max(most, p.latitude_deg > 0 ? p.latitude_deg / 84 : p.latitude_deg / -80);
  }
  if (!(count > 0)) throw Error("nothing was hit");
  if (most > 1) throw Error("it reaches beyond 84 N or 80 S, where UTM ends");
  return standard_utm_zone({latitude / count, std::atan2(y, x) / kDegree, 0});
}

// Error: why there is no map.
Mapped mapped(const Places& places) {
  Mapped m;
  if (!places.on_earth()) {
    for (size_t i = 0; i < places.size(); ++i) m.places.push_back({places.enu(i).x, places.enu(i).y});
    m.name = {"Arbitrary"}, m.remarks = {"0", "units=Meters"};
    return m;
  }
  const UtmZone zone = zone_of(places);
  const double meridian = 6 * zone.zone - 183;
  for (size_t i = 0; i < places.size(); ++i) {
    if (!places.known(i)) {
      m.places.push_back({NAN, NAN});
      continue;
    }
    const Geodetic p = places.geodetic(i);
    if (std::fabs(std::remainder(p.longitude_deg - meridian, 360)) > kUtmReach)
      throw Error(strf("it reaches beyond %g degrees from the meridian of UTM zone %d", kUtmReach, zone.zone));
    const UtmPoint u = utm_from_geodetic(p, zone);
    m.places.push_back({u.easting, u.northing});
  }
  m.name = {"UTM"};
  m.remarks = {std::to_string(zone.zone), zone.north ? "North" : "South", "WGS-84", "units=Meters"};
  return m;
}

void write_igm(const std::string& path, const LocatedImage& image, const Places& places) {
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

void write_glt(const std::string& path, const LocatedImage& image, const Mapped& m, const GroundGrid& grid) {
  EnviHeader h = bare(image.header);
  h.samples = grid.columns, h.lines = grid.rows, h.bands = 2;
  h.type = EnviType::int32;
  h.interleave = Interleave::bsq;
  h.coordinate_system.clear();
  h.band_names = {"GLT Sample Lookup", "GLT Line Lookup"};
  h.ignore_value = 0;
  h.map_info = m.name;
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

std::vector<std::string> write_geolocation(const LocatedImage& image, const SceneNotes& notes) {
  const Places places(image.place, notes.origin);
  std::vector<std::string> files{image.base + "_igm.img"};
  write_igm(files[0], image, places);
  if (places.on_earth()) {
    files.push_back(image.base + "_geo.vrt");
    write_vrt(files.back(), image);
  }
  Mapped m;
  std::optional<GroundGrid> grid;
  try {
    m = mapped(places);
    const auto columns = static_cast<uint32_t>(image.header.samples);
    grid = ground_grid(m.places, columns, image.pixel_m > 0 ? image.pixel_m : spacing_of(m.places, columns).pixel());
    if (!grid) throw Error("nothing was hit");
  } catch (const Error& e) {
    warn("'" + image.base + ".img' gets no lookup table (GLT): " + e.message() +
         (e.hint().empty() ? "" : "; " + e.hint()));
    return files;
  }
  files.push_back(image.base + "_glt.img");
  write_glt(files.back(), image, m, *grid);
  return files;
}

}  // namespace suite
