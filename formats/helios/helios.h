// Scenes of HELIOS++ as texts of ours. See FORMAT.md.
#pragma once
#include <array>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/report.h"
#include "scene/draft.h"

namespace suite {

struct HeliosText {
  std::string yaml;            // a scene text; file names in it are as they are written there
  std::vector<Where> origins;  // of each of its lines
};

// Where the pixels of a GeoTIFF are in its map.
struct HeliosGrid {
  std::array<double, 2> corner{};  // the outer corner of the first pixel, x y
  std::array<double, 2> pixel{};   // sizes; the first row has the largest y
  std::optional<double> no_data;
};

struct HeliosHeights : HeliosGrid {
  size_t width = 0, height = 0;
  std::vector<float> heights;  // row-major, first row first; NaN where there is none
};

// What must be looked up in the files that parts name.
struct HeliosFiles {
  std::function<HeliosGrid(const std::string& name)> grid_of;        // of a GeoTIFF
  std::function<std::string(const std::string& name)> text_of;       // of point clouds and materials
  std::function<HeliosHeights(const std::string& name)> heights_of;  // of a GeoTIFF
  std::function<SourceMesh(const std::string& name)> mesh_of;        // of Wavefront OBJ
};

// The first scene of a document. What is left out or approximated goes to `report` (SP705 to SP708) with its line.
// Error, located: no XML, no scene, numbers that are none, a part without a file; as `files`.
HeliosText parse_helios(std::string_view text, const std::string& file, const HeliosFiles& files, Report& report);

// By a file's name and its first bytes.
bool is_helios(const std::string& path, std::string_view head);

}  // namespace suite
