// GeoTIFF of located images: RPCs or ground control points in the raw picture, and north-up maps of what stands in the
// image files.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "formats/raster/raster_write.h"
#include "ground_places.h"
#include "sight_lines.h"

namespace suite {

// Gives a raster of raw pixels what is known of their places: RPCs where they fit within kWorstRpc pixels (rms), else
// ground control points. Reports the residual.
inline constexpr double kWorstRpc = 0.5;
void add_ground_control(const std::string& file, const GroundPlaces& places, const std::vector<SightLine>& lines,
                        FloatRaster& raster);

// One of the images that are put on a map.
struct MappedImage {
  enum class Kind { means, errors, bits, truth } kind = Kind::means;
  std::string file;               // to write
  FloatRaster raster;             // bands and what is told; size and place are those of the map
  std::vector<double> values;     // [pixel][band]
  std::optional<double> ignored;  // of the values: the one that means nothing, beside NaN
};

// Puts the image on the map, as the wishes say: each cell by the areas of the pixels in it (errors as those of
// independent pixels, numbers that are names the most frequent one, bits together), or by the pixel nearest to its
// middle.
class MapRasters {
 public:
  MapRasters(const GroundPlaces& places, const GroundMap& map, ImageWishes::Resampling how);
  ~MapRasters();
  void write(MappedImage image) const;

 private:
  struct Cells;
  const GroundMap& map_;
  std::unique_ptr<Cells> cells_;
};

}  // namespace suite
