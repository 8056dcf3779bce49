// Extents of a scene from the boxes of its parts, bottom up: children come after parents in the table of groups.
#include <algorithm>
#include <cmath>

#include "scene/primitives.h"

namespace suite {

namespace {

Box3 mesh_box(const Mesh& m) {
  Box3 box;
  for (size_t i = 0; i < m.vertex_count(); ++i)
    box.grow(m.origin + Vec3{m.positions[3 * i], m.positions[3 * i + 1], m.positions[3 * i + 2]});
  return box;
}

Box3 moved(const Box3& box, const Affine3& to_parent) {
  Box3 out;
  if (box.empty()) return out;
  for (int c = 0; c < 8; ++c)
    out.grow(to_parent.point(
        {c & 1 ? box.high.x : box.low.x, c & 2 ? box.high.y : box.low.y, c & 4 ? box.high.z : box.low.z}));
  return out;
}

}  // namespace

Box3 scene_bounds(const Scene& s) {
  std::vector<Box3> meshes, primitives, groups(s.groups.size());
  for (const Mesh& m : s.meshes) meshes.push_back(mesh_box(m));
  for (const Primitive& p : s.primitives) primitives.push_back(primitive_box(p));
  for (size_t g = s.groups.size(); g-- > 0;)
    for (const Placement& p : s.groups[g].placements) {
      const Box3& box = p.kind == TargetKind::mesh    ? meshes[p.target]
                        : p.kind == TargetKind::group ? groups[p.target]
                                                      : primitives[p.target];
      groups[g].grow(moved(box, p.to_parent));
    }
  Box3 all = groups.empty() ? Box3{} : groups.front();
  for (const Volume& v : s.volumes) {
    const VoxelGrid& g = s.grids[v.grid];
    all.grow(moved({{0, 0, 0}, {double(g.cells[0]), double(g.cells[1]), double(g.cells[2])}}, v.to_world * g.to_local));
  }
  return all;
}

}  // namespace suite
