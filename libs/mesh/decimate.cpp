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
#include "mesh/repair.h"
#include "mesh/weld.h"

namespace suite {

namespace {

constexpr int kMostTries = 6;
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

  double rim = 0;               // how far an open edge may move
  double tolerance = HUGE_VAL;  // how far edges and faces may move in one step

  void initialize() override {
    fixed_.assign(mesh_.n_vertices(), false);
    for (const auto v : mesh_.vertices()) fixed_[static_cast<size_t>(v.idx())] = on_border(v);
  }
  float collapse_priority(const CollapseInfo& c) override {
    return fixed_[static_cast<size_t>(c.v0.idx())] || splits(c) || cuts_rim(c) || folds(c) || strays(c)
               ? static_cast<float>(Base::ILLEGAL_COLLAPSE)
               : static_cast<float>(Base::LEGAL_COLLAPSE);
  }
  // The faces that stay get what the faces that go had at the vertex that stays.
  void preprocess_collapse(const CollapseInfo& c) override {
    const uint32_t source = source_at(c.fl.is_valid() ? c.fl : c.fr, c.v1);
    for (const auto f : mesh_.vf_range(c.v0))
      if (f != c.fl && f != c.fr)
        for (size_t k = 0; k < 3; ++k)
          if (auto& data = mesh_.data(f); data.vertex[k] == c.v0.idx())
            data.vertex[k] = c.v1.idx(), data.source[k] = source;
  }

 private:
  uint32_t source_at(typename M::FaceHandle f, typename M::VertexHandle v) const {
    const auto& data = mesh_.data(f);
    size_t k = 0;
    while (data.vertex[k] != v.idx()) ++k;
    return data.source[k];
  }
  bool on_border(typename M::VertexHandle v) const {
    typename M::FaceHandle first;
    for (const auto f : mesh_.vf_range(v)) {
      if (!first.is_valid()) first = f;
      if (source_at(f, v) != source_at(first, v) || mesh_.data(f).look != mesh_.data(first).look) return true;
    }
    return false;
  }
  // Is the edge itself a border?
  bool splits(const CollapseInfo& c) const {
    return c.fl.is_valid() && c.fr.is_valid() && source_at(c.fl, c.v1) != source_at(c.fr, c.v1);
  }
  bool cuts_rim(const CollapseInfo& c) const {
    if (!mesh_.is_boundary(c.v0)) return false;
    for (const auto h : mesh_.voh_range(c.v0)) {
      if (!mesh_.is_boundary(h) && !mesh_.is_boundary(mesh_.opposite_halfedge_handle(h))) continue;
      const auto other = mesh_.to_vertex_handle(h);
      if (other == c.v1) continue;
      const auto along = c.p1 - mesh_.point(other), to = c.p0 - mesh_.point(other);
      const double share = std::clamp((to | along) / along.sqrnorm(), 0.0, 1.0);
      if (!((to - along * share).norm() <= rim)) return true;
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
  std::vector<bool> fixed_;
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

void collapse(HalfEdges& mesh, size_t target, double error) {
  OpenMesh::Decimater::DecimaterT<HalfEdges> decimater(mesh);
  OpenMesh::Decimater::ModQuadricT<HalfEdges>::Handle quadric;
  OpenMesh::Decimater::ModHausdorffT<HalfEdges>::Handle hausdorff;
  ModBordersT<HalfEdges>::Handle borders;
  decimater.add(quadric);
  decimater.module(quadric).unset_max_err();
  decimater.add(borders);
  double size = 0;
  for (const auto v : mesh.vertices()) size = std::max(size, mesh.point(v).max_abs());
  // Corners far from the origin carry their rounding.
  decimater.module(borders).rim = std::isfinite(error) ? error : 1e-9 * size;
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
  collapse(half_edges, static_cast<size_t>(std::ceil(to * static_cast<double>(n))), tolerance);
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
  omerr().disable();
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
