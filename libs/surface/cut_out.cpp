#include "surface/cut_out.h"

#include <algorithm>
#include <bit>

#include "math/sampling.h"
#include "surface/material_lookup.h"
#include "surface/tangents.h"

namespace suite {

namespace {

uint64_t bits(double x) { return std::bit_cast<uint64_t>(x); }

class CutOut final : public HitFilter {
 public:
  explicit CutOut(const Scene& scene) : scene_(scene), lookup_(scene), map_of_(scene.materials.size(), nullptr) {
    for (const PropertyBinding& b : scene.property_bindings)
      if (const PropertyMap& map = scene.property_maps[b.property_map]; map.kind == MapKind::opacity)
        map_of_[b.material] = &map, any_ = true;
    leads_to_ = std::vector<bool>(scene.materials.size(), false);
    for (size_t m = 0; m < map_of_.size(); ++m) leads_to_[m] = map_of_[m] != nullptr;
    for (const MapBinding& b : scene.map_bindings)
      for (const uint32_t id : scene.class_maps[b.class_map].materials)
        leads_to_[b.material] = leads_to_[b.material] || map_of_[id];
  }
  bool any() const { return any_; }

  bool concerns(const TracedObject& object) const override {
    const auto leads = [&](uint32_t material) { return material != kNone && leads_to_[material]; };
    if (object.material_override != kNone) return leads(object.material_override);
    if (object.primitive != kNone) return leads(scene_.primitives[object.primitive].material);
    const std::vector<Part>& parts = scene_.meshes[object.mesh].parts;
    return std::any_of(parts.begin(), parts.end(), [&](const Part& p) { return leads(p.material); });
  }

  bool keeps(const Ray& ray, const TracedObject& object, const Hit& hit) const override {
    const uint32_t material = lookup_.at(object, hit);
    const PropertyMap* map = material == kNone ? nullptr : map_of_[material];
    if (!map) return true;
    MapPlace place{hit.position, {}};
    if (map->projection == Projection::uv) place.uv = uv_at(scene_, object, hit.triangle, hit.u, hit.v);
    const float opacity = value_at(*map, place).value_or(1);
    if (opacity <= 0 || opacity >= 1) return opacity >= 1;
    uint64_t key = hash_of(bits(ray.origin.x), bits(ray.origin.y), bits(ray.origin.z), bits(ray.time));
    key = hash_of(key, bits(ray.direction.x), bits(ray.direction.y), bits(ray.direction.z));
    const uint64_t inwards = dot(ray.direction, hit.normal) < 0;
    key = hash_of(key, ray.draw, object.instance, (uint64_t{hit.triangle} << 1) | inwards);
    return unit_double(key) < opacity;
  }

 private:
  const Scene& scene_;
  MaterialLookup lookup_;
  std::vector<const PropertyMap*> map_of_;  // per material, null = whole
  std::vector<bool> leads_to_;              // per material: its own or, through a class map, another one's
  bool any_ = false;
};

}  // namespace

std::shared_ptr<const HitFilter> cut_out(const Scene& scene) {
  auto made = std::make_shared<const CutOut>(scene);
  return made->any() ? made : nullptr;
}

}  // namespace suite
