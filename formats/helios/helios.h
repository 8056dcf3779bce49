// Scenes of HELIOS++ as texts of ours. See FORMAT.md.
#pragma once
#include <array>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "base/report.h"

namespace suite {

struct HeliosText {
  std::string yaml;            // a scene text; file names in it are as they are written there
  std::vector<Where> origins;  // of each of its lines
};

// What must be looked up in the files that parts name.
struct HeliosFiles {
  // The outer corner of a GeoTIFF's first pixel and its pixels' size {x, y, dx, dy} in its map.
  std::function<std::array<double, 4>(const std::string& name)> corner_of;
  std::function<std::string(const std::string& name)> text_of;  // the content of a point cloud of text
};

// The first scene of a document. What is left out or approximated goes to `report` (SP705 to SP708) with its line.
// Error, located: no XML, no scene, numbers that are none, a part without a file; as `files`.
HeliosText parse_helios(std::string_view text, const std::string& file, const HeliosFiles& files, Report& report);

// By a file's name and its first bytes.
bool is_helios(const std::string& path, std::string_view head);

}  // namespace suite
