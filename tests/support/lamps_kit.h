// Lamps for tests.
#pragma once
#include "light/kinds/lamps.h"
#include "tests/support/radiometry_kit.h"

namespace suite::test {

inline LampSpec point_lamp(std::vector<Vec3> positions, double intensity) {
  LampSpec lamp;
  lamp.name = "point";
  lamp.positions = std::move(positions);
  lamp.intensity = Curve::constant(intensity);
  return lamp;
}
inline LampSpec glow(const std::string& material, double radiance, bool both_sides = false) {
  LampSpec lamp;
  lamp.kind = LampSpec::Kind::surface;
  lamp.name = "glow";
  lamp.material = material;
  lamp.radiance = Curve::constant(radiance);
  lamp.both_sides = both_sides;
  return lamp;
}

}  // namespace suite::test
