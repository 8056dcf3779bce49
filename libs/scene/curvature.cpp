#include "scene/curvature.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "scene/bake.h"
#include "scene/primitives.h"

namespace suite {

namespace {

constexpr double kRadius = 6.335e6;  // m, the smallest there is on WGS84
constexpr size_t kMostPlacements = size_t{1} << 26;

SceneFrame frame_at_origin(const GeodeticOrigin& o) {
  return SceneFrame({o.latitude_deg, o.longitude_deg, o.ellipsoid_height_m});
}

// How far the corners of a box are from their true places when the box is turned as a whole around an anchor, m.
double rigid_error(const Box3& box, Vec3 anchor) {
  const double x = std::max(box.high.x - anchor.x, anchor.x - box.low.x),
               y = std::max(box.high.y - anchor.y, anchor.y - box.low.y),
               z = std::max(box.high.z - anchor.z, anchor.z - box.low.z), d = std::hypot(x, y);
  return d * (d / 2 + z) / kRadius;
}

class Curver {
 public:
  Curver(Scene& scene, double tolerance)
      : scene_(scene), tolerance_(tolerance), frame_(frame_at_origin(scene.origin)) {}

  Curved run() {
    boxes();
    old_groups_ = scene_.groups.size();
    const std::vector<Placement> flat = std::move(scene_.groups.front().placements);
    for (const Placement& p : flat) lay(p);
    scene_.groups.front().placements = std::move(laid_);
    for (Volume& v : scene_.volumes) {
      const VoxelGrid& g = scene_.grids[v.grid];
      const Box3 cells{{0, 0, 0}, {double(g.cells[0]), double(g.cells[1]), double(g.cells[2])}};
      v.to_world = rigid(v.to_world, transformed(cells, v.to_world * g.to_local), "voxel grid '" + g.name + "'");
    }
    drop_unplaced();
    std::sort(done_.rigid.begin(), done_.rigid.end());
    done_.rigid.erase(std::unique(done_.rigid.begin(), done_.rigid.end()), done_.rigid.end());
    return std::move(done_);
  }

 private:
  void boxes() {
    for (const Mesh& m : scene_.meshes) mesh_box_.push_back(mesh_box(m));
    for (const Primitive& p : scene_.primitives) primitive_box_.push_back(primitive_box(p));
    group_box_.resize(scene_.groups.size());
    for (size_t g = scene_.groups.size(); g-- > 0;)
      for (const Placement& p : scene_.groups[g].placements) group_box_[g].grow(transformed(box_of(p), p.to_parent));
  }
  const Box3& box_of(const Placement& p) const {
    return p.kind == TargetKind::mesh    ? mesh_box_[p.target]
           : p.kind == TargetKind::group ? group_box_[p.target]
                                         : primitive_box_[p.target];
  }

  Affine3 turned(const Affine3& flat, Vec3 anchor) const {
    const Affine3 turn = Pose{frame_.curved_rotation(anchor), {}}.affine();
    Affine3 t = turn * flat;
    t.b = frame_.curved(anchor) + turn.vector(flat.b - anchor);
    return t;
  }
  // Where to turn a thing around: its own origin, which then lies exactly right, or the middle of where it is.
  static Vec3 anchor_of(const Affine3& flat, const Box3& box, double tolerance) {
    if (box.empty() || rigid_error(box, flat.b) <= tolerance) return flat.b;
    return {box.center().x, box.center().y, flat.b.z};
  }
  Affine3 rigid(const Affine3& flat, const Box3& box, const std::string& name) {
    const Vec3 anchor = anchor_of(flat, box, tolerance_);
    if (box.empty() || rigid_error(box, anchor) > tolerance_) done_.rigid.push_back(name);
    return turned(flat, anchor);
  }

  void push(const Placement& p) {
    if (laid_.size() >= kMostPlacements)
      throw Error("the curved scene has more than 2^26 placements", "place fewer copies");
    laid_.push_back(p);
  }

  // A placement of the root.
  void lay(Placement p) {
    if (p.track != kNone) {
      ++done_.moving;
      return push(p);
    }
    const Box3 box = transformed(box_of(p), p.to_parent);
    const Vec3 anchor = anchor_of(p.to_parent, box, tolerance_);
    if (p.kind == TargetKind::primitive) {
      p.to_parent = rigid(p.to_parent, box, "exact surface '" + scene_.primitives[p.target].name + "'");
      push(p);
    } else if (box.empty() || rigid_error(box, anchor) <= tolerance_) {
      p.to_parent = turned(p.to_parent, anchor);
      push(p);
    } else if (p.kind == TargetKind::group && p.schedule != kNone) {
      // What comes and goes does so as a whole.
      p.to_parent = rigid(p.to_parent, box, "group '" + scene_.groups[p.target].name + "', which comes and goes,");
      push(p);
    } else if (p.kind == TargetKind::group) {
      parts_of(p);
    } else {
      Mesh mesh = laid_down(scene_.meshes[p.target], p.to_parent);
      p.target = static_cast<uint32_t>(scene_.meshes.size());
      p.to_parent = {};
      scene_.meshes.push_back(std::move(mesh));
      push(p);
    }
  }

