// Where a sensor looks, as a few cones that hold its rays: what lies outside of all is not in its view.
//
// Method: pixels in tiles of some side; the cone of a tile is around the rays of a raster of its pixels, their corners
// included, at some times of the capture, and wider by what neighbours of the raster differ.
// Assumes: rays change smoothly from pixel to pixel and in time.
#pragma once
#include <vector>

#include "sensor/sensor.h"

namespace suite {

struct ViewCone {
  Vec3 apex;                                       // m, ENU
  double reach = 0;                                // m: rays begin no further from the apex
  Dir axis;                                        // unit
  double angle = 0;                                // rad, half of the opening; pi = everywhere
  bool touches(Vec3 centre, double radius) const;  // a ball; none that rays could meet is missed
};

// Of all captures; at most about `most` a capture.
std::vector<ViewCone> view_cones(const Sensor& sensor, size_t most = 1024);

}  // namespace suite
