// Where the pixels of an image are: in the scene, on the Earth, and on a north-up map.
#pragma once
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "headers.h"
#include "motion/scene_frame.h"
#include "sensor/ground_grid.h"

namespace suite {

// Places in the words of the scene: on the Earth, or on a plane. Refers to the places it is made of.
class GroundPlaces {
 public:
  // enu: m, row-major, one a pixel; NaN = nothing was hit.
  GroundPlaces(const std::vector<Vec3>& enu, uint32_t columns, const GeodeticOrigin& origin);
  bool on_earth() const { return frame_.has_value(); }
  const SceneFrame& frame() const { return *frame_; }  // on_earth() only
  size_t size() const { return enu_.size(); }
  uint32_t columns() const { return columns_; }
  bool known(size_t i) const { return std::isfinite(enu_[i].x); }
  const Vec3& enu(size_t i) const { return enu_[i]; }
  Geodetic geodetic(size_t i) const { return frame_->geodetic_from_enu(enu_[i]); }
  double height_m(size_t i) const { return on_earth() ? geodetic(i).height_m : enu_[i].z; }
  // Longitude, latitude and height, or east, north and up; NaN when unknown.
  std::array<double, 3> triple(size_t i) const;

 private:
  const std::vector<Vec3>& enu_;
  uint32_t columns_;
  std::optional<SceneFrame> frame_;
};

// The pixels on a map.
struct GroundMap {
  std::vector<Vec2> places;          // m, or degrees of a geographic system; NaN = unknown
  std::string name;                  // of the projection, in ENVI's words
  std::vector<std::string> remarks;  // what follows the size of a pixel there
  int epsg = 0;                      // 0: scene ENU
  bool geographic = false;
  double unit_m = 1;  // what a unit of the map stands for, about
  GroundGrid grid;
};

// epsg, pixel: of ImageWishes. Error: why there is no map.
GroundMap ground_map(const GroundPlaces& places, int epsg, double pixel);

}  // namespace suite
