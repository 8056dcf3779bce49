#include "scene/bounded_side.h"

#include <algorithm>
#include <cmath>

namespace suite {

BoundedSide bounded_side(const Primitive& p) {
  switch (p.kind) {
    case PrimitiveKind::box:  // a layer, too: below and above it is one side
    case PrimitiveKind::sphere:
      return BoundedSide::behind;
    case PrimitiveKind::cone:
    case PrimitiveKind::cylinder:
      return p.parameters.back() > 0.5 ? BoundedSide::behind : BoundedSide::none;
    case PrimitiveKind::plane:
    case PrimitiveKind::disk:
    case PrimitiveKind::sinusoid:
      break;
  }
  return BoundedSide::none;
}

BoundedSide bounded_side(const Mesh& mesh) {
  constexpr double kRounding = 1e-5;  // of float places, relative
  const auto place = [&](size_t corner) {
    const float* const at = &mesh.positions[3 * size_t{mesh.indices[corner]}];
    return Vec3{double{at[0]}, double{at[1]}, double{at[2]}};
  };
  if (mesh.triangle_count() == 0) return BoundedSide::none;
  const Vec3 from = place(0);
  Vec3 normal, moment[3];
  double area = 0, size = 0;
  for (size_t t = 0; t < mesh.triangle_count(); ++t) {
    const Vec3 a = place(3 * t) - from, b = place(3 * t + 1) - from, c = place(3 * t + 2) - from,
               n = cross(b - a, c - a) * 0.5, middle = (a + b + c) * (1.0 / 3);
    normal += n;
    moment[0] += n * middle.x, moment[1] += n * middle.y, moment[2] += n * middle.z;
    area += length(n);
    size = std::max({size, length(a), length(b), length(c)});
  }
  if (!(length(normal) <= kRounding * area)) return BoundedSide::none;
  const double volume = (moment[0].x + moment[1].y + moment[2].z) / 3;
  moment[0].x -= volume, moment[1].y -= volume, moment[2].z -= volume;
  const double off = length(moment[0]) + length(moment[1]) + length(moment[2]);
  if (!(off <= kRounding * area * size) || !(std::fabs(volume) > kRounding * area * size)) return BoundedSide::none;
  return volume > 0 ? BoundedSide::behind : BoundedSide::front;
}

}  // namespace suite
