#include "mesh/surface.h"

#include <array>

#include <CGAL/Polygon_mesh_processing/orient_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Polygon_mesh_processing/stitch_borders.h>

#include "base/error.h"
#include "mesh/orient.h"

namespace suite {

namespace PMP = CGAL::Polygon_mesh_processing;

OrientedSurface oriented_surface(std::span<const Vec3> positions, std::span<const uint32_t> corners) {
  std::vector<Kernel::Point_3> points;
  points.reserve(positions.size());
  for (const Vec3& p : positions) points.emplace_back(p.x, p.y, p.z);
  std::vector<std::array<size_t, 3>> triangles(corners.size() / 3);
  for (size_t t = 0; t < triangles.size(); ++t) triangles[t] = {corners[3 * t], corners[3 * t + 1], corners[3 * t + 2]};
  PMP::orient_polygon_soup(points, triangles);  // false only says that vertices were doubled
  OrientedSurface result;
  result.turned.resize(triangles.size());
  for (size_t t = 0; t < triangles.size(); ++t) {
    // Doubled vertices have new numbers, but their places tell the corners of a triangle apart.
    size_t k = 0;
    while (points[triangles[t][k]] != points[corners[3 * t]]) ++k;
    result.turned[t] = points[triangles[t][(k + 1) % 3]] != points[corners[3 * t + 1]];
  }
  PMP::polygon_soup_to_polygon_mesh(points, triangles, result.mesh);
  SUITE_CHECK_EQ(static_cast<size_t>(result.mesh.number_of_faces()), triangles.size());
  // Two bodies that share an edge are cut apart along it; each is closed again by itself.
  PMP::stitch_borders(result.mesh, CGAL::parameters::apply_per_connected_component(true));
  return result;
}

Manifold manifold(std::span<const Vec3> positions, std::span<const uint32_t> corners) {
  OrientedSurface surface = oriented_surface(positions, corners);
  Manifold result;
  result.corners.reserve(corners.size());
  result.from.resize(surface.mesh.num_vertices());
  for (const auto face : surface.mesh.faces())
    for (const auto v : surface.mesh.vertices_around_face(surface.mesh.halfedge(face))) {
      result.corners.push_back(v);
      const auto& p = surface.mesh.point(v);
      for (size_t k = 0; k < 3; ++k)
        if (const Vec3 q = positions[corners[3 * size_t{face} + k]]; p == Kernel::Point_3(q.x, q.y, q.z))
          result.from[v] = corners[3 * size_t{face} + k];
    }
  result.turned = std::move(surface.turned);
  return result;
}

}  // namespace suite
