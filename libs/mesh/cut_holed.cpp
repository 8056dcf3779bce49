#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_face_base_with_info_2.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>

#include <cmath>
#include <optional>

#include "math/polygon.h"
#include "mesh/cut.h"

namespace suite {

namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Vertex = CGAL::Triangulation_vertex_base_with_info_2<uint32_t, Kernel>;
// How many rings lie around a face; -1: not known yet.
using Face =
    CGAL::Constrained_triangulation_face_base_2<Kernel, CGAL::Triangulation_face_base_with_info_2<int, Kernel>>;
using Data = CGAL::Triangulation_data_structure_2<Vertex, Face>;
using Plane = CGAL::Constrained_Delaunay_triangulation_2<Kernel, Data,
                                                         CGAL::No_constraint_intersection_requiring_constructions_tag>;

// Corners in the plane of the outer ring; nothing when that has no area.
std::vector<Kernel::Point_2> flattened(const SourceMesh& mesh, const SourceMesh::Holed& p) {
  const auto corner = [&](size_t k) { return mesh.positions[p.corners[k]]; };
  const size_t outer = p.ring_ends[0];
  Vec3 normal;
  for (size_t i = 0; i < outer; ++i) normal += cross(corner(i) - corner(0), corner((i + 1) % outer) - corner(0));
  const double size = length(normal);
  if (!(size > 0) || !std::isfinite(size)) return {};
  const Frame frame = Frame::around(normal / size);
  std::vector<Kernel::Point_2> flat;
  for (size_t k = 0; k < p.corners.size(); ++k)
    flat.emplace_back(dot(corner(k) - corner(0), frame.x), dot(corner(k) - corner(0), frame.y));
  return flat;
}

// Area of a ring from begin to end, anticlockwise positive.
double area_of(const std::vector<Kernel::Point_2>& p, size_t begin, size_t end) {
  double twice = 0;
  for (size_t k = begin; k < end; ++k) {
    const auto &a = p[k], &b = p[k + 1 == end ? begin : k + 1];
    twice += (a.x() - p[begin].x()) * (b.y() - p[begin].y()) - (b.x() - p[begin].x()) * (a.y() - p[begin].y());
  }
  return twice / 2;
}

// From the outside over every ring's edges: inside where their number is odd.
void count_rings(Plane& plane) {
  for (const auto face : plane.all_face_handles()) face->info() = -1;
  std::vector<Plane::Face_handle> open{plane.infinite_face()};
  plane.infinite_face()->info() = 0;
  std::vector<Plane::Face_handle> next;
  while (!open.empty()) {
    next.clear();
    // All of one depth before the next one is begun.
    for (size_t k = 0; k < open.size(); ++k) {
      const Plane::Face_handle face = open[k];
      for (int e = 0; e < 3; ++e) {
        const Plane::Face_handle other = face->neighbor(e);
        if (other->info() >= 0) continue;
        if (face->is_constrained(e)) {
          next.push_back(other);
          continue;
        }
        other->info() = face->info();
        open.push_back(other);
      }
    }
    const int depth = open.empty() ? 0 : open.front()->info() + 1;
    open.clear();
    for (const auto face : next)
      if (face->info() < 0) face->info() = depth, open.push_back(face);
  }
}

using Triangles = std::vector<std::array<uint32_t, 3>>;

// Nothing where that cannot be done.
std::optional<Triangles> cut(const SourceMesh& mesh, const SourceMesh::Holed& p) {
  const std::vector<Kernel::Point_2> flat = flattened(mesh, p);
  if (flat.empty()) return std::nullopt;
  Plane plane;
  double wanted = 0;
  std::vector<Plane::Vertex_handle> at(flat.size());
  for (size_t k = 0; k < flat.size(); ++k) {
    at[k] = plane.insert(flat[k], k ? at[k - 1]->face() : Plane::Face_handle());
    at[k]->info() = p.corners[k];
  }
  if (plane.dimension() < 2) return std::nullopt;  // all on a line but for rounding
  try {
    for (size_t r = 0, begin = 0; r < p.ring_ends.size(); begin = p.ring_ends[r++]) {
      const size_t end = p.ring_ends[r];
      if (end - begin < 3) continue;
      wanted += r == 0 ? area_of(flat, begin, end) : -std::fabs(area_of(flat, begin, end));
      for (size_t k = begin; k < end; ++k) {
        const auto a = at[k], b = at[k + 1 == end ? begin : k + 1];
        if (a != b) plane.insert_constraint(a, b);
      }
    }
  } catch (const Plane::Intersection_of_constraints_exception&) {
    return std::nullopt;
  }
  count_rings(plane);
  Triangles made;
  double area = 0;
  for (const auto face : plane.finite_face_handles()) {
    if (face->info() % 2 == 0) continue;
    made.push_back({face->vertex(0)->info(), face->vertex(1)->info(), face->vertex(2)->info()});
    area += CGAL::to_double(plane.triangle(face).area());
  }
  if (!(std::fabs(area - wanted) <= 1e-6 * std::fabs(area_of(flat, 0, p.ring_ends[0])))) return std::nullopt;
  return made;
}

// The outer ring without its holes.
Triangles closed(const SourceMesh& mesh, const SourceMesh::Holed& p) {
  std::vector<Vec3> ring;
  for (size_t k = 0; k < p.ring_ends[0]; ++k) ring.push_back(mesh.positions[p.corners[k]]);
  bool clean = true;
  Triangles made;
  for (const auto& t : split_polygon(ring, clean))
    made.push_back({p.corners[static_cast<size_t>(t[0])], p.corners[static_cast<size_t>(t[1])],
                    p.corners[static_cast<size_t>(t[2])]});
  return made;
}

}  // namespace

void cut_holed(SourceMesh& mesh, Report& report) {
  if (mesh.holed.empty()) return;
  if (mesh.indices.empty()) mesh.runs.clear();
  for (const SourceMesh::Holed& p : mesh.holed) {
    auto made = cut(mesh, p);
    if (!made) {
      report.add("SP206", mesh.file,
                 {p.where, strf("a polygon of %zu corners with %zu holes: its holes are closed", p.corners.size(),
                                p.ring_ends.size() - 1)});
      made = closed(mesh, p);
    }
    const auto first = static_cast<uint32_t>(mesh.indices.size() / 3);
    if (mesh.runs.empty() || mesh.runs.back().group != p.group || mesh.runs.back().material != p.material)
      mesh.runs.push_back({p.group, p.material, first, p.where.line});
    for (const auto& t : *made) mesh.indices.insert(mesh.indices.end(), t.begin(), t.end());
    if (!mesh.lines.empty()) mesh.lines.resize(mesh.indices.size() / 3, p.where.line);
  }
  mesh.holed.clear();
}

}  // namespace suite
