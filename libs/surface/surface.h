// Where a ray met the scene: geometry, maps and baked optics brought together. The only place where maps are evaluated.
#pragma once
#include <memory>
#include <vector>

#include "surface/optics.h"
#include "trace/tracer.h"

namespace suite {

struct Interaction {
  Vec3 position;                      // ENU
  Frame frame;                        // shading frame; z points to the front side of the surface
  Dir geometric_normal;               // front side
  uint32_t material = kNone;
  const BakedMaterial* baked = nullptr;
};

class Surface {
 public:
  // Keeps references; both must outlive it.
  Surface(const Tracer& tracer, const Optics& optics);

  // `out` points back along the ray. Vertex normals are bent where needed so that `out` stays on the geometric side
  // it came from.
  void interact(const Hit& hit, Dir out, Interaction& at) const;
  // The material at a hit, after overrides and maps; kNone when the geometry has none.
  uint32_t material(const Hit& hit) const;
  Vec2 uv(const Hit& hit) const;      // (u, v) barycentrics where the mesh has no UVs
  const Tracer& tracer() const { return tracer_; }

 private:
  uint32_t mapped(uint32_t material, const Hit& hit) const;
  const Tracer& tracer_;
  const Optics& optics_;
  std::vector<uint32_t> map_of_material_;   // class map index or kNone
  bool any_maps_ = false;
};

// The class at a place on a drape, or kNone outside a map that does not extend.
uint32_t class_at(const ClassMap& map, double x, double y);

}  // namespace suite
