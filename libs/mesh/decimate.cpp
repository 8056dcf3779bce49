#include "mesh/decimate.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>
#include <OpenMesh/Tools/Decimater/DecimaterT.hh>
#include <OpenMesh/Tools/Decimater/ModHausdorffT.hh>
#include <OpenMesh/Tools/Decimater/ModQuadricT.hh>

#include "mesh/orient.h"
#include "mesh/quiet.h"
#include "mesh/repair.h"
#include "mesh/weld.h"

namespace suite {

namespace {

constexpr int kMostTries = 6;
constexpr double kRim = 5e-3;        // of the diagonal of the mesh: how far borders may move when nothing says how far
constexpr size_t kMostFaces = 4096;  // at a vertex; OpenMesh walks around it for every face it gets there

struct Traits : OpenMesh::DefaultTraits {
  using Point = OpenMesh::Vec3d;
  using Normal = OpenMesh::Vec3d;
  FaceTraits {
    std::array<int, 3> vertex{};       // of the half-edge structure
    std::array<uint32_t, 3> source{};  // the vertex of the SourceMesh that the face has there
    uint32_t look = 0;                 // run and smoothing group
  };
};
using HalfEdges = OpenMesh::TriMesh_ArrayKernelT<Traits>;

// Squared distance of a point from a triangle. Based on: C. Ericson, Real-Time Collision Detection, 2005, 5.1.5.
double distance2(const Vec3& p, const std::array<Vec3, 3>& t) {
  const Vec3 n = cross(t[1] - t[0], t[2] - t[0]);
  double nearest = HUGE_VAL;
  bool inside = true;
  for (size_t k = 0; k < 3; ++k) {
    const Vec3 a = t[k], edge = t[(k + 1) % 3] - a, to = p - a;
    const Vec3 off = to - edge * std::clamp(dot(to, edge) / dot(edge, edge), 0.0, 1.0);
    nearest = std::min(nearest, dot(off, off));
    inside = inside && dot(cross(edge, to), n) >= 0;
  }
  const double height = dot(p - t[0], n);
  return inside ? height * height / dot(n, n) : nearest;
}

// Forbids what would change more than the shape: see decimate.h.
template <class M>
class ModBordersT : public OpenMesh::Decimater::ModBaseT<M> {
 public:
  DECIMATING_MODULE(ModBordersT, M, Borders);
  explicit ModBordersT(M& mesh) : Base(mesh, true), mesh_(mesh) {}

  double rim = 0;               // how far open edges and borders may move
  std::span<const float> uvs;   // of the source
  double tolerance = HUGE_VAL;  // how far edges and faces may move in one step

  void initialize() override {}
  float collapse_priority(const CollapseInfo& c) override {
    return leaves_border(c) || bends_border(c) || folds(c) || strays(c) ? static_cast<float>(Base::ILLEGAL_COLLAPSE)
                                                                        : static_cast<float>(Base::LEGAL_COLLAPSE);
  }
  // The faces that stay get what the face that goes on their side of the edge had at the vertex that stays.
  void preprocess_collapse(const CollapseInfo& c) override {
    for (const auto f : mesh_.vf_range(c.v0)) {
      if (f == c.fl || f == c.fr) continue;
      const auto side = !c.fr.is_valid() || (c.fl.is_valid() && same_side(f, c.fl, c.v0)) ? c.fl : c.fr;
      auto& data = mesh_.data(f);
      for (size_t k = 0; k < 3; ++k)
        if (data.vertex[k] == c.v0.idx()) data.vertex[k] = c.v1.idx(), data.source[k] = source_at(side, c.v1);
    }
  }

