// How bright a glowing surface is from place to place: a raster on the map, as a satellite's picture of a town's
// lights.
#pragma once
#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "math/vec.h"
#include "motion/map_system.h"

namespace suite {

struct LampMap {
  std::string file;  // for messages
  uint32_t width = 0, height = 0;
  std::vector<float> values;  // times the lamp's light, >= 0; row-major, first row first
  // x = m[0] + m[1] column + m[2] row, y = m[3] + m[4] column + m[5] row: of outer corners of pixels, in the system's
  // units (longitude before latitude).
  std::array<double, 6> to_map{};
  std::optional<MapSystem> system;  // none: scene ENU, m
};

// A map over a scene. The value of the pixel above or under a place; 0 outside.
class PlacedLampMap {
 public:
  // frame: of the scene, needed by maps of a system. Error: the pixels have no extent.
  PlacedLampMap(std::shared_ptr<const LampMap> map, const std::optional<SceneFrame>& frame);

  double at(Vec3 enu) const;
  // Mean over the pixels that a box touches, seen from above: positive wherever something in it glows.
  double mean_over(const Box3& box) const;

 private:
  std::optional<Vec2> pixel(Vec3 enu) const;  // column and row; nothing where the system knows no such place

  std::shared_ptr<const LampMap> map_;
  std::optional<SceneFrame> frame_;
  std::array<double, 4> inverse_{};
};

}  // namespace suite
