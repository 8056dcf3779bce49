#include "scene/scene.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "base/parallel.h"

namespace suite {

uint32_t oct_encode(Dir d) {
  const double s = 1 / (std::fabs(d.x) + std::fabs(d.y) + std::fabs(d.z));
  double u = d.x * s, v = d.y * s;
  if (d.z < 0) {
    const double fu = (1 - std::fabs(v)) * std::copysign(1.0, u), fv = (1 - std::fabs(u)) * std::copysign(1.0, v);
    u = fu, v = fv;
  }
  const auto snorm = [](double x) {
    return static_cast<uint32_t>(
        static_cast<uint16_t>(static_cast<int16_t>(std::lround(std::clamp(x, -1.0, 1.0) * 32767))));
  };
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
void check_transform(const Affine3& t, const std::string& file, const std::string& what) {
  for (const double a : t.a)
    if (!std::isfinite(a)) bad(file, what + "the transform is not finite");
  if (!finite(t.b) || t.determinant() == 0) bad(file, what + "the transform is not finite or flattens its target");
}
}  // namespace

void check_arrays(const Mesh& m, const std::string& file) {
  const std::string name = "mesh '" + m.name + "': ";
  if (m.positions.size() % 3 != 1 && !m.positions.empty())
    bad(file, name + "positions are not 3 floats a vertex and a pad");
  if (m.indices.size() % 3 != 0) bad(file, name + "indices are not 3 a triangle");
  const size_t n = m.vertex_count();
  if (!m.normals.empty() && m.normals.size() != n) bad(file, name + "as many normals as vertices are needed");
  if (!m.uvs.empty() && m.uvs.size() != 2 * n) bad(file, name + "two UVs a vertex are needed");
  // Reductions first: they vectorise, and a file is nearly always right.
  uint32_t largest = 0, faulty = 0;
  for (const uint32_t i : m.indices) largest = std::max(largest, i);
  if (!m.indices.empty() && largest >= n) bad(file, name + strf("vertex index %u of %zu", largest, n));
  for (const float p : m.positions) faulty |= (std::bit_cast<uint32_t>(p) & 0x7f800000u) == 0x7f800000u;
  if (faulty) bad(file, name + "a coordinate is not finite");
  if (!m.stored) return;
  Mesh here;
  here.origin = m.origin, here.positions = std::move(m.positions);
  const Box3 box = mesh_box(here), said = m.stored->box;
  m.positions = std::move(here.positions);
  if (m.indices.size() != 3 * m.stored->triangles ||
      (m.positions.empty() ? 0 : m.positions.size() / 3) != m.stored->vertices ||
      !(box.low == said.low && box.high == said.high))
    bad(file, name + "it is not as large as was said of it");
}

void Mesh::require() const {
  if (!stored) return;
  const std::lock_guard lock(stored->turn);
  if (!positions.empty() || !indices.empty() || !stored->vertices) return;
  try {
    stored->fill(*this);
  } catch (...) {  // whoever asks again must be told again
    positions.clear(), indices.clear(), normals.clear(), uvs.clear();
    throw;
  }
}

namespace {
void check_mesh(const Mesh& m, size_t materials, const std::string& file) {
  if (!m.stored) check_arrays(m, file);
  const std::string name = "mesh '" + m.name + "': ";
  size_t next = 0;
  for (const Part& p : m.parts) {
    if (p.first_triangle != next) bad(file, name + "parts do not cover the triangles in order");
    next += p.triangle_count;
    if (p.material != kNone && p.material >= materials)
      bad(file, name + "part '" + p.name + "' names a material that is not there");
  }
  if (next != m.triangle_count()) bad(file, name + "parts do not cover the triangles");
}
}  // namespace

namespace {
void check_property_map(const PropertyMap& m, size_t materials, const std::string& file) {
  const std::string name = "map '" + m.name + "': ";
  if (m.channels == 0 || m.values.empty() || m.values.size() != size_t{m.width} * m.height * m.channels)
    bad(file, name + "size and data disagree");
  const size_t expected = m.kind == MapKind::mixture  ? m.materials.size()
                          : m.kind == MapKind::cube   ? m.wavelength_um.size()
                          : m.kind == MapKind::normal ? 3
                                                      : 1;
  if (m.channels != expected) bad(file, name + strf("%u channels, %zu are needed", m.channels, expected));
  for (const uint32_t id : m.materials)
    if (id >= materials) bad(file, name + "names a material that is not there");
  for (size_t k = 0; k < m.wavelength_um.size(); ++k)
    if (!(m.wavelength_um[k] > (k ? m.wavelength_um[k - 1] : 0)) || !std::isfinite(m.wavelength_um[k]))
      bad(file, name + "wavelengths do not ascend");
  float low = INFINITY, high = -INFINITY;
  for (const float v : m.values) {
    if (!std::isfinite(v)) bad(file, name + "a value is not finite");
    low = std::min(low, v), high = std::max(high, v);
  }
  const bool share = m.kind == MapKind::mixture || m.kind == MapKind::cube || m.kind == MapKind::opacity;
  if (share && !(low >= 0 && high <= 1.0001f))
    bad(file, name + strf("values from %g to %g, 0 to 1 are needed", low, high));
  if (m.kind == MapKind::temperature && !(low >= 1 && high <= 1e5f))
    bad(file, name + strf("temperatures from %g to %g K", low, high));
  if (m.kind == MapKind::curve_index && !(low >= 0 && high < static_cast<float>(m.family.size())))
    bad(file, name + strf("curve %g of %zu", high, m.family.size()));
}
}  // namespace

namespace {
void check_grid(const VoxelGrid& g, size_t media, const std::string& file) {
  const std::string name = "voxel grid '" + g.name + "': ";
  const size_t n = g.size();
  if (n == 0 || g.density.size() != n || (!g.kind.empty() && g.kind.size() != n) ||
      (!g.temperature.empty() && g.temperature.size() != n))
    bad(file, name + "size and data disagree");
  if (g.media.empty()) bad(file, name + "has no medium");
  for (const uint32_t m : g.media)
    if (m >= media) bad(file, name + "names a medium that is not there");
  for (const uint8_t k : g.kind)
    if (k >= g.media.size()) bad(file, name + strf("kind %u of %zu", k, g.media.size()));
  for (const float d : g.density)
    if (!(d >= 0 && std::isfinite(d))) bad(file, name + strf("density %g", d));
  for (const float t : g.temperature)
    if (!(t >= 0 && t <= 1e5f)) bad(file, name + strf("temperature %g K", t));
  check_transform(g.to_local, file, name);
}
void check_media(const Scene& s, const std::string& file) {
  for (const Material& m : s.materials)
    for (const uint32_t medium : {m.inside, m.outside})
      if (medium != Material::kNoMedium && medium >= s.media.size())
        bad(file, "material '" + m.id + "' names a medium that is not there");
  if (s.ambient != kNone && s.ambient >= s.media.size()) bad(file, "the ambient medium is not there");
  for (const VoxelGrid& g : s.grids) check_grid(g, s.media.size(), file);
  for (const Volume& v : s.volumes) {
    if (v.grid >= s.grids.size()) bad(file, "a volume names a grid that is not there");
    if (v.track != kNone && v.track >= s.tracks.size()) bad(file, "a volume moves along a track that is not there");
    check_transform(v.to_world, file, "a volume: ");
  }
}
}  // namespace

bool uses_media(const Scene& s) {
  return s.ambient != kNone || !s.volumes.empty() ||
         std::any_of(s.materials.begin(), s.materials.end(), [](const Material& m) { return m.bounds_medium(); });
}

void check_scene(const Scene& s, const std::string& file) {
  check_media(s, file);
  for (const PropertyMap& m : s.property_maps) check_property_map(m, s.materials.size(), file);
  for (const TemperatureBinding& t : s.temperatures)
    if (t.material >= s.materials.size()) bad(file, "a temperature is of a material that is not there");
  for (const PropertyBinding& b : s.property_bindings)
    if (b.material >= s.materials.size() || b.property_map >= s.property_maps.size())
      bad(file, "a map binding names something that is not there");
  parallel_for(0, s.meshes.size(), 1, [&](size_t begin, size_t end) {
    for (size_t k = begin; k < end; ++k) check_mesh(s.meshes[k], s.materials.size(), file);
  });
  if (s.groups.empty()) bad(file, "there is no root group");
  for (const Primitive& p : s.primitives)
    if (p.material != kNone && p.material >= s.materials.size())
      bad(file, "primitive '" + p.name + "' names a material that is not there");
  for (size_t g = 0; g < s.groups.size(); ++g)
    for (const Placement& p : s.groups[g].placements) {
      const size_t limit = p.kind == TargetKind::mesh    ? s.meshes.size()
                           : p.kind == TargetKind::group ? s.groups.size()
                                                         : s.primitives.size();
      if (p.target >= limit) bad(file, "group '" + s.groups[g].name + "' places something that is not there");
      // Children come after parents, so the hierarchy cannot contain itself.
      if (p.kind == TargetKind::group && p.target <= g)
        bad(file, "group '" + s.groups[g].name + "' places a group that is not below it");
      if (p.material_override != kNone && p.material_override >= s.materials.size())
        bad(file, "a material override is not there");
      if (p.tag != kNone && p.tag >= s.tags.size()) bad(file, "a tag is not there");
      if (p.track != kNone && (p.track >= s.tracks.size() || !s.tracks[p.track].track))
        bad(file, "a motion is not there");
      check_transform(p.to_parent, file, "a placement: ");
    }
  for (const ClassMap& m : s.class_maps) {
    if (m.classes.size() != size_t{m.width} * m.height || m.classes.empty())
      bad(file, "class map '" + m.name + "': size and data disagree");
    for (const uint16_t c : m.classes)
      if (c >= m.materials.size()) bad(file, "class map '" + m.name + strf("': class %u has no material", c));
    for (const uint32_t id : m.materials)
      if (id >= s.materials.size()) bad(file, "class map '" + m.name + "' names a material that is not there");
  }
  for (const MapBinding& b : s.map_bindings)
    if (b.material >= s.materials.size() || b.class_map >= s.class_maps.size())
      bad(file, "a map binding names something that is not there");
}

}  // namespace suite
