#include "mesh/fill_holes.h"

#include <algorithm>
#include <map>

#define CGAL_HOLE_FILLING_DO_NOT_USE_DT3  // all triangulations are looked at: holes are small
#include <CGAL/Polygon_mesh_processing/border.h>
#include <CGAL/Polygon_mesh_processing/triangulate_hole.h>

#include "mesh/repair.h"
#include "mesh/surface.h"
#include "mesh/weld.h"

namespace suite {

namespace PMP = CGAL::Polygon_mesh_processing;

namespace {

using Halfedge = Surface::Halfedge_index;

// Copies of the vertices around a hole, without normals, and what lies beside its first edge.
struct Rim {
  std::map<uint32_t, uint32_t> vertex;  // of the surface -> of the mesh
  uint32_t beside = 0;                  // triangle
};

Rim copy_rim(SourceMesh& mesh, const std::vector<uint32_t>& corners, const Surface& surface, Halfedge start) {
  Rim rim;
  rim.beside = surface.face(surface.opposite(start));
  for (const auto h : surface.halfedges_around_face(start)) {
    const size_t t = surface.face(surface.opposite(h));
    const auto& p = surface.point(surface.target(h));
    for (size_t k = 0; k < 3; ++k) {
      const Vec3 at = mesh.positions[corners[3 * t + k]];
      if (Kernel::Point_3(at.x, at.y, at.z) != p) continue;
      const uint32_t from = mesh.indices[3 * t + k];
      rim.vertex[surface.target(h)] = static_cast<uint32_t>(mesh.positions.size());
      mesh.positions.push_back(at);
      if (!mesh.normals.empty()) mesh.normals.push_back(kNoNormal);
      for (size_t i = 0; i < 2 && !mesh.uvs.empty(); ++i) {
        const float uv = mesh.uvs[2 * size_t{from} + i];
        mesh.uvs.push_back(uv);
      }
      break;
    }
  }
  return rim;
}

const SourceMesh::Run& run_of(const SourceMesh& mesh, uint32_t triangle) {
  size_t run = mesh.runs.size() - 1;
  while (run && mesh.runs[run].first_triangle > triangle) --run;
  return mesh.runs[run];
}

}  // namespace

FilledHoles fill_holes(SourceMesh& mesh, size_t most_edges) {
  tidy_mesh(mesh);
  FilledHoles done;
  const std::vector<uint32_t> corners = welded_corners(mesh.positions, mesh.indices);
  OrientedSurface oriented = oriented_surface(mesh.positions, corners);
  Surface& surface = oriented.mesh;
  std::vector<Halfedge> cycles;
  PMP::extract_boundary_cycles(surface, std::back_inserter(cycles));
  for (const Halfedge start : cycles) {
    const auto around = surface.halfedges_around_face(start);
    std::vector<Surface::Face_index> fresh;
    if (static_cast<size_t>(std::distance(around.begin(), around.end())) <= most_edges) {
      const Rim rim = copy_rim(mesh, corners, surface, start);
      PMP::triangulate_hole(surface, start, std::back_inserter(fresh));
      if (!fresh.empty()) {
        SourceMesh::Run run = run_of(mesh, rim.beside);
        run.first_triangle = static_cast<uint32_t>(mesh.indices.size() / 3);
        const int line = mesh.lines.empty() ? 0 : mesh.lines[rim.beside];
        mesh.runs.push_back(run);
        for (const auto f : fresh) {
          for (const auto v : surface.vertices_around_face(surface.halfedge(f)))
            mesh.indices.push_back(rim.vertex.at(v));
          if (oriented.turned[rim.beside]) std::swap(*(mesh.indices.end() - 1), *(mesh.indices.end() - 2));
          if (!mesh.lines.empty()) mesh.lines.push_back(line);
          if (!mesh.smoothing.empty()) mesh.smoothing.push_back(0);
        }
      }
    }
    done.triangles += fresh.size();
    ++(fresh.empty() ? done.left : done.holes);
  }
  return done;
}

}  // namespace suite
