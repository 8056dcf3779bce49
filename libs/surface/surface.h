// Where a ray met the scene: geometry, maps and baked optics brought together. The only place where maps are evaluated.
#pragma once
#include <memory>
#include <vector>

#include "surface/material_lookup.h"
#include "surface/optics.h"
#include "trace/tracer.h"

namespace suite {

struct Interaction {
  Vec3 position;         // ENU
  Frame frame;           // shading frame; z points to the front side of the surface, x along u (CONVENTIONS.md)
  Dir geometric_normal;  // front side
  uint32_t material = kNone;
  const BakedMaterial* baked = nullptr;

  // Where maps make the material of this point; kept from hit to hit.
  struct Own {
    BakedMaterial made;
    LocalMaterial memory;
    HeatedPlace place;                        // for `field`
    const TemperatureField* field = nullptr;  // of the temperature, if one has it
  };
  std::unique_ptr<Own> own;
};

class Surface {
 public:
  // Keeps references; both must outlive it.
  Surface(const Tracer& tracer, const Optics& optics);

  // `out` points back along the ray; time: s, of the ray. Normals of vertices and of maps are bent where needed so that
  // `out` stays on the geometric side it came from.
  void interact(const Hit& hit, Dir out, Interaction& at, double time = 0) const;
  // The material at a hit, after overrides and class maps; kNone when the geometry has none.
  uint32_t material(const Hit& hit) const { return material(tracer_.object(hit.object), hit); }
  uint32_t material(const TracedObject& object, const Hit& hit) const { return lookup_.at(object, hit); }
  Vec2 uv(const Hit& hit) const;  // (u, v) barycentrics where the mesh has no UVs
  const Tracer& tracer() const { return tracer_; }
  const Optics& optics() const { return optics_; }

 private:
  const Tracer& tracer_;
  const Optics& optics_;
  MaterialLookup lookup_;
};

}  // namespace suite
