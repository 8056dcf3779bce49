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
  std::string fault;                 // why there is none
};

Mapped mapped(std::span<const Vec3> enu, std::span<const Geodetic> places) {
  Mapped m;
  if (places.empty()) {
    for (const Vec3& p : enu) m.places.push_back({p.x, p.y});
    m.name = {"Arbitrary"}, m.remarks = {"0", "units=Meters"};
    return m;
  }
  // The zone of the middle of all longitudes; those of one picture lie on one side of the Earth.
  double x = 0, y = 0, latitude = 0, count = 0, most = 0;
  for (const Geodetic& p : places) {
    if (!std::isfinite(p.latitude_deg)) continue;
    x += std::cos(p.longitude_deg * kDegree), y += std::sin(p.longitude_deg * kDegree);
    latitude += p.latitude_deg, ++count;
    most = std::max(most, p.latitude_deg > 0 ? p.latitude_deg / 84 : p.latitude_deg / -80);
  }
  if (!(count > 0)) return m.fault = "nothing was hit", m;
  if (most > 1) return m.fault = "it reaches beyond 84 N or 80 S, where UTM ends", m;
  const UtmZone zone = standard_utm_zone({latitude / count, std::atan2(y, x) / kDegree, 0});
  const double meridian = 6 * zone.zone - 183;
  for (const Geodetic& p : places) {
    if (!std::isfinite(p.latitude_deg)) {
      m.places.push_back({NAN, NAN});
      continue;
    }
    if (std::fabs(std::remainder(p.longitude_deg - meridian, 360)) > kUtmReach)
      return m.fault = strf("it reaches beyond %g degrees from the meridian of UTM zone %d", kUtmReach, zone.zone), m;
    const UtmPoint u = utm_from_geodetic(p, zone);
    m.places.push_back({u.easting, u.northing});
  }
  m.name = {"UTM"};
  m.remarks = {std::to_string(zone.zone), zone.north ? "North" : "South", "WGS-84", "units=Meters"};
  return m;
}

void write_igm(const std::string& path, const LocatedImage& image, std::span<const Geodetic> places) {
  EnviHeader h = bare(image.header);
  h.type = EnviType::float64;
  h.interleave = Interleave::bsq;
  h.bands = 3;
  h.map_info.clear(), h.coordinate_system.clear();
  h.ignore_value = std::nan("");
  h.band_names = places.empty() ? std::vector<std::string>{"east [m]", "north [m]", "up [m]"}
                                : std::vector<std::string>{"longitude [deg]", "latitude [deg]", "height [m]"};
  h.description = (places.empty() ? "input geometry: east, north and up in scene ENU"
                                  : "input geometry: longitude, latitude and ellipsoidal height, WGS84") +
                  std::string(" of the middle of what each pixel saw") + image.about;
  std::vector<double> values;
  values.reserve(3 * image.place.size());
  for (size_t i = 0; i < image.place.size(); ++i)
    if (places.empty())
      values.insert(values.end(), {image.place[i].x, image.place[i].y, image.place[i].z});
    else
      values.insert(values.end(), {places[i].longitude_deg, places[i].latitude_deg, places[i].height_m});
  write_envi(path, h, values);
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
  std::vector<double> values;
  values.reserve(2 * grid.sample.size());
  for (size_t i = 0; i < grid.sample.size(); ++i)
    values.insert(values.end(), {static_cast<double>(grid.sample[i]), static_cast<double>(grid.line[i])});
  write_envi(path, h, values);
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
                    name + ".img", name + "_igm.img");
}

}  // namespace

std::vector<std::string> write_geolocation(const LocatedImage& image, const SceneNotes& notes) {
  std::vector<Geodetic> places;
  if (notes.origin.given) {
    const SceneFrame frame({notes.origin.latitude_deg, notes.origin.longitude_deg, notes.origin.ellipsoid_height_m});
    for (const Vec3& p : image.place)
      places.push_back(std::isfinite(p.x) ? frame.geodetic_from_enu(p) : Geodetic{NAN, NAN, NAN});
  }
  std::vector<std::string> files{image.base + "_igm.img"};
  write_igm(files[0], image, places);
  if (!places.empty()) {
    files.push_back(image.base + "_geo.vrt");
    write_vrt(files.back(), image);
  }
  Mapped m = mapped(image.place, places);
  try {
    if (!m.fault.empty()) throw Error(m.fault);
    const auto columns = static_cast<uint32_t>(image.header.samples);
    const double cell = image.pixel_m > 0 ? image.pixel_m : spacing_of(m.places, columns).pixel();
    const std::optional<GroundGrid> grid = ground_grid(m.places, columns, cell);
    if (!grid) throw Error("nothing was hit");
    files.push_back(image.base + "_glt.img");
    write_glt(files.back(), image, m, *grid);
  } catch (const Error& e) {
    if (!e.where().file.empty()) throw;  // a file that cannot be written
    warn("'" + image.base + ".img' gets no lookup table (GLT): " + e.message() +
         (e.hint().empty() ? "" : "; " + e.hint()));
  }
  return files;
}

}  // namespace suite
