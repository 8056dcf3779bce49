// From a Draft to a Scene: resolves every name, cuts terrains into tiles, puts placements on the ground, chooses
// origins and lays the arrays out for the ray tracer. Everything that is wrong is filed in one Report; nothing is
// guessed.
#pragma once
#include "base/report.h"
#include "scene/draft.h"

namespace suite {

// The scene of a draft. With errors in `report` the result is incomplete and must not be written.
Scene bake_scene(const Draft& draft, Report& report);

// Resolves media, what bounds them, grids and volumes of a draft into a scene that has its materials. Internal to
// bake_scene.
void bake_media(const Draft& draft, Report& report, Scene& scene, std::vector<Where>& motion_where);

// Parts shared with tests. ---------------------------------------------------------------------------------------

// Triangles with their origin: the centre of the extent rounded to whole metres (or to a 1024th of the extent when that
// is smaller), vertices in float relative to it; unused positions are dropped; normals by the rule. materials: of each
// run. crease_rad (0 to pi): facets that bend by more keep an edge between them where normals are made.
Mesh make_mesh(const SourceMesh& source, const Affine3& to_local, NormalRule rule, std::span<const uint32_t> materials,
               double crease_rad = kPi);

// The origin that make_mesh chooses for vertices in a box.
Vec3 mesh_origin(const Box3& box);

// A terrain in scene ENU: the grid of a raster, its triangles and its surface.
class TerrainGrid {
 public:
  explicit TerrainGrid(const SourceTerrain& source);
  // Tiles of at most tile_m metres across, each with its own origin; smooth normals from the whole grid; UV (0, 0) at
  // the outer corner of the first pixel, (1, 1) at that of the last. Gaps (no data) have no triangles.
  std::vector<Mesh> tiles(const std::string& name, double tile_m, uint32_t material) const;
  // z of the triangulated surface at (x, y), m; nothing outside of it or in a gap.
  std::optional<double> height_at(double x, double y) const;
  // Some points along its edges, ENU; gaps left out.
  std::vector<Vec3> outline() const;

 private:
  const Vec3& at(uint32_t i, uint32_t j) const { return points_[size_t{j} * width_ + i]; }
  bool cell_height(uint32_t i, uint32_t j, double x, double y, double& z) const;
  Dir normal_at(uint32_t i, uint32_t j) const;
  double mean_spacing(uint32_t di, uint32_t dj) const;
  uint32_t width_, height_;
  std::vector<Vec3> points_;  // NaN = gap
};

}  // namespace suite
