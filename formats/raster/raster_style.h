// How a viewer shows a raster without being asked: a style of QGIS beside the file. See FORMAT.md.
#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace suite {

struct StyleColour {
  double value = 0;  // of a pixel, in the raster's unit
  std::string label;
  std::array<uint8_t, 3> rgb{};
  bool seen = true;  // else transparent
};

struct RasterStyle {
  std::vector<size_t> display;       // from 0: bands shown as red, green and blue, or one
  std::array<double, 2> ends{0, 1};  // black and white, of all of them; the first below the second
  double gamma = 1;                  // shown is (share of the way between the ends)^(1 / gamma)
  std::vector<StyleColour> ramp;     // of one band: colours at ascending values, linear between; empty = grey
  std::vector<StyleColour> classes;  // of one band of whole numbers, in place of ends and ramp
};

// Writes `path` (.qml), whole or not at all. QGIS takes x.qml for x.tif and for x.img of the same folder.
// Error: not writable; bands to show are neither one nor three.
void write_qgis_style(const std::string& path, const RasterStyle& style);

}  // namespace suite
