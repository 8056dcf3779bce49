// What is wrong with a triangle mesh, counted and located in its source file.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "base/report.h"
#include "scene/draft.h"

namespace suite {

struct MeshFinding {
  const char* code;               // SP301 to SP314
  size_t count = 0;               // single faults
  std::vector<Finding> examples;  // the first three; of SP311 the worst of each cause
};

struct MeshCheck {
  bool self_intersections = true;
  double sliver = 1e-3;  // height of a triangle over its longest edge below which it is a sliver
};

// Safe to call for different meshes from several threads. Positions must be finite.
std::vector<MeshFinding> check_mesh_quality(const SourceMesh& mesh, const MeshCheck& options = {});

// Checks every mesh of a draft, several at a time, after it was repaired (when asked to) and its holes closed (when the
// draft says so), and then decimates those that are to be; findings come in the order of the draft.
void check_draft_meshes(Draft& draft, const MeshCheck& options, bool repair, Report& report);

// Internal to the library: -----------------------------------------------------------------------------------------

struct Topology {
  size_t boundary_edges = 0, boundary_loops = 0, pieces = 0;
  std::vector<uint32_t> boundary, non_manifold, misoriented;  // triangles at such edges, ascending
  std::vector<uint32_t> pinched;  // triangles at vertices where surfaces touch in a point; empty when edges are unsound
};
// corners: three welded vertices a triangle; triangles with repeated corners are left out.
Topology topology(std::span<const uint32_t> corners, size_t vertices);

// How many pairs of triangles may have boxes that touch before the search for crossings is given up: a closed surface
// has about ten for each triangle.
constexpr size_t most_pairs(size_t triangles) { return 2'000'000 + 60 * triangles; }
// Triangles that cross or overlap another one beyond shared corners and edges, ascending; of those on the same three
// places the first. corners as above. Nothing when there are more than most_pairs pairs. Based on: A. Zomorodian, H.
// Edelsbrunner, "Fast software for box intersections", 2000, and exact predicates, as in CGAL.
std::optional<std::vector<uint32_t>> self_intersecting(std::span<const Vec3> positions,
                                                       std::span<const uint32_t> corners);

}  // namespace suite
