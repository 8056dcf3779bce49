// Rasters of floating-point numbers out: TIFF with GeoTIFF keys and GDAL's metadata, and OpenEXR. See FORMAT.md.
#pragma once
#include <array>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace suite {

// A north-up picture: in a reference system of EPSG, on the plane tangent to WGS84 at a place (east and north in
// metres), or on a plane that is nowhere.
struct RasterPlacement {
  double west = 0, north = 0;                       // m, or degrees: outer corner of the first pixel
  double gsd_x = 0, gsd_y = 0;                      // the same, > 0; rows go south
  std::optional<std::array<double, 2>> origin_deg;  // latitude, longitude of the tangent point
  int epsg = 0;                                     // 0: none
  bool geographic = false;                          // of epsg: x is the longitude, y the latitude
};

// A ground control point: what a place in the picture shows. column, row: (0, 0) = outer corner of the first pixel.
struct GroundControl {
  double column = 0, row = 0;
  double x = 0, y = 0, z = 0;  // longitude and latitude, degrees, and height, m; or east, north, up on a plane
};

// RPC00B in the order of the GeoTIFF tag: two errors (m, negative: unknown), offsets and scales, four times 20 terms.
using RasterRpc = std::array<double, 92>;

struct RasterBand {
  std::string name;
  double wavelength_um = 0, fwhm_um = 0;  // 0 = none
};

// A raster and what is told about it.
struct FloatRaster {
  uint32_t width = 0, height = 0;
  std::vector<RasterBand> bands;
  std::string units;                             // of all bands; empty = none
  std::vector<size_t> display;                   // from 0: the bands to show as red, green and blue, or one as grey
  bool true_colour = false;                      // those three are what the eye sees as red, green and blue
  std::optional<double> no_data;                 // the number that means nothing is known, NaN too
  std::string utc;                               // ISO 8601, "2026-06-21T10:30:00.000000Z"; empty = no date
  std::optional<std::array<double, 2>> sun_deg;  // compass azimuth, elevation
  std::string comment;                           // goes into the file's description
  std::optional<RasterPlacement> placement;
  // Where there is no placement, in longitude and latitude on WGS84 unless `on_plane`.
  std::vector<GroundControl> control;
  bool on_plane = false;
  std::optional<RasterRpc> rpc;
  std::vector<std::pair<std::string, std::string>> remarks;  // further items of GDAL's metadata: names and values
  bool doubles = false;                                      // TIFF: 64-bit floats
};

// values: row-major, first row first, bands together; stored as 32-bit floats, whole or not at all. Error: not
// writable, sizes that do not fit.
void write_float_tiff(const std::string& path, const FloatRaster& raster, std::span<const float> values);
// The same row by row, asked for in their order: `row` fills in the numbers of one.
void write_float_tiff_rows(const std::string& path, const FloatRaster& raster,
                           const std::function<void(uint32_t row, std::span<double> values)>& row);
// The bands to show as the channels R, G and B (one as Y), and all of them under their names in the layer `bands`; no
// layer where there is nothing to show.
void write_exr(const std::string& path, const FloatRaster& raster, std::span<const float> values);

// A GDAL virtual raster beside an image: its bands, units and no-data value, and as its geolocation arrays the first
// two bands of `places` (longitude and latitude, WGS84, of the middle of every pixel). type: of the image, GDAL's name;
// scale: what one of its numbers stands for, 1 = they are in the units.
// image, places: names of files in the folder of the VRT, wherever GDAL is started from.
void write_located_vrt(const std::string& path, const FloatRaster& raster, const std::string& type, double scale,
                       const std::string& image, const std::string& places);

}  // namespace suite
