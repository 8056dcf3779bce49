// Rasters: values through OpenImageIO, georeferencing through libgeotiff. See FORMAT.md.
#pragma once
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/error.h"

namespace suite {

// What a stored number of a band stands for: stored * scale + offset.
struct RasterNumbers {
  double scale = 1, offset = 0;
  bool operator==(const RasterNumbers&) const = default;
};

struct Raster {
  uint32_t width = 0, height = 0, channels = 0;
  bool integer = false;                // the file holds whole numbers
  std::vector<float> values;           // row-major, first row first, channels together; as stored, not normalised
  std::vector<RasterNumbers> numbers;  // one a channel, as the file says; empty = the stored numbers are the values
  std::optional<double> no_data;       // the stored number that marks a missing value, as the file says
  double scale_z = 0;                  // the third number of a GeoTIFF's pixel scale; 0 and 1 say nothing
};

// Error: unreadable, more than max_pixels, or more bytes declared than a file of its size can hold.
Raster read_raster(const std::string& path, size_t max_pixels = size_t{1} << 28);

// A PNG or JPEG that lies in memory, in display values of 0 to 1 whatever its bits; `name` is for messages, `numbers`
// and the rest stay empty. Error: neither, damaged, more than max_pixels.
Raster read_picture(std::span<const std::byte> bytes, const std::string& name, size_t max_pixels);

// Whether a stored number is the mark of a missing value; both as the 32-bit floats that rasters are read as.
bool is_no_data(const Raster& raster, float stored);
// The values that the stored numbers stand for; NaN where one is missing. numbers: whether scale and offset count.
enum class Numbers { stored, scaled };
std::vector<float> values_of(Raster&& raster, Numbers numbers);

// Where the pixels of a GeoTIFF are. x, y are easting and northing in metres, or longitude and latitude in degrees.
struct GeoReference {
  int epsg = 0;  // projected CRS code, or geographic one when `geographic`
  bool geographic = false;
  double to_map[6];       // x = m[0] + m[1] column + m[2] row, y = m[3] + m[4] column + m[5] row
                          // of pixel corners: (0, 0) = outer corner of the first pixel
  int vertical_epsg = 0;  // of what the pixels count from where they are heights above the sea; 0: nothing is said
  std::optional<double> no_data;
  double height_unit_m = 1;  // of the pixels where they are heights, as the vertical keys say; 1 when they say nothing
};

// Error when the file is no GeoTIFF, has no or a user-defined CRS, or is neither scaled nor tied to the ground.
GeoReference read_georeference(const std::string& path);

}  // namespace suite
