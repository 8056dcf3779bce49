// The headers of images: what is told of the numbers beside them.
#pragma once
#include <span>
#include <string>
#include <vector>

#include "formats/envi/envi.h"
#include "formats/raster/raster_style.h"
#include "formats/raster/raster_write.h"
#include "formats/sim_text/sim_text.h"

namespace suite {

// Which bands show a picture: red, green and blue, or one. true_colour: they are what the eye calls so.
struct Display {
  std::vector<size_t> bands;
  bool true_colour = false;
};
// Named bands, three or one; or red, green and blue, the bands nearest to 0.65, 0.55 and 0.45 um within 0.07 um; with a
// near infrared in place of a blue, infrared, red and green; else one: that nearest to 10 um of thermal sensors (all
// bands beyond kThermalFrom) and where kelvins are asked for, and otherwise the one in the middle of the list. Error: a
// name that no band has.
Display display_of(std::span<const Band> bands, const PreviewSpec& spec);
inline constexpr double kThermalFrom = 3;  // um: sunlight and the glow of the ground at its usual warmth cross near 4

// What headers say about the scene.
struct SceneNotes {
  std::vector<std::string> materials, tags;
  GeodeticOrigin origin;
  std::string engine;  // the ray tracer
};

// A header without what only some images have: bands, wavelengths, units, extra keys.
EnviHeader bare(EnviHeader header);

// Puts the place of a map into a header.
void add_map(const MapGrid& map, const GeodeticOrigin& origin, EnviHeader& header);

// The projection that a map is told to be in is one of the ellipsoid's surface, and scene ENU lies at the height of its
// origin: how far off the farthest corner is where that is more than half a pixel. Empty: it is not.
std::string map_offset(const MapGrid& map, uint32_t columns, uint32_t rows, const GeodeticOrigin& origin);

// The header of the flags beside an image: one byte a pixel, the sum of the bits that the header names.
EnviHeader quality_header(EnviHeader header, const std::string& about);
// How flags are shown: a colour a bit, mixed where several hold, and nothing where none does.
RasterStyle quality_style();
EnviHeader truth_header(EnviHeader header, const std::vector<std::string>& names, const SceneNotes& notes,
                        const std::string& about);
// Its key for where scene ENU is: latitude, longitude (degrees, WGS84) and ellipsoidal height (m) of the zero.
inline constexpr const char* kSceneOrigin = "scene origin";
// What a classification shows: a row of the truth whose numbers have names.
struct ClassSource {
  std::string truth, none;  // "tag", "untagged": what 0 is called
  const std::vector<std::string>& names;
};
// A classification: 0 = none, 1 + i = the i-th name.
EnviHeader class_header(EnviHeader header, const ClassSource& source, const std::string& about);

}  // namespace suite
