#include "scene/scene.h"

#include <algorithm>
#include <cmath>

namespace suite {

uint32_t oct_encode(Dir d) {
  const double s = 1 / (std::fabs(d.x) + std::fabs(d.y) + std::fabs(d.z));
  double u = d.x * s, v = d.y * s;
  if (d.z < 0) {
    const double fu = (1 - std::fabs(v)) * std::copysign(1.0, u), fv = (1 - std::fabs(u)) * std::copysign(1.0, v);
    u = fu, v = fv;
  }
  const auto snorm = [](double x) { return static_cast<uint32_t>(static_cast<uint16_t>(static_cast<int16_t>(std::lround(std::clamp(x, -1.0, 1.0) * 32767)))); };
  return snorm(u) | (snorm(v) << 16);
}

Dir oct_decode(uint32_t code) {
  double u = static_cast<int16_t>(code & 0xffff) / 32767.0, v = static_cast<int16_t>(code >> 16) / 32767.0;
  const double z = 1 - std::fabs(u) - std::fabs(v);
  if (z < 0) {
    const double fu = (1 - std::fabs(v)) * std::copysign(1.0, u), fv = (1 - std::fabs(u)) * std::copysign(1.0, v);
    u = fu, v = fv;
  }
  return normalized(Vec3{u, v, z});
}

namespace {
[[noreturn]] void bad(const std::string& file, const std::string& what) {
  throw Error(Where{file, 0, 0, {}, -1}, what, "prepare the scene again");
}
void check_mesh(const Mesh& m, size_t materials, const std::string& file) {
  const std::string name = "mesh '" + m.name + "': ";
  if (m.positions.size() % 3 != 1 && !m.positions.empty()) bad(file, name + "positions are not 3 floats a vertex and a pad");
  if (m.indices.size() % 3 != 0) bad(file, name + "indices are not 3 a triangle");
  const size_t n = m.vertex_count();
  if (!m.normals.empty() && m.normals.size() != n) bad(file, name + "as many normals as vertices are needed");
  if (!m.uvs.empty() && m.uvs.size() != 2 * n) bad(file, name + "two UVs a vertex are needed");
  for (const uint32_t i : m.indices)
    if (i >= n) bad(file, name + strf("vertex index %u of %zu", i, n));
  for (const float p : m.positions)
    if (!std::isfinite(p)) bad(file, name + "a coordinate is not finite");
  size_t next = 0;
  for (const Part& p : m.parts) {
    if (p.first_triangle != next) bad(file, name + "parts do not cover the triangles in order");
    next += p.triangle_count;
    if (p.material != kNone && p.material >= materials) bad(file, name + "part '" + p.name + "' names a material that is not there");
  }
  if (next != m.triangle_count()) bad(file, name + "parts do not cover the triangles");
}
}  // namespace

void check_scene(const Scene& s, const std::string& file) {
  for (const Mesh& m : s.meshes) check_mesh(m, s.materials.size(), file);
  if (s.groups.empty()) bad(file, "there is no root group");
  for (const Primitive& p : s.primitives)
    if (p.material != kNone && p.material >= s.materials.size()) bad(file, "primitive '" + p.name + "' names a material that is not there");
  for (size_t g = 0; g < s.groups.size(); ++g)
    for (const Placement& p : s.groups[g].placements) {
      const size_t limit = p.kind == TargetKind::mesh ? s.meshes.size() : p.kind == TargetKind::group ? s.groups.size() : s.primitives.size();
      if (p.target >= limit) bad(file, "group '" + s.groups[g].name + "' places something that is not there");
      // Children come after parents, so the hierarchy cannot contain itself.
      if (p.kind == TargetKind::group && p.target <= g) bad(file, "group '" + s.groups[g].name + "' places a group that is not below it");
      if (p.material_override != kNone && p.material_override >= s.materials.size()) bad(file, "a material override is not there");
      if (p.tag != kNone && p.tag >= s.tags.size()) bad(file, "a tag is not there");
      for (const double a : p.to_parent.a)
        if (!std::isfinite(a)) bad(file, "a transform is not finite");
      if (!finite(p.to_parent.b) || p.to_parent.determinant() == 0) bad(file, "a transform is not finite or flattens its target");
    }
  for (const ClassMap& m : s.class_maps) {
    if (m.classes.size() != size_t{m.width} * m.height || m.classes.empty()) bad(file, "class map '" + m.name + "': size and data disagree");
    for (const uint16_t c : m.classes)
      if (c >= m.materials.size()) bad(file, "class map '" + m.name + strf("': class %u has no material", c));
    for (const uint32_t id : m.materials)
      if (id >= s.materials.size()) bad(file, "class map '" + m.name + "' names a material that is not there");
  }
  for (const MapBinding& b : s.map_bindings)
    if (b.material >= s.materials.size() || b.class_map >= s.class_maps.size()) bad(file, "a map binding names something that is not there");
}

}  // namespace suite
