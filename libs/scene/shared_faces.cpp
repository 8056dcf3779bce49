#include "scene/shared_faces.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "scene/leaves.h"
#include "scene/primitives.h"

namespace suite {

namespace {

constexpr uint64_t kMostLeaves = 1'000'000;
constexpr size_t kMostBodies = 20'000, kMostPairs = 20'000'000, kMostFacesReported = 64;
constexpr double kNear = 2e-7;   // of the largest coordinate: what rays take for one place
constexpr double kAlike = 1e-6;  // of directions
constexpr double kShare = 1e-6;  // of the smaller facet's area, that is more than an edge
constexpr int kCapCorners = 64;

struct Facet {
  std::vector<Vec3> corners;
  Dir normal;
};

// What bounds one medium of one leaf.
struct Body {
  std::string name;
  const Medium* medium = nullptr;
  Box3 box;
  std::vector<Facet> facets;
  bool ball = false;  // of a sphere; its radius along the axes
  Vec3 center, radii;
};

bool touch(const Box3& a, const Box3& b, double near) {
  for (int k = 0; k < 3; ++k)
    if (a.low[k] > b.high[k] + near || b.low[k] > a.high[k] + near) return false;
  return true;
}

double reach(const Box3& box) {
  double most = 0;
  for (int k = 0; k < 3; ++k) most = std::max({most, std::fabs(box.low[k]), std::fabs(box.high[k])});
  return most;
}

Box3 box_of(const Facet& f) {
  Box3 box;
  for (const Vec3 p : f.corners) box.grow(p);
  return box;
}

double area(const std::vector<Vec3>& polygon, Dir normal) {
  double sum = 0;
  for (size_t i = 1; i + 1 < polygon.size(); ++i)
    sum += dot(cross(polygon[i] - polygon[0], polygon[i + 1] - polygon[0]), normal);
  return std::fabs(sum) / 2;
}

// The part of a polygon within another convex one of the same plane (I. E. Sutherland & G. W. Hodgman, "Reentrant
// polygon clipping", CACM 17, 1974).
std::vector<Vec3> clipped(std::vector<Vec3> polygon, const Facet& by) {
  Vec3 middle{};
  for (const Vec3 p : by.corners) middle = middle + p * (1.0 / static_cast<double>(by.corners.size()));
  for (size_t k = 0; k < by.corners.size() && !polygon.empty(); ++k) {
    const Vec3 from = by.corners[k], along = by.corners[(k + 1) % by.corners.size()] - from;
    Vec3 inward = cross(by.normal, along);
    if (dot(inward, middle - from) < 0) inward = -inward;
    std::vector<Vec3> kept;
    for (size_t i = 0; i < polygon.size(); ++i) {
      const Vec3 a = polygon[i], b = polygon[(i + 1) % polygon.size()];
      const double da = dot(inward, a - from), db = dot(inward, b - from);
      if (da >= 0) kept.push_back(a);
      if ((da < 0) != (db < 0)) kept.push_back(a + (b - a) * (da / (da - db)));
    }
    polygon = std::move(kept);
  }
  return polygon;
}

class Bodies {
 public:
  Bodies(const Scene& scene, double time) : scene_(scene) {
    if (std::ranges::none_of(scene.materials, [](const Material& m) { return m.inside != kNone; })) return;
    const Leaves leaves(scene);
    if (leaves.count() > kMostLeaves) return;
    for (uint64_t n = 0; n < leaves.count() && all.size() <= kMostBodies; ++n) {
      try {
        if (const auto leaf = leaves.at(n, time)) add(*leaf);
      } catch (const Error&) {  // a motion that is not known then is told elsewhere
      }
    }
    if (all.size() > kMostBodies) all.clear();
  }
  std::vector<Body> all;

