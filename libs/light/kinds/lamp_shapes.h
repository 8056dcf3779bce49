// Pieces of glowing surfaces that can be drawn from: flat ones and spheres. Internal to lamps.
#pragma once
#include <optional>

#include "light/light_tree.h"
#include "scene/scene.h"

namespace suite {

struct LampShape {
  enum class Kind : uint8_t { point, triangle, parallelogram, disk, sphere } kind = Kind::point;
  bool both_sides = false;
  uint32_t spec = 0;         // whose lamp it is
  float step = 0, span = 0;  // of the surface's hits, for Tracer::arrive
  uint32_t carrier = kNone;  // of a point that rides: origin is in its axes
  Vec3 origin, a, b;         // corner and edges; centre and half axes of a disk; centre and (radius, 0, 0)
  double area = 0;           // m2
  Dir normal;                // flat ones, front side
};

// The shape of an exact surface placed by `place`; nothing for kinds that are met by chance only.
std::optional<LampShape> shape_of(const Primitive& primitive, const Affine3& place);
// Nothing for a triangle without area.
std::optional<LampShape> shape_of(const Mesh& mesh, uint32_t triangle, const Affine3& place);

// Bounds for a radiance of 1.
LightBounds bounds_of(const LampShape& surface);

// A point of a surface, all places alike.
Vec3 place_on(const LampShape& surface, Vec2 u);
// A point of the shape drawn from a place; density in 1/sr as seen from there, nothing when it cannot be seen.
struct ShapePoint {
  Vec3 position;
  Dir normal;     // front side
  double cosine;  // of the angle under which it is left, negative on the back
  double distance;
  Dir direction;  // from the place
  double density;
};
std::optional<ShapePoint> draw(const LampShape& surface, Vec3 from, Vec2 u);
// The density with which draw() proposes a point at this distance, left under this cosine.
double density_of(const LampShape& surface, Vec3 from, double distance, double cosine);

}  // namespace suite