 private:
  uint32_t source_at(typename M::FaceHandle f, typename M::VertexHandle v) const {
    const auto& data = mesh_.data(f);
    size_t k = 0;
    while (data.vertex[k] != v.idx()) ++k;
    return data.source[k];
  }
  bool same_side(typename M::FaceHandle f, typename M::FaceHandle g, typename M::VertexHandle v) const {
    return source_at(f, v) == source_at(g, v) && mesh_.data(f).look == mesh_.data(g).look;
  }
  // Is an edge at v0 open, or do its two sides differ at one of its ends?
  bool is_border(typename M::HalfedgeHandle h) const {
    const auto o = mesh_.opposite_halfedge_handle(h);
    if (mesh_.is_boundary(h) || mesh_.is_boundary(o)) return true;
    const auto f = mesh_.face_handle(h), g = mesh_.face_handle(o);
    return !same_side(f, g, mesh_.to_vertex_handle(h)) || !same_side(f, g, mesh_.from_vertex_handle(h));
  }
  // A vertex on a border may only go along it, and one where borders meet or end not at all.
  bool leaves_border(const CollapseInfo& c) const {
    size_t borders = 0;
    for (const auto h : mesh_.voh_range(c.v0)) borders += is_border(h);
    return borders != 0 && (borders != 2 || !is_border(c.v0v1));
  }
  // Does the border move by more than `rim`, or the texture along it?
  bool bends_border(const CollapseInfo& c) const {
    for (const auto h : mesh_.voh_range(c.v0)) {
      const auto other = mesh_.to_vertex_handle(h);
      if (other == c.v1 || !is_border(h)) continue;
      const auto along = c.p1 - mesh_.point(other), to = c.p0 - mesh_.point(other);
      const double share = std::clamp((to | along) / along.sqrnorm(), 0.0, 1.0);
      if (!((to - along * share).norm() <= rim)) return true;
      for (const auto f : {c.fl, c.fr})
        if (f.is_valid() && slides(f, c, h, share)) return true;
    }
    return false;
  }
  // Do the texture coordinates on the side of `f` change along the border by more than a hundredth of the picture?
  bool slides(typename M::FaceHandle f, const CollapseInfo& c, typename M::HalfedgeHandle h, double share) const {
    if (uvs.empty()) return false;
    const auto other = mesh_.to_vertex_handle(h);
    for (const auto g : {mesh_.face_handle(h), mesh_.face_handle(mesh_.opposite_halfedge_handle(h))}) {
      if (!g.is_valid() || !same_side(g, f, c.v0)) continue;
      for (size_t i = 0; i < 2; ++i) {
        const auto uv = [&](uint32_t v) { return static_cast<double>(uvs[2 * size_t{v} + i]); };
        const double at = uv(source_at(g, other)), end = uv(source_at(f, c.v1));
        if (std::fabs(at + share * (end - at) - uv(source_at(f, c.v0))) > 0.01) return true;
      }
    }
    return false;
  }
  // Does a face that stays turn by more than 60 degrees, or become a needle?
  bool folds(const CollapseInfo& c) const {
    for (const auto f : mesh_.vf_range(c.v0)) {
      if (f == c.fl || f == c.fr) continue;
      std::array<typename M::Point, 3> p, q;
      size_t k = 0;
      for (const auto v : mesh_.fv_range(f)) p[k] = mesh_.point(v), q[k] = v == c.v0 ? c.p1 : p[k], ++k;
      const auto before = (p[1] - p[0]) % (p[2] - p[0]), after = (q[1] - q[0]) % (q[2] - q[0]);
      const double edge = std::max({(q[1] - q[0]).sqrnorm(), (q[2] - q[1]).sqrnorm(), (q[0] - q[2]).sqrnorm()});
      if (!(after.norm() > 1e-3 * edge) || !((before | after) > 0.5 * before.norm() * after.norm())) return true;
    }
    return false;
  }

  // Vertices may be all within the tolerance (which ModHausdorff sees to) and a ridge between two of them be gone.
  bool strays(const CollapseInfo& c) const {
    if (!std::isfinite(tolerance)) return false;
    const auto place = [](const typename M::Point& p) { return Vec3{p[0], p[1], p[2]}; };
    std::vector<Vec3> old;
    std::vector<std::array<Vec3, 3>> fresh;
    for (const auto f : mesh_.vf_range(c.v0)) {
      std::array<Vec3, 3> p, q;
      size_t k = 0;
      for (const auto v : mesh_.fv_range(f)) p[k] = place(mesh_.point(v)), q[k] = v == c.v0 ? place(c.p1) : p[k], ++k;
      old.push_back((p[0] + p[1] + p[2]) / 3);
      if (f != c.fl && f != c.fr) fresh.push_back(q);
    }
    for (const auto v : mesh_.vv_range(c.v0)) old.push_back((place(c.p0) + place(mesh_.point(v))) / 2);
    return std::any_of(old.begin(), old.end(), [&](const Vec3& p) {
      return std::none_of(fresh.begin(), fresh.end(),
                          [&](const auto& t) { return distance2(p, t) <= tolerance * tolerance; });
    });
  }

