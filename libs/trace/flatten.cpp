#include "trace/flatten.h"

namespace suite {

namespace {

struct Walk {
  const Scene& scene;
  size_t limit;
  std::vector<TracedObject>& out;

  void group(uint32_t index, const Affine3& to_world, uint32_t material, uint32_t tag) {
    for (const Placement& p : scene.groups[index].placements) {
      const Affine3 map = to_world * p.to_parent;
      // The outermost override wins: whoever places a thing decides what it is made of.
      const uint32_t override_id = material != kNone ? material : p.material_override;
      const uint32_t tag_id = p.tag != kNone ? p.tag : tag;
      if (p.kind == TargetKind::group) group(p.target, map, override_id, tag_id);
      if (p.kind == TargetKind::group) continue;
      if (out.size() >= limit) throw Error(strf("the scene unfolds into more than %zu instances", limit), "place fewer copies");
      const bool mesh = p.kind == TargetKind::mesh;
      out.push_back({map, mesh ? p.target : kNone, mesh ? kNone : p.target, override_id, tag_id, map.determinant() < 0, static_cast<uint32_t>(out.size())});
    }
  }
};

}  // namespace

std::vector<TracedObject> flatten(const Scene& scene, size_t limit) {
  std::vector<TracedObject> objects;
  Walk{scene, limit, objects}.group(0, Affine3{}, kNone, kNone);
  return objects;
}

Box3 local_bounds(const Mesh& mesh) {
  Box3 box;
  for (size_t i = 0; i < mesh.vertex_count(); ++i)
    box.grow(mesh.origin + Vec3{mesh.positions[3 * i], mesh.positions[3 * i + 1], mesh.positions[3 * i + 2]});
  return box;
}

Box3 transformed(const Box3& box, const Affine3& map) {
  Box3 out;
  if (box.empty()) return out;
  for (int c = 0; c < 8; ++c)
    out.grow(map.point({c & 1 ? box.high.x : box.low.x, c & 2 ? box.high.y : box.low.y, c & 4 ? box.high.z : box.low.z}));
  return out;
}

}  // namespace suite
