// LAS point clouds, versions 1.0 to 1.4, point formats 0 to 10. See FORMAT.md.
#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "base/report.h"
#include "math/vec.h"

namespace suite {

struct PointCloud {
  std::string system;         // "EPSG:25832" where the file's GeoTIFF keys or WKT name one, else empty
  std::vector<Vec3> places;   // in coordinates of the map
  std::vector<uint8_t> kind;  // classification: 2 ground, 3 to 5 low to high vegetation, 6 building, ...
};

// All points but those marked as withheld, which are told (SP706). Error, with its byte: no LAS, compressed (LAZ), cut
// short, of an unknown version or format, places that are not finite.
PointCloud read_las(const std::string& path, Report& report);
PointCloud parse_las(std::span<const std::byte> bytes, const std::string& file, Report& report);

}  // namespace suite
