#include "heat/made_of.h"

#include <algorithm>

namespace suite {

std::vector<bool> with_class_maps(const Scene& scene, const std::vector<bool>& materials) {
  std::vector<bool> out = materials;
  for (const MapBinding& b : scene.map_bindings)
    for (const uint32_t m : scene.class_maps[b.class_map].materials)
      if (m != kNone && materials[m]) out[b.material] = true;
  return out;
}

std::function<bool(const TracedObject&)> made_of(const Scene& scene, std::vector<bool> materials) {
  return [&scene, wanted = std::move(materials)](const TracedObject& o) {
    const auto is_wanted = [&](uint32_t m) { return m != kNone && wanted[m]; };
    if (o.material_override != kNone) return is_wanted(o.material_override);
    if (o.primitive != kNone) return is_wanted(scene.primitives[o.primitive].material);
    return std::ranges::any_of(scene.meshes[o.mesh].parts, [&](const Part& p) { return is_wanted(p.material); });
  };
}

bool stays_put(const Tracer& tracer, uint32_t object) {
  const std::optional<TimeSpan> window = tracer.window();
  if (!window) return true;
  constexpr int kTimes = 16;
  const Affine3 first = tracer.to_world(object, window->begin);
  for (int k = 1; k <= kTimes; ++k)
    if (tracer.to_world(object, window->begin + (window->end - window->begin) * k / kTimes) != first) return false;
  return true;
}

}  // namespace suite
