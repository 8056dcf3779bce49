// Rasters of floating-point numbers out: TIFF with GeoTIFF keys, and OpenEXR. See FORMAT.md.
#pragma once
#include <array>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace suite {

// A north-up picture on the plane tangent to WGS84 at a place (east and north in metres), or on a plane that is
// nowhere.
struct RasterPlacement {
  double west = 0, north = 0;                       // m, outer corner of the first pixel
  double gsd_x = 0, gsd_y = 0;                      // m, > 0; rows go south
  std::optional<std::array<double, 2>> origin_deg;  // latitude, longitude of the tangent point
};

// values: row-major, first row first, channels together; stored as 32-bit floats, whole or not at all. comment: goes
// into the file's description. Error: not writable, sizes that do not fit.
void write_float_tiff(const std::string& path, uint32_t width, uint32_t height,
                      const std::vector<std::string>& channels, std::span<const float> values,
                      const std::string& comment, const std::optional<RasterPlacement>& placement);
void write_exr(const std::string& path, uint32_t width, uint32_t height, const std::vector<std::string>& channels,
               std::span<const float> values, const std::string& comment);

}  // namespace suite
