// Terrain from a raster: every sample is put into the scene frame on its own (so Earth curvature and grid convergence
// come out right), the grid is split along the same diagonal everywhere, and tiles repeat the samples they share.
#include <algorithm>
#include <cmath>

#include "scene/bake.h"

namespace suite {

TerrainGrid::TerrainGrid(const SourceTerrain& source) : width_(source.width), height_(source.height) {
  points_.resize(size_t{width_} * height_);
  for (uint32_t j = 0; j < height_; ++j)
    for (uint32_t i = 0; i < width_; ++i) {
      const double h = source.heights[size_t{j} * width_ + i];
      points_[size_t{j} * width_ + i] = std::isfinite(h) ? source.place(i, j, h) : Vec3{NAN, NAN, NAN};
    }
}

std::vector<Vec3> TerrainGrid::outline() const {
  constexpr uint32_t kSteps = 16;
  std::vector<Vec3> points;
  const auto add = [&](uint32_t i, uint32_t j) {
    if (std::isfinite(at(i, j).x)) points.push_back(at(i, j));
  };
  for (uint32_t k = 0; k <= kSteps; ++k) {
    const auto i = static_cast<uint32_t>(uint64_t{width_ - 1} * k / kSteps),
               j = static_cast<uint32_t>(uint64_t{height_ - 1} * k / kSteps);
    add(i, 0), add(i, height_ - 1), add(0, j), add(width_ - 1, j);
  }
  return points;
}

namespace {
// z at (x, y) of the plane through a, b, c when (x, y) lies in their projection, edges included.
bool triangle_height(Vec3 a, Vec3 b, Vec3 c, double x, double y, double& z) {
  const double area = (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
  if (!(std::fabs(area) > 0)) return false;
  const double u = ((x - a.x) * (c.y - a.y) - (y - a.y) * (c.x - a.x)) / area;
  const double v = ((b.x - a.x) * (y - a.y) - (b.y - a.y) * (x - a.x)) / area;
  constexpr double slack = 1e-12;
  if (!(u >= -slack && v >= -slack && u + v <= 1 + slack)) return false;
  z = a.z + u * (b.z - a.z) + v * (c.z - a.z);
  return true;
}
}  // namespace

bool TerrainGrid::cell_height(uint32_t i, uint32_t j, double x, double y, double& z) const {
  const Vec3 a = at(i, j), b = at(i, j + 1), c = at(i + 1, j + 1), d = at(i + 1, j);
  return triangle_height(a, b, c, x, y, z) || triangle_height(a, c, d, x, y, z);
}

std::optional<double> TerrainGrid::height_at(double x, double y) const {
  if (width_ < 2 || height_ < 2) return std::nullopt;
  // Walk to the cell: the grid is nearly affine, so steps from the local cell's edges converge in a few turns.
  double u = 0.5 * (width_ - 1), v = 0.5 * (height_ - 1);
  for (int turn = 0; turn < 64; ++turn) {
    const auto i = static_cast<uint32_t>(std::clamp(u, 0.0, width_ - 2.0)),
               j = static_cast<uint32_t>(std::clamp(v, 0.0, height_ - 2.0));
    const Vec3 o = at(i, j), e = at(i + 1, j) - o, s = at(i, j + 1) - o;
    const double area = e.x * s.y - e.y * s.x;
    if (!(std::fabs(area) > 0)) break;  // a gap: the search below goes on
    const double un = i + ((x - o.x) * s.y - (y - o.y) * s.x) / area,
                 vn = j + (e.x * (y - o.y) - e.y * (x - o.x)) / area;
    const bool settled = std::fabs(un - u) + std::fabs(vn - v) < 1e-9;
    u = un, v = vn;
    if (settled) break;
  }
  if (!(u > -2 && v > -2 && u < width_ + 1 && v < height_ + 1)) return std::nullopt;
  double z = 0;
  const auto i0 = static_cast<uint32_t>(std::clamp(u - 1, 0.0, width_ - 2.0)),
             j0 = static_cast<uint32_t>(std::clamp(v - 1, 0.0, height_ - 2.0));
  for (uint32_t j = j0; j <= std::min(j0 + 2, height_ - 2); ++j)
    for (uint32_t i = i0; i <= std::min(i0 + 2, width_ - 2); ++i)
      if (cell_height(i, j, x, y, z)) return z;
  // Beside a gap the walk may have stopped early.
  for (uint32_t j = 0; j + 1 < height_; ++j)
    for (uint32_t i = 0; i + 1 < width_; ++i)
      if (cell_height(i, j, x, y, z)) return z;
  return std::nullopt;
}

Dir TerrainGrid::normal_at(uint32_t i, uint32_t j) const {
  // Central differences, one-sided at edges and gaps.
  const auto pick = [&](uint32_t k, uint32_t l, uint32_t fi, uint32_t fj) {
    return finite(at(k, l)) ? at(k, l) : at(fi, fj);
  };
  const Vec3 east = pick(std::min(i + 1, width_ - 1), j, i, j) - pick(i ? i - 1 : 0, j, i, j);
  const Vec3 south = pick(i, std::min(j + 1, height_ - 1), i, j) - pick(i, j ? j - 1 : 0, i, j);
  const Vec3 n = cross(south, east);
  const double len = length(n);
  if (!(len > 0)) return {0, 0, 1};
  return n.z < 0 ? n / -len : n / len;
}

double TerrainGrid::mean_spacing(uint32_t di, uint32_t dj) const {
  double sum = 0;
  size_t count = 0;
  for (uint32_t j = 0; j + dj < height_; ++j)
    for (uint32_t i = 0; i + di < width_; ++i)
      if (const Vec3 d = at(i + di, j + dj) - at(i, j); finite(d)) sum += std::hypot(d.x, d.y), ++count;
  return count ? sum / static_cast<double>(count) : 1;
}

namespace {
// Tiles of equal size, none larger than asked for.
uint32_t cells_per_tile(uint32_t samples, double spacing, double tile_m) {
  const double cells = samples - 1.0, tiles = std::max(1.0, std::ceil(cells * spacing / tile_m - 1e-9));
  return static_cast<uint32_t>(std::max(1.0, std::ceil(cells / tiles)));
}
}  // namespace

std::vector<Mesh> TerrainGrid::tiles(const std::string& name, double tile_m, uint32_t material) const {
  std::vector<Mesh> result;
  if (width_ < 2 || height_ < 2) return result;
  const uint32_t ci = cells_per_tile(width_, mean_spacing(1, 0), tile_m),
                 cj = cells_per_tile(height_, mean_spacing(0, 1), tile_m);
  for (uint32_t j0 = 0; j0 + 1 < height_; j0 += cj)
    for (uint32_t i0 = 0; i0 + 1 < width_; i0 += ci) {
      const uint32_t i1 = std::min(i0 + ci, width_ - 1), j1 = std::min(j0 + cj, height_ - 1);
      SourceMesh s;
      const uint32_t columns = i1 - i0 + 1;
      for (uint32_t j = j0; j <= j1; ++j)
        for (uint32_t i = i0; i <= i1; ++i) {
          s.positions.push_back(at(i, j));
          s.normals.push_back(oct_encode(normal_at(i, j)));
          s.uvs.push_back(static_cast<float>((i + 0.5) / width_));
          s.uvs.push_back(static_cast<float>((j + 0.5) / height_));
        }
      const auto id = [&](uint32_t i, uint32_t j) { return (j - j0) * columns + (i - i0); };
      const auto triangle = [&](uint32_t a, uint32_t b, uint32_t c) {
        if (!finite(s.positions[a]) || !finite(s.positions[b]) || !finite(s.positions[c])) return;
        // Counter-clockwise from above, whatever way the raster's rows run.
        const Vec3 n = cross(s.positions[b] - s.positions[a], s.positions[c] - s.positions[a]);
        if (n.z < 0) std::swap(b, c);
        for (const uint32_t v : {a, b, c}) s.indices.push_back(v);
      };
      for (uint32_t j = j0; j < j1; ++j)
        for (uint32_t i = i0; i < i1; ++i) {
          triangle(id(i, j), id(i, j + 1), id(i + 1, j + 1));
          triangle(id(i, j), id(i + 1, j + 1), id(i + 1, j));
        }
      if (s.indices.empty()) continue;
      s.runs.push_back({name, "", 0, 0});
      Mesh mesh = make_mesh(s, Affine3{}, NormalRule::file, std::span(&material, 1));
      mesh.name = ci >= width_ - 1 && cj >= height_ - 1 ? name : name + strf("/%u.%u", j0 / cj, i0 / ci);
      result.push_back(std::move(mesh));
    }
  return result;
}

}  // namespace suite
