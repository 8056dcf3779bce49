#include "surface/surface.h"

#include "surface/shading_normal.h"

namespace suite {

Surface::Surface(const Tracer& tracer, const Optics& optics)
    : tracer_(tracer), optics_(optics), lookup_(tracer.scene()) {}

Vec2 Surface::uv(const Hit& hit) const {
  return uv_at(tracer_.scene(), tracer_.object(hit.object), hit.triangle, hit.u, hit.v);
}

void Surface::interact(const Hit& hit, Dir out, Interaction& at, double time) const {
  const TracedObject object = tracer_.object(hit.object);
  at.position = hit.position;
  at.geometric_normal = hit.normal;
  at.material = lookup_.at(object, hit);
  const BakedMaterial* material = at.material == kNone ? nullptr : &optics_.material(at.material);
  const MaterialMaps* maps = material ? material->maps.get() : nullptr;
  const std::optional<Dir> smooth = vertex_normal(tracer_.scene(), tracer_.to_world(hit), object, hit);
  Dir n = smooth.value_or(hit.normal);
  SurfaceTangents tangents;
  if (material && (material->needs_tangent || (maps && maps->bends())))
    tangents = tangents_at(tracer_.scene(), tracer_.to_world(hit), object, hit);
  MapPlace place{hit.position, {}};
  if (maps && maps->needs_uv) place.uv = uv(hit);
  if (maps && maps->normal) n = mapped_normal(n, *maps->normal, place, tangents);
  if (maps && maps->bump) n = bumped(n, *maps->bump, place, tangents);
  if (smooth || (maps && maps->bends())) n = kept_in_view(n, out, hit.normal);
  at.frame = material && material->needs_tangent ? Frame::with_tangent(n, tangents.dpdu) : Frame::around(n);
  at.baked = material;
  if (!maps || !maps->varies()) return;
  place.normal = hit.normal, place.instance = object.instance, place.triangle = hit.triangle;
  if (!at.own) at.own = std::make_unique<Interaction::Own>();
  // A map comes before the model.
  const bool mapped = maps->field && maps->temperature && value_at(*maps->temperature, place);
  at.own->field = mapped ? nullptr : maps->field.get();
  at.own->place = {hit.position, hit.normal, object.instance, hit.triangle, at.material};
  at.baked =
      material_here(*material, optics_.state(), place, time, at.frame.to_local(out), at.own->memory, at.own->made);
}

}  // namespace suite
