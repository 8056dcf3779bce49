// Rasters: values through OpenImageIO, georeferencing through libgeotiff. See FORMAT.md.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "base/error.h"

namespace suite {

struct Raster {
  uint32_t width = 0, height = 0, channels = 0;
  bool integer = false;       // the file holds whole numbers
  std::vector<float> values;  // row-major, first row first, channels together; as stored, not normalised
};

// Error: unreadable, more than max_pixels, or more bytes declared than a file of its size can hold.
Raster read_raster(const std::string& path, size_t max_pixels = size_t{1} << 28);

// Where the pixels of a GeoTIFF are. x, y are easting and northing in metres, or longitude and latitude in degrees.
struct GeoReference {
  int epsg = 0;  // projected CRS code, or geographic one when `geographic`
  bool geographic = false;
  double to_map[6];  // x = m[0] + m[1] column + m[2] row, y = m[3] + m[4] column + m[5] row
                     // of pixel corners: (0, 0) = outer corner of the first pixel
  std::optional<double> no_data;
  double height_unit_m = 1;  // of the pixels where they are heights, as the vertical keys say; 1 when they say nothing
};

// Error when the file is no GeoTIFF, has no or a user-defined CRS, or is neither scaled nor tied to the ground.
GeoReference read_georeference(const std::string& path);

}  // namespace suite
