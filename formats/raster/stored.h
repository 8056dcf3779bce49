// What a file says of its numbers, and portable grey and pixel maps. Internal to formats/raster.
#pragma once
#include <optional>
#include <string>

#include "formats/raster/raster.h"

namespace suite {

// Scale, offset and mark of missing values of a TIFF (GDAL_METADATA, GDAL_NODATA); nothing for other files.
// Error: a scale or offset that is no finite number, a scale of 0.
void read_tiff_numbers(const std::string& path, Raster& raster);

// A PGM or PPM, plain or binary (P2, P3, P5, P6); nothing for other files. Error: damaged, more than max_pixels.
std::optional<Raster> read_portable_map(const std::string& path, size_t max_pixels);

}  // namespace suite
