#include <CGAL/Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_face_base_with_info_2.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>

#include <algorithm>
#include <cmath>
#include <queue>

#include "mesh/cut.h"

namespace suite {

namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;

// Of a face: the points that lie in it, and the one that is farthest from it.
struct Cover {
  std::vector<uint32_t> points;
  uint32_t farthest = kNone;
  double error = 0;
  uint32_t round = 0;  // counts its changes, so that what was said of it before is known to be old
};
using Vertex = CGAL::Triangulation_vertex_base_with_info_2<uint32_t, Kernel>;
using Face = CGAL::Triangulation_face_base_with_info_2<Cover, Kernel>;
using Surface = CGAL::Delaunay_triangulation_2<Kernel, CGAL::Triangulation_data_structure_2<Vertex, Face>>;

class Builder {
 public:
  explicit Builder(const SourceMesh& mesh) : at_(mesh.positions) {}
  void start();
  void refine(double error);
  Tin write(SourceMesh& mesh, double longest) const;

 private:
  struct Worst {
    double error;
    Surface::Face_handle face;
    uint32_t round, point;
    // Equal errors by the number of the point, so that the result does not depend on where faces lie in memory.
    bool operator<(const Worst& o) const { return error != o.error ? error < o.error : point > o.point; }
  };
  Kernel::Point_2 flat(uint32_t k) const { return {at_[k].x, at_[k].y}; }
  Surface::Face_handle home_of(uint32_t point, Surface::Face_handle near) const;
  double off(Surface::Face_handle face, uint32_t point) const;
  void look_at(Surface::Face_handle face);
  void insert(uint32_t point, Surface::Face_handle face);