  // The placements of a group as placements of the root; what they inherit is as in trace/flatten.cpp.
  void parts_of(const Placement& p) {
    for (size_t k = 0; k < scene_.groups[p.target].placements.size(); ++k) {
      Placement part = scene_.groups[p.target].placements[k];
      if (p.material_override != kNone) part.material_override = p.material_override;
      if (part.tag == kNone) part.tag = p.tag;
      if (part.track == kNone && part.schedule == kNone) {
        part.to_parent = p.to_parent * part.to_parent;
        lay(part);
        continue;
      }
      // What moves or changes does so in the frame of its group, which is turned as a whole.
      if (part.track != kNone) ++done_.moving;
      Placement alone;
      alone.material_override = p.material_override;
      alone.kind = TargetKind::group;
      alone.target = static_cast<uint32_t>(scene_.groups.size());
      alone.to_parent = turned(p.to_parent, p.to_parent.b);
      done_.rigid.push_back("moving or changing part of group '" + scene_.groups[p.target].name + "'");
      scene_.groups.push_back({scene_.groups[p.target].name, {part}});
      group_box_.push_back({});
      push(alone);
    }
  }

  // A copy of a mesh, vertex by vertex, in scene ENU.
  Mesh laid_down(const Mesh& m, const Affine3& flat) {
    Mesh out;
    out.name = m.name, out.uvs = m.uvs, out.parts = m.parts;
    std::vector<uint32_t> indices(m.indices.begin(), m.indices.end()), normals(m.normals.size());
    const size_t n = m.vertex_count();
    std::vector<Vec3> plane(n), points(n);
    const bool mirrored = flat.determinant() < 0;
    parallel_for(0, n, 1024, [&](size_t begin, size_t end) {
      for (size_t i = begin; i < end; ++i) {
        const float* f = &m.positions[3 * i];
        plane[i] = flat.point(m.origin + Vec3{f[0], f[1], f[2]});
        points[i] = frame_.curved(plane[i]);
        if (m.normals.empty()) continue;
        const Vec3 v = normalized(flat.normal(oct_decode(m.normals[i])));
        normals[i] = oct_encode(rotate(frame_.curved_rotation(plane[i]), mirrored ? -v : v));
      }
    });
    Box3 box;
    for (const Vec3& p : points) box.grow(p);
    out.origin = mesh_origin(box);
    std::vector<float> positions;
    positions.reserve(3 * n + 1);
    for (const Vec3& p : points)
      for (int k = 0; k < 3; ++k) positions.push_back(static_cast<float>(p[k] - out.origin[k]));
    if (n) positions.push_back(0);
    size_t long_edges = 0;
    for (size_t t = 0; t + 2 < indices.size(); t += 3) {
      double longest = 0;
      for (size_t k = 0; k < 3; ++k) {
        const Vec3 e = plane[indices[t + k]] - plane[indices[t + (k + 1) % 3]];
        longest = std::max(longest, e.x * e.x + e.y * e.y);
      }
      long_edges += longest / (8 * kRadius) > tolerance_;
      if (mirrored) std::swap(indices[t + 1], indices[t + 2]);
    }
    out.positions = std::move(positions), out.indices = std::move(indices), out.normals = std::move(normals);
    if (long_edges) done_.long_edges.emplace_back(m.name, long_edges);
    return out;
  }

  // Groups made here move between the root and the groups that they place, for parents come before children.
  void sort_groups() {
    const auto all = static_cast<uint32_t>(scene_.groups.size()), before = static_cast<uint32_t>(old_groups_);
    const auto first = scene_.groups.begin() + 1;
    std::rotate(first, first + before - 1, scene_.groups.end());
    for (Group& g : scene_.groups)
      for (Placement& p : g.placements)
        if (p.kind == TargetKind::group)
          p.target = p.target >= before ? 1 + p.target - before : p.target + all - before;
  }

  // Resolved groups and meshes that were copied are not needed any more.
  void drop_unplaced() {
    sort_groups();
    std::vector<uint32_t> group_to(scene_.groups.size(), kNone), mesh_to(scene_.meshes.size(), kNone);
    group_to[0] = 0;
    for (size_t g = 0; g < scene_.groups.size(); ++g)
      if (group_to[g] != kNone)
        for (const Placement& p : scene_.groups[g].placements) {
          if (p.kind == TargetKind::group) group_to[p.target] = 0;
          if (p.kind == TargetKind::mesh) mesh_to[p.target] = 0;
        }
    keep(scene_.groups, group_to);
    keep(scene_.meshes, mesh_to);
    for (Group& g : scene_.groups)
      for (Placement& p : g.placements) {
        if (p.kind == TargetKind::group) p.target = group_to[p.target];
        if (p.kind == TargetKind::mesh) p.target = mesh_to[p.target];
      }
  }
  // Closes the gaps; `to` becomes the new numbers.
  template <class Row>
  static void keep(std::vector<Row>& rows, std::vector<uint32_t>& to) {
    uint32_t next = 0;
    for (size_t k = 0; k < rows.size(); ++k) {
      if (to[k] == kNone) continue;
      if (next != k) rows[next] = std::move(rows[k]);
      to[k] = next++;
    }
    rows.resize(next);
  }

  Scene& scene_;
  const double tolerance_;
  const SceneFrame frame_;
  std::vector<Box3> mesh_box_, primitive_box_, group_box_;
  std::vector<Placement> laid_;
  size_t old_groups_ = 0;
  Curved done_;
};

}  // namespace

Curved curve_scene(Scene& scene, double tolerance_m) {
  SUITE_CHECK(scene.origin.given && !scene.curved && tolerance_m > 0);
  Curved done = Curver(scene, tolerance_m).run();
  scene.curved = true;
  set_flat_plane(scene);
  return done;
}

void set_flat_plane(Scene& scene) {
  if (!scene.curved) return;
  const auto plane = std::make_shared<const FlatPlane>(FlatPlane{frame_at_origin(scene.origin), {}});
  for (ClassMap& m : scene.class_maps)
    if (m.projection == Projection::drape) m.drape.plane = plane;
  for (PropertyMap& m : scene.property_maps)
    if (m.projection == Projection::drape) m.drape.plane = plane;
}

}  // namespace suite