 private:
  const Medium* medium_of(uint32_t material) const {
    if (material == kNone || scene_.materials[material].inside == kNone) return nullptr;
    return &scene_.media[scene_.materials[material].inside];
  }
  void add(const Leaf& leaf) { leaf.kind == TargetKind::mesh ? add_mesh(leaf) : add_primitive(leaf); }
  void keep(Body body) {
    for (const Facet& f : body.facets)
      for (const Vec3 p : f.corners) body.box.grow(p);
    if (!body.box.empty()) all.push_back(std::move(body));
  }
  void add_mesh(const Leaf& leaf) {
    const Mesh& mesh = scene_.meshes[leaf.target];
    std::vector<Body> bodies;
    for (const Part& part : mesh.parts) {
      const Medium* medium = medium_of(leaf.material_override == kNone ? part.material : leaf.material_override);
      if (!medium) continue;
      auto body = std::ranges::find(bodies, medium, &Body::medium);
      if (body == bodies.end()) body = bodies.insert(body, Body{mesh.name, medium, {}, {}, false, {}, {}});
      mesh.require();
      for (size_t t = part.first_triangle; t < size_t{part.first_triangle} + part.triangle_count; ++t) {
        std::vector<Vec3> corners;
        for (size_t c = 0; c < 3; ++c) {
          const size_t v = 3 * size_t{mesh.indices[3 * t + c]};
          corners.push_back(mesh.origin + Vec3{mesh.positions[v], mesh.positions[v + 1], mesh.positions[v + 2]});
        }
        put(*body, leaf.place, corners, cross(corners[1] - corners[0], corners[2] - corners[0]));
      }
    }
    for (Body& body : bodies) keep(std::move(body));
  }
  static void put(Body& body, const Affine3& place, std::vector<Vec3> corners, Vec3 normal) {
    const Vec3 n = place.normal(normal);
    if (!(length(n) > 0)) return;
    for (Vec3& p : corners) p = place.point(p);
    body.facets.push_back({std::move(corners), normalized(n)});
  }
  static void put_cap(Body& body, const Affine3& place, double radius, double z, double up) {
    std::vector<Vec3> corners;
    for (int k = 0; radius > 0 && k < kCapCorners; ++k)
      corners.push_back(
          {radius * std::cos(2 * kPi * k / kCapCorners), radius * std::sin(2 * kPi * k / kCapCorners), z});
    if (!corners.empty()) put(body, place, std::move(corners), {0, 0, up});
  }
  void add_primitive(const Leaf& leaf) {
    const Primitive& p = scene_.primitives[leaf.target];
    const Medium* medium = medium_of(leaf.material_override == kNone ? p.material : leaf.material_override);
    if (!medium) return;
    Body body{p.name, medium, {}, {}, false, {}, {}};
    const auto& a = p.parameters;
    if (p.kind == PrimitiveKind::box && !primitive_box(p).empty()) {
      for (int axis = 0; axis < 3; ++axis)
        for (const bool high : {false, true}) put_side(body, leaf.place, a, axis, high);
    } else if (p.kind == PrimitiveKind::cylinder && a[2] > 0) {
      put_cap(body, leaf.place, a[0], 0, -1), put_cap(body, leaf.place, a[0], a[1], 1);
    } else if (p.kind == PrimitiveKind::cone && a[3] > 0) {
      put_cap(body, leaf.place, a[0], 0, -1), put_cap(body, leaf.place, a[1], a[2], 1);
    } else if (p.kind == PrimitiveKind::sphere) {
      body.ball = true, body.center = leaf.place.b;
      for (int k = 0; k < 3; ++k) {
        Vec3 axis{};
        axis[k] = a[0];
        body.radii[k] = length(leaf.place.vector(axis));
      }
      body.box.grow(body.center - body.radii), body.box.grow(body.center + body.radii);
    }
    keep(std::move(body));
  }
  static void put_side(Body& body, const Affine3& place, const std::vector<double>& a, int axis, bool high) {
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    std::vector<Vec3> corners;
    for (const auto& [du, dv] : {std::pair{0, 0}, {3, 0}, {3, 3}, {0, 3}}) {
      Vec3 p{};
      p[axis] = a[static_cast<size_t>(axis + (high ? 3 : 0))];
      p[u] = a[static_cast<size_t>(u + du)], p[v] = a[static_cast<size_t>(v + dv)];
      corners.push_back(p);
    }
    Vec3 out{};
    out[axis] = high ? 1 : -1;
    put(body, place, std::move(corners), out);
  }
  const Scene& scene_;
};

// A place on a face that both have.
std::optional<Vec3> common_place(const Body& one, const Body& other) {
  const double near = kNear * std::max(reach(one.box), reach(other.box));
  if (one.ball && other.ball)
    return length(one.center - other.center) <= near && length(one.radii - other.radii) <= near
               ? std::optional(one.center + Vec3{0, 0, one.radii.z})
               : std::nullopt;
  std::array<std::vector<const Facet*>, 2> close;
  for (const Facet& f : one.facets)
    if (touch(box_of(f), other.box, near)) close[0].push_back(&f);
  for (const Facet& f : other.facets)
    if (touch(box_of(f), one.box, near)) close[1].push_back(&f);
  if (close[0].size() * close[1].size() > kMostPairs) return std::nullopt;
  for (const Facet* a : close[0])
    for (const Facet* b : close[1]) {
      if (!(dot(a->normal, b->normal) > 1 - kAlike * kAlike)) continue;
      if (!(std::fabs(dot(a->normal, b->corners[0] - a->corners[0])) <= near)) continue;
      const std::vector<Vec3> both = clipped(a->corners, *b);
      if (both.size() < 3) continue;
      if (area(both, a->normal) <= kShare * std::min(area(a->corners, a->normal), area(b->corners, b->normal)))
        continue;
      Vec3 middle{};
      for (const Vec3 p : both) middle = middle + p * (1.0 / static_cast<double>(both.size()));
      return middle;
    }
  return std::nullopt;
}

double volume(const Box3& box) { return box.size().x * box.size().y * box.size().z; }

}  // namespace

std::vector<SharedFace> shared_faces(const Scene& scene, double time) {
  std::vector<SharedFace> reported;
  Bodies bodies(scene, time);
  std::vector<Body>& all = bodies.all;
  std::ranges::sort(all, {}, [](const Body& b) { return b.box.low.x; });
  for (size_t i = 0; i < all.size(); ++i)
    for (size_t k = i + 1; k < all.size() && all[k].box.low.x <= all[i].box.high.x; ++k) {
      if (reported.size() == kMostFacesReported) return reported;
      const bool first = volume(all[i].box) <= volume(all[k].box);
      const Body &one = all[first ? i : k], &other = all[first ? k : i];
      if (one.medium == other.medium || one.medium->priority != other.medium->priority) continue;
      if (!touch(one.box, other.box, 0)) continue;
      if (const auto at = common_place(one, other))
        reported.push_back({one.name, other.name, one.medium->id, other.medium->id, one.medium->priority, *at});
    }
  return reported;
}

}  // namespace suite