  const std::vector<Vec3>& at_;
  Surface surface_;
  std::priority_queue<Worst> worst_;
  size_t points_ = 0;
};

// The face that a point within the hull lies in; one on the hull's edge lies in the face beside it.
Surface::Face_handle Builder::home_of(uint32_t point, Surface::Face_handle near) const {
  const Surface::Face_handle face = surface_.locate(flat(point), near);
  return surface_.is_infinite(face) ? face->neighbor(face->index(surface_.infinite_vertex())) : face;
}

// Height of a point above the triangle that it lies in; with its sign left out.
double Builder::off(Surface::Face_handle face, uint32_t point) const {
  const Vec3 a = at_[face->vertex(0)->info()], b = at_[face->vertex(1)->info()] - a,
             c = at_[face->vertex(2)->info()] - a, p = at_[point] - a;
  const double area = b.x * c.y - b.y * c.x;
  if (!(area > 0)) return std::fabs(p.z);
  const double u = (p.x * c.y - p.y * c.x) / area, v = (b.x * p.y - b.y * p.x) / area;
  return std::fabs(p.z - u * b.z - v * c.z);
}

void Builder::look_at(Surface::Face_handle face) {
  Cover& cover = face->info();
  ++cover.round;
  cover.farthest = kNone, cover.error = 0;
  for (const uint32_t p : cover.points) {
    const double error = off(face, p);
    if (cover.farthest == kNone || error > cover.error || (error == cover.error && p < cover.farthest))
      cover.farthest = p, cover.error = error;
  }
  if (cover.farthest != kNone) worst_.push({cover.error, face, cover.round, cover.farthest});
}

// The convex hull, over which all other points lie.
void Builder::start() {
  std::vector<uint32_t> order(at_.size());
  for (uint32_t k = 0; k < order.size(); ++k) order[k] = k;
  const auto before = [&](uint32_t a, uint32_t b) {
    return at_[a].x != at_[b].x ? at_[a].x < at_[b].x : at_[a].y != at_[b].y ? at_[a].y < at_[b].y : a < b;
  };
  std::sort(order.begin(), order.end(), before);
  order.erase(std::unique(order.begin(), order.end(),
                          [&](uint32_t a, uint32_t b) { return at_[a].x == at_[b].x && at_[a].y == at_[b].y; }),
              order.end());
  points_ = order.size();
  // Andrew's monotone chain; corners only.
  std::vector<uint32_t> hull;
  std::vector<bool> on_hull(at_.size(), false);
  for (int side = 0; side < 2; ++side) {
    hull.clear();
    for (const uint32_t p : order) {
      while (hull.size() > 1 && CGAL::orientation(flat(hull[hull.size() - 2]), flat(hull.back()), flat(p)) !=
                                    (side == 0 ? CGAL::LEFT_TURN : CGAL::RIGHT_TURN))
        hull.pop_back();
      hull.push_back(p);
    }
    for (const uint32_t p : hull) on_hull[p] = true;
  }
  Surface::Face_handle near;
  for (const uint32_t p : order)
    if (on_hull[p]) {
      const auto v = surface_.insert(flat(p), near);
      v->info() = p, near = v->face();
    }
  if (surface_.dimension() < 2) return;
  for (const uint32_t p : order) {
    if (on_hull[p]) continue;
    near = home_of(p, near);
    near->info().points.push_back(p);
  }
  for (const auto face : surface_.finite_face_handles()) look_at(face);
}

// A new corner: the faces that it changes hand their points over to those that take their place.
void Builder::insert(uint32_t point, Surface::Face_handle face) {
  std::vector<Surface::Face_handle> changed;
  surface_.get_conflicts(flat(point), std::back_inserter(changed), face);
  std::vector<uint32_t> homeless;
  for (const auto f : changed) {
    homeless.insert(homeless.end(), f->info().points.begin(), f->info().points.end());
    f->info().points.clear();
  }
  std::sort(homeless.begin(), homeless.end());
  const auto v = surface_.insert(flat(point), face);
  v->info() = point;
  std::vector<Surface::Face_handle> around;
  auto circle = surface_.incident_faces(v), first = circle;
  do {
    if (!surface_.is_infinite(circle)) around.push_back(circle);
  } while (++circle != first);
  // Faces may be made where others were: what was said of them is old.
  for (const auto f : around) f->info().points.clear();
  Surface::Face_handle near = around.front();
  for (const uint32_t p : homeless) {
    if (p == point) continue;
    near = home_of(p, near);
    near->info().points.push_back(p);
  }
  for (const auto f : around) look_at(f);
}

void Builder::refine(double error) {
  while (!worst_.empty()) {
    const Worst w = worst_.top();
    if (error > 0 && w.error <= error) break;
    worst_.pop();
    if (w.face->info().round != w.round || w.face->info().farthest != w.point) continue;
    insert(w.point, w.face);
  }
}

Tin Builder::write(SourceMesh& mesh, double longest) const {
  Tin tin;
  tin.points = points_;
  if (surface_.dimension() < 2) return tin;
  for (const auto face : surface_.finite_face_handles()) tin.error = std::max(tin.error, face->info().error);
  std::vector<bool> used(mesh.positions.size(), false);
  std::vector<std::array<uint32_t, 3>> all;
  for (const auto face : surface_.finite_face_handles()) {
    std::array<uint32_t, 3> t{face->vertex(0)->info(), face->vertex(1)->info(), face->vertex(2)->info()};
    bool kept = true;
    for (size_t k = 0; k < 3 && longest > 0; ++k) {
      const Vec3 edge = at_[t[(k + 1) % 3]] - at_[t[k]];
      kept = kept && std::hypot(edge.x, edge.y) <= longest;
    }
    if (!kept) continue;
    std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
    all.push_back(t);
    for (const uint32_t v : t) used[v] = true;
  }
  std::sort(all.begin(), all.end());
  std::vector<uint32_t> number(used.size(), kNone);
  for (size_t k = 0; k < used.size(); ++k)
    if (used[k]) {
      number[k] = static_cast<uint32_t>(tin.used);
      mesh.positions[tin.used++] = mesh.positions[k];
    }
  mesh.positions.resize(tin.used);
  for (const auto& t : all)
    for (const uint32_t v : t) mesh.indices.push_back(number[v]);
  return tin;
}

}  // namespace

Tin make_tin(SourceMesh& mesh, double error, double longest) {
  Builder builder(mesh);
  builder.start();
  builder.refine(error);
  return builder.write(mesh, longest);
}

}  // namespace suite
