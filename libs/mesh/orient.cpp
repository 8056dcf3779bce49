#include "mesh/orient.h"

#include <algorithm>

#include <CGAL/Polygon_mesh_processing/connected_components.h>
#include <CGAL/Polygon_mesh_processing/orientation.h>
#include <CGAL/Polygon_mesh_processing/repair.h>

#include "mesh/surface.h"

namespace suite {

namespace PMP = CGAL::Polygon_mesh_processing;

namespace {

constexpr const char* kPieceOf = "f:piece";  // the number of a face's piece
constexpr size_t kMostNested = 2000;         // every pair of closed pieces may have to be compared

struct Piece {
  std::vector<uint32_t> triangles;
  size_t turned = 0;
  bool closed = true, consistent = true, inside = false;
  double volume = 0;  // as oriented
};

// Pieces that still hold an edge of two triangles which run along it the same way.
void find_inconsistent(std::span<const uint32_t> corners, const std::vector<bool>& turned,
                       const std::vector<uint32_t>& piece_of, std::vector<Piece>& pieces) {
  struct Edge {
    uint64_t key;
    uint32_t triangle;
    bool forward;
  };
  std::vector<Edge> edges;
  edges.reserve(corners.size());
  for (size_t t = 0; t < turned.size(); ++t)
    for (size_t k = 0; k < 3; ++k) {
      const uint32_t a = corners[3 * t + k], b = corners[3 * t + (k + 1) % 3];
      edges.push_back(
          {uint64_t{std::min(a, b)} << 32 | std::max(a, b), static_cast<uint32_t>(t), (a < b) != turned[t]});
    }
  std::sort(edges.begin(), edges.end(), [](const Edge& a, const Edge& b) { return a.key < b.key; });
  for (size_t i = 0, end; i < edges.size(); i = end) {
    for (end = i; end < edges.size() && edges[end].key == edges[i].key;) ++end;
    if (end - i == 2 && edges[i].forward == edges[i + 1].forward)
      pieces[piece_of[edges[i].triangle]].consistent = false;
  }
}

// Which closed pieces lie inside of another one.
void find_inside(const Surface& mesh, std::vector<Piece>& pieces) {
  std::vector<size_t> closed;
  for (size_t p = 0; p < pieces.size(); ++p)
    if (pieces[p].closed) closed.push_back(p);
  if (closed.size() < 2 || closed.size() > kMostNested) return;
  Surface only = mesh;
  const auto ids = only.property_map<Surface::Face_index, std::size_t>(kPieceOf).first;
  PMP::keep_connected_components(only, closed, ids);
  PMP::remove_isolated_vertices(only);
  only.collect_garbage();
  auto volume = only.add_property_map<Surface::Face_index, std::size_t>("f:volume").first;
  auto component = only.add_property_map<Surface::Face_index, std::size_t>("f:component").first;
  std::vector<size_t> levels;
  PMP::volume_connected_components(
      only, volume,
      CGAL::parameters::do_orientation_tests(false).face_connected_component_map(component).nesting_levels(
          std::ref(levels)));
  for (const auto f : only.faces()) pieces[ids[f]].inside = levels[component[f]] > 0;
}

}  // namespace

std::vector<bool> to_be_turned(std::span<const Vec3> positions, std::span<const uint32_t> corners) {
  OrientedSurface surface = oriented_surface(positions, corners);
  Surface& mesh = surface.mesh;
  std::vector<bool>& turned = surface.turned;
  auto ids = mesh.add_property_map<Surface::Face_index, std::size_t>(kPieceOf).first;
  std::vector<Piece> pieces(PMP::connected_components(mesh, ids));
  std::vector<uint32_t> piece_of(turned.size());
  for (uint32_t t = 0; t < turned.size(); ++t) {
    const Surface::Face_index face(t);
    Piece& p = pieces[piece_of[t] = static_cast<uint32_t>(ids[face])];
    const Vec3 base = positions[corners[3 * size_t{p.triangles.empty() ? t : p.triangles[0]}]];
    const auto corner = [&](size_t k) { return positions[corners[3 * size_t{t} + k]] - base; };
    p.volume += dot(corner(0), cross(corner(1), corner(2))) * (turned[t] ? -1 : 1);
    p.triangles.push_back(t);
    p.turned += turned[t];
    for (const auto h : mesh.halfedges_around_face(mesh.halfedge(face)))
      if (mesh.is_border(mesh.opposite(h))) p.closed = false;
  }
  find_inconsistent(corners, turned, piece_of, pieces);
  find_inside(mesh, pieces);
  for (const Piece& p : pieces) {
    const bool invert = p.closed && !p.inside ? p.volume < 0 : 2 * p.turned > p.triangles.size();
    for (const uint32_t t : p.triangles) turned[t] = p.consistent && turned[t] != invert;
  }
  return std::move(turned);
}

}  // namespace suite
