#include "transport/contacts.h"

#include "transport/lost_light.h"

namespace suite {

Contacts::Contacts(const Surface& surface, const Optics& optics) : surface_(surface) {
  const Scene& scene = surface.tracer().scene();
  for (uint32_t i = 0; i < scene.materials.size(); ++i) {
    const BakedMaterial& material = optics.material(i);
    const bool boundary = scene.materials[i].is_boundary();
    const bool face = !boundary && (scene.materials[i].bounds_medium() || LostLight::refracts(material)) &&
                      material.model && !material.model->opaque();
    const bool opaque = !boundary && (!material.model || material.model->opaque());
    kind_.push_back(face ? Kind::face : opaque ? Kind::opaque : Kind::other);
    any_ = any_ || face;
  }
  any_ = any_ && surface.tracer().tells_all() && (surface.tracer().object_count() > 1 || surface.tracer().periodic());
}

void Contacts::look(const Ray& ray, Hit& hit, TraceStatistics& statistics) {
  if (kind(hit) != Kind::face) return;
  const Dir n = dot(ray.direction, hit.normal) < 0 ? -hit.normal : hit.normal;
  const double step = double{hit.step}, back = 0.5 * step;
  surface_.tracer().all({hit.position - n * back, n, ray.time, ray.draw}, back + step, beside_, statistics);
  for (const Hit& h : beside_) {
    if (kind(h) != Kind::opaque) continue;
    const double distance = hit.distance;
    hit = h;
    hit.distance = distance;
    return;
  }
}

}  // namespace suite
