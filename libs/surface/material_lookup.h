// Which material a point of the scene has: overrides, parts, and class maps.
#pragma once
#include <vector>

#include "surface/map_lookup.h"
#include "trace/tracer.h"

namespace suite {

class MaterialLookup {
 public:
  // Keeps a reference to the scene.
  explicit MaterialLookup(const Scene& scene);
  // Material before maps; kNone when the geometry has none.
  uint32_t plain(const TracedObject& object, uint32_t triangle) const;
  // Whether a class map may put others there.
  bool is_mapped(uint32_t material) const { return any_ && material != kNone && map_of_[material] != kNone; }
  // The material that a class map puts there; the given one outside of maps. Texture coordinates are only looked at by
  // maps that are placed by them.
  uint32_t mapped(uint32_t material, const TracedObject& object, const Hit& hit) const {
    return is_mapped(material) ? by_map(material, object, hit) : material;
  }
  uint32_t at(const TracedObject& object, const Hit& hit) const {
    return mapped(plain(object, hit.triangle), object, hit);
  }

 private:
  uint32_t by_map(uint32_t material, const TracedObject& object, const Hit& hit) const;
  const Scene& scene_;
  std::vector<uint32_t> map_of_;  // per material: class map or kNone
  bool any_ = false;
};

// Materials that some geometry of a tracer can show, through overrides, class maps and mixtures; the others need no
// optics.
std::vector<bool> used_materials(const Tracer& tracer);

}  // namespace suite