  M& mesh_;
};

// Run and smoothing group of every triangle as one number.
std::vector<uint32_t> looks(const SourceMesh& mesh) {
  std::map<std::array<uint32_t, 2>, uint32_t> known;
  std::vector<uint32_t> result;
  size_t run = 0;
  for (uint32_t t = 0; t < mesh.indices.size() / 3; ++t) {
    while (run + 1 < mesh.runs.size() && mesh.runs[run + 1].first_triangle <= t) ++run;
    const std::array<uint32_t, 2> key{static_cast<uint32_t>(run), mesh.smoothing.empty() ? 0 : mesh.smoothing[t]};
    result.push_back(known.try_emplace(key, static_cast<uint32_t>(known.size())).first->second);
  }
  return result;
}

void build(const SourceMesh& source, const std::vector<uint32_t>& corners, const Manifold& m, HalfEdges& mesh) {
  const std::vector<uint32_t> look = looks(source);
  mesh.request_vertex_status(), mesh.request_edge_status(), mesh.request_halfedge_status(), mesh.request_face_status();
  mesh.request_face_normals();  // quadrics are made of them
  for (const uint32_t p : m.from) {
    const Vec3& at = source.positions[p];
    mesh.add_vertex({at.x, at.y, at.z});
  }
  for (size_t t = 0; t < look.size(); ++t) {
    const auto v = [&](size_t k) { return HalfEdges::VertexHandle(static_cast<int>(m.corners[3 * t + k])); };
    const auto f = mesh.add_face(v(0), v(1), v(2));
    SUITE_CHECK_EQ(static_cast<size_t>(f.idx()), t);
    mesh.data(f).look = look[t];
    for (size_t k = 0; k < 3; ++k) {
      mesh.data(f).vertex[k] = v(k).idx();
      for (size_t j = 0; j < 3; ++j)
        if (corners[3 * t + j] == m.from[m.corners[3 * t + k]]) mesh.data(f).source[k] = source.indices[3 * t + j];
    }
  }
  mesh.update_face_normals();
}

void collapse(HalfEdges& mesh, std::span<const float> uvs, size_t target, double error) {
  OpenMesh::Decimater::DecimaterT<HalfEdges> decimater(mesh);
  OpenMesh::Decimater::ModQuadricT<HalfEdges>::Handle quadric;
  OpenMesh::Decimater::ModHausdorffT<HalfEdges>::Handle hausdorff;
  ModBordersT<HalfEdges>::Handle borders;
  decimater.add(quadric);
  decimater.module(quadric).unset_max_err();
  decimater.add(borders);
  Box3 box;
  for (const auto v : mesh.vertices()) box.grow(Vec3{mesh.point(v)[0], mesh.point(v)[1], mesh.point(v)[2]});
  decimater.module(borders).rim = std::isfinite(error) ? error : kRim * length(box.size());
  decimater.module(borders).uvs = uvs;
  if (std::isfinite(error)) {
    decimater.module(borders).tolerance = error;
    decimater.add(hausdorff);
    decimater.module(hausdorff).set_tolerance(error);
  }
  decimater.initialize();
  decimater.decimate_to_faces(0, target);
}

// Removed vertices are kept within `tolerance`; `done.distance` is what that comes to between them.
Decimated attempt(SourceMesh& mesh, const std::vector<uint32_t>& corners, const Manifold& m, double to,
                  double tolerance) {
  const size_t n = corners.size() / 3;
  HalfEdges half_edges;
  build(mesh, corners, m, half_edges);
  collapse(half_edges, mesh.uvs, static_cast<size_t>(std::ceil(to * static_cast<double>(n))), tolerance);
  std::vector<bool> kept(n);
  for (size_t t = 0; t < n; ++t) {
    const HalfEdges::FaceHandle f(static_cast<int>(t));
    kept[t] = !half_edges.status(f).deleted();
    for (size_t k = 0; k < 3 && kept[t]; ++k) mesh.indices[3 * t + k] = half_edges.data(f).source[k];
    if (kept[t] && m.turned[t]) std::swap(mesh.indices[3 * t + 1], mesh.indices[3 * t + 2]);
  }
  Decimated done;
  done.before = n;
  done.after = n - keep_triangles(mesh, kept);
  done.distance = done.after ? farthest(mesh.positions, corners, mesh.indices) : 0;
  return done;
}

}  // namespace

Decimated decimate_mesh(SourceMesh& mesh, double to, double error) {
  tidy_mesh(mesh);
  Decimated done;
  done.before = done.after = mesh.indices.size() / 3;
  const std::vector<uint32_t> corners = welded_corners(mesh.positions, mesh.indices);
  std::vector<uint32_t> faces(mesh.positions.size(), 0);
  for (const uint32_t v : corners) done.refused |= ++faces[v] > kMostFaces;
  if (done.refused) return done;
  const Manifold m = manifold(mesh.positions, corners);
  quiet_openmesh();
  double tolerance = error;
  for (int tries = 0; tries < kMostTries; ++tries) {
    SourceMesh lighter = mesh;
    const Decimated one = attempt(lighter, corners, m, to, tolerance);
    if (one.distance <= error) {
      mesh = std::move(lighter);
      return one;
    }
    tolerance *= 0.9 * error / one.distance;
  }
  return done;
}

}  // namespace suite
