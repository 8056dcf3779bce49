// A look at a scene without light: what lies under a point or along a ray, and a picture from any side.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "trace/tracer.h"

namespace suite {

// Material of a hit after overrides and class maps; kNone when the geometry has none.
uint32_t material_of(const Tracer& tracer, const Hit& hit);

// What a ray meets, in lines: object, part, material, tag, distance, place, normal; or "nothing".
std::string describe_hit(const Tracer& tracer, const Ray& ray);

// Extent in ENU of what has a name or a tag, all its placements together, or of one instance by its number. Error: no
// such thing (with the nearest name), a moving one, one without end.
Box3 box_of(const Tracer& tracer, const std::string& what);

// Of the highest surface at (x, y), ENU, m; nothing when there is none.
std::optional<double> height_at(const Tracer& tracer, double x, double y, double time);

// From where and at what a quick look is taken, without perspective.
struct LookAt {
  Box3 box;                                      // its middle is the picture's, and its outline fills it
  double margin = 1;                             // ... enlarged by this
  double size_m = 0;                             // edge of a square picture instead; 0 = none
  double azimuth_deg = 180, elevation_deg = 90;  // compass direction and height in which the viewer is: from above,
                                                 // north up
  double time = 0;                               // s, within the tracer's window
};
// RGB rows from the top: one colour a material, shaded as by a sun in the north-west at 45 degrees; white where there
// is nothing. What stands before the box is seen, too. The longer side gets `pixels` pixels. Error for a box without
// extent.
struct View {
  int width = 0, height = 0;
  std::vector<uint8_t> rgb;
};
View view_of(const Tracer& tracer, const LookAt& look, int pixels);

}  // namespace suite
