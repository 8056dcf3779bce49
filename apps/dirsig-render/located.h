// The pixels of an image whose places are wanted, while its rows come in, and the files that come of them: IGM, GLT and
// VRT (geolocation.h), and of GeoTIFF what map_rasters.h writes.
#pragma once
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "geolocation.h"
#include "map_rasters.h"
#include "sight_lines.h"

namespace suite {

class LocatedPixels {
 public:
  // geotiff: rasters are wanted, too.
  LocatedPixels(uint32_t columns, uint32_t rows, const ImageWishes& wishes, bool geotiff);
  // Rows of a picture whose truth has `location`; first_row: of the picture.
  void append(const Delivery& delivery, uint32_t first_row);

  // Once all rows are there. Writes IGM, GLT and VRT; warns where there is no map. Returns the names of the files.
  std::vector<std::string> write_tables(const LocatedImage& image, const GeodeticOrigin& origin);
  // Then: RPCs or ground control points for rasters of raw pixels that have no place. file: for what is reported.
  void add_control(const std::string& file, FloatRaster& raster) const;
  // Standard errors and truth (of BASE_error.img and BASE_truth.img) as raw rasters, and all of them and the flags on
  // the map. told: the raster of the values. Returns the names of the files.
  std::vector<std::string> write_rasters(const std::string& base, const FloatRaster& described,
                                         std::span<const float> values, std::span<const float> quality) const;
  bool mapped() const { return mapped_; }

 private:
  uint32_t columns_;
  ImageWishes wishes_;
  std::vector<Vec3> enu_;            // [pixel]
  std::optional<SightLines> sight_;  // of GeoTIFF
  std::optional<GroundPlaces> places_;
  std::optional<GroundMap> map_;
  bool mapped_ = false;
};

}  // namespace suite
