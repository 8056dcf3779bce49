#include "surface/material_lookup.h"

#include <algorithm>

#include "surface/tangents.h"

namespace suite {

MaterialLookup::MaterialLookup(const Scene& scene) : scene_(scene), map_of_(scene.materials.size(), kNone) {
  for (const MapBinding& b : scene.map_bindings) map_of_[b.material] = b.class_map, any_ = true;
}

uint32_t MaterialLookup::plain(const TracedObject& object, uint32_t triangle) const {
  if (object.material_override != kNone) return object.material_override;
  if (object.primitive != kNone) return scene_.primitives[object.primitive].material;
  const std::vector<Part>& parts = scene_.meshes[object.mesh].parts;
  if (parts.size() == 1) return parts.front().material;
  const auto after = std::upper_bound(parts.begin(), parts.end(), triangle,
                                      [](uint32_t t, const Part& p) { return t < p.first_triangle; });
  return after == parts.begin() ? kNone : (after - 1)->material;
}

uint32_t MaterialLookup::by_map(uint32_t material, const TracedObject& object, const Hit& hit) const {
  const ClassMap& map = scene_.class_maps[map_of_[material]];
  MapPlace place{hit.position, {}};
  if (map.projection == Projection::uv) place.uv = uv_at(scene_, object, hit.triangle, hit.u, hit.v);
  const uint32_t c = class_at(map, place);
  return c == kNone ? material : map.materials[c];
}

std::vector<bool> used_materials(const Tracer& tracer) {
  const Scene& scene = tracer.scene();
  std::vector<bool> used(scene.materials.size(), false), mesh_seen(scene.meshes.size(), false);
  tracer.kinds([&](const TracedObject& o) {
    if (o.material_override != kNone)
      used[o.material_override] = true;
    else if (o.mesh != kNone)
      mesh_seen[o.mesh] = true;
    else if (const uint32_t id = scene.primitives[o.primitive].material; id != kNone)
      used[id] = true;
  });
  for (size_t m = 0; m < scene.meshes.size(); ++m)
    for (const Part& p : scene.meshes[m].parts)
      if (mesh_seen[m] && p.material != kNone) used[p.material] = true;
  for (const MapBinding& b : scene.map_bindings)
    if (used[b.material])
      for (const uint32_t id : scene.class_maps[b.class_map].materials) used[id] = true;
  for (const PropertyBinding& b : scene.property_bindings)
    if (used[b.material])
      for (const uint32_t id : scene.property_maps[b.property_map].materials) used[id] = true;
  return used;
}

}  // namespace suite
