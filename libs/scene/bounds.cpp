// Extents of a scene from the boxes of its parts, bottom up: children come after parents in the table of groups.
#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "base/placed.h"
#include "motion/track.h"
#include "scene/presence.h"
#include "scene/primitives.h"

namespace suite {

Box3 mesh_box(const Mesh& m) { return m.stored ? m.stored->box : box_of_positions(m); }

Box3 box_of_positions(const Mesh& m) {
  // In float first: the extremes are found faster and are exact.
  const size_t n = m.vertex_count();
  if (n == 0) return {};
  float low[3], high[3];
  for (int a = 0; a < 3; ++a) low[a] = high[a] = m.positions[static_cast<size_t>(a)];
  for (size_t i = 1; i < n; ++i)
    for (size_t a = 0; a < 3; ++a) {
      low[a] = std::min(low[a], m.positions[3 * i + a]);
      high[a] = std::max(high[a], m.positions[3 * i + a]);
    }
  return {m.origin + Vec3{low[0], low[1], low[2]}, m.origin + Vec3{high[0], high[1], high[2]}};
}

Box3 transformed(const Box3& box, const Affine3& map) {
  if (box.empty()) return {};
  const Vec3 center = map.point(box.center()), half = box.size() * 0.5;
  Vec3 reach;
  for (int r = 0; r < 3; ++r) {
    const double* a = &map.a[static_cast<size_t>(3 * r)];
    reach[r] = std::fabs(a[0]) * half.x + std::fabs(a[1]) * half.y + std::fabs(a[2]) * half.z;
  }
  return {center - reach, center + reach};
}

namespace {

// Where a box comes along on its way, sampled so that no corner is more than 1 % of the box off: from kink to kink, as
// what rests for a day may be gone in seconds.
Box3 swept(const Box3& box, const SceneTrack& of, TimeSpan span) {
  if (box.empty()) return {};
  const Track& track = *of.track;
  const double radius = length(box.size()) / 2 + length(box.center());
  std::vector<double> times = track.kinks(span);
  times.insert(times.begin(), span.begin), times.push_back(span.end);
  Box3 all;
  for (size_t k = 0; k + 1 < times.size(); ++k) {
    const TimeSpan part{times[k], times[k + 1]};
    size_t steps = 0;
    try {
      steps = time_steps_for(track, part, radius, 0.01 * radius + 1e-9);
    } catch (const Error& e) {
      throw placed(e, {}, "the motion of " + of.name + ": ");
    }
    for (const Affine3& key : time_keys(track, part, steps)) all.grow(transformed(box, key));
  }
  return all;
}

}  // namespace

Box3 scene_bounds(const Scene& s, double begin, double end) {
  std::vector<Box3> meshes(s.meshes.size()), primitives, groups(s.groups.size());
  parallel_for(0, meshes.size(), 1, [&](size_t b, size_t e) {
    for (size_t i = b; i < e; ++i) meshes[i] = mesh_box(s.meshes[i]);
  });
  for (const Primitive& p : s.primitives) primitives.push_back(primitive_box(p));
  for (size_t g = s.groups.size(); g-- > 0;)
    for (const Placement& p : s.groups[g].placements) {
      const Box3& box = p.kind == TargetKind::mesh    ? meshes[p.target]
                        : p.kind == TargetKind::group ? groups[p.target]
                                                      : primitives[p.target];
      const Box3 placed = transformed(box, p.to_parent);
      const Presence there = presence(s, p.track, p.schedule, {}, {begin, end});
      if (there.any) groups[g].grow(p.track == kNone ? placed : swept(placed, s.tracks[p.track], there.hull));
    }
  Box3 all = groups.empty() ? Box3{} : groups.front();
  for (const Volume& v : s.volumes) {
    const VoxelGrid& g = s.grids[v.grid];
    const Box3 placed = transformed(Box3{{0, 0, 0}, {double(g.cells[0]), double(g.cells[1]), double(g.cells[2])}},
                                    v.to_world * g.to_local);
    all.grow(v.track == kNone ? placed : swept(placed, s.tracks[v.track], {begin, end}));
  }
  return all;
}

}  // namespace suite
