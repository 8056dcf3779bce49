// A look at a scene without light: what lies under a point or along a ray, and a picture from above.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "trace/tracer.h"

namespace suite {

// Material of a hit after overrides and class maps; kNone when the geometry has none.
uint32_t material_of(const Tracer& tracer, const Hit& hit);

// What a ray meets, in lines: object, part, material, tag, distance, place, normal; or "nothing".
std::string describe_hit(const Tracer& tracer, const Ray& ray);

// RGB rows from the north edge down: one colour a material, shaded as by a sun in the north-west at 45 degrees; white
// where there is nothing. The longer side of the scene's extent gets `pixels` pixels. Error for a scene without extent.
struct View {
  int width = 0, height = 0;
  std::vector<uint8_t> rgb;
};
View view_from_above(const Tracer& tracer, int pixels);

}  // namespace suite
