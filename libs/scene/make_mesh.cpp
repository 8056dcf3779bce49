// Lays a mesh out for the ray tracer: used vertices only, an origin in double, the rest in float.
#include <algorithm>
#include <cmath>

#include "scene/bake.h"
#include "scene/vertex_normals.h"

namespace suite {

Vec3 mesh_origin(const Box3& box) {
  // Whole metres keep round coordinates round; tiny objects need a finer step to stay near zero.
  const Vec3 size = box.size();
  const double extent = std::max({size.x, size.y, size.z});
  const double step = extent >= 1024 || extent == 0 ? 1 : std::exp2(std::floor(std::log2(extent / 1024)));
  const Vec3 c = box.center();
  if (std::max({std::fabs(c.x), std::fabs(c.y), std::fabs(c.z)}) <= extent) return {0, 0, 0};  // already local
  const double s = std::min(step, 1.0);
  return {std::round(c.x / s) * s, std::round(c.y / s) * s, std::round(c.z / s) * s};
}

Mesh make_mesh(const SourceMesh& source, const Affine3& to_local, NormalRule rule, std::span<const uint32_t> materials,
               double crease_rad) {
  SUITE_CHECK_EQ(source.runs.size(), materials.size());
  Mesh mesh;
  mesh.name = source.file;
  const bool missing = !source.smoothing.empty() || std::count(source.normals.begin(), source.normals.end(), kNoNormal);
  const bool made = rule == NormalRule::smooth || (rule == NormalRule::file && missing);
  const VertexNormals normals = made ? vertex_normals(source, rule == NormalRule::smooth, crease_rad) : VertexNormals{};
  const std::vector<uint32_t>& indices = made ? normals.indices : source.indices;
  const auto vertex = [&](uint32_t v) { return made ? normals.from[v] : v; };  // of the source
  // Number the used positions in the order of their first use; a mirrored frame turns the winding.
  const bool mirrored = to_local.determinant() < 0;
  std::vector<uint32_t> new_id(made ? normals.from.size() : source.positions.size(), kNone), old_id;
  std::vector<uint32_t> turned(indices.size()), codes;
  std::vector<float> positions, uvs;
  for (size_t k = 0; k < indices.size(); ++k) {
    const uint32_t old = indices[k];
    if (new_id[old] == kNone) new_id[old] = static_cast<uint32_t>(old_id.size()), old_id.push_back(old);
    turned[mirrored && k % 3 ? k - k % 3 + 3 - k % 3 : k] = new_id[old];
  }
  std::vector<Vec3> points(old_id.size());
  Box3 box;
  for (size_t i = 0; i < old_id.size(); ++i) box.grow(points[i] = to_local.point(source.positions[vertex(old_id[i])]));
  mesh.origin = points.empty() ? Vec3{} : mesh_origin(box);
  positions.reserve(3 * points.size() + 1);
  for (const Vec3& p : points)
    for (int k = 0; k < 3; ++k) positions.push_back(static_cast<float>(p[k] - mesh.origin[k]));
  if (!points.empty()) positions.push_back(0);
  if (made || (rule == NormalRule::file && !source.normals.empty()))
    for (const uint32_t old : old_id) {
      const Vec3 n = to_local.normal(made ? normals.normals[old] : oct_decode(source.normals[old]));
      codes.push_back(oct_encode(normalized(mirrored ? -n : n)));
    }
  if (!source.uvs.empty())
    for (const uint32_t old : old_id)
      for (int k = 0; k < 2; ++k) uvs.push_back(source.uvs[2 * size_t{vertex(old)} + k]);
  mesh.positions = std::move(positions), mesh.indices = std::move(turned);
  mesh.normals = std::move(codes), mesh.uvs = std::move(uvs);
  const auto triangles = static_cast<uint32_t>(source.indices.size() / 3);
  for (size_t r = 0; r < source.runs.size(); ++r) {
    const SourceMesh::Run& run = source.runs[r];
    const uint32_t end = r + 1 < source.runs.size() ? source.runs[r + 1].first_triangle : triangles;
    if (end > run.first_triangle)
      mesh.parts.push_back({run.group, run.first_triangle, end - run.first_triangle, materials[r]});
  }
  return mesh;
}

}  // namespace suite
