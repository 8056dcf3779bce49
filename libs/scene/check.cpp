// What must hold of a scene that was read from a file.
#include <algorithm>
#include <bit>
#include <cmath>

#include "base/parallel.h"
#include "scene/tables.h"

namespace suite {

namespace {

[[noreturn]] void bad(const std::string& file, const std::string& what) {
  throw Error(Where{file, 0, 0, {}, -1}, what, "prepare the scene again");
}

void check_transform(const Affine3& t, const std::string& title, const SceneFault& fault) {
  for (const double a : t.a)
    if (!std::isfinite(a)) fault(title + ": the transform is not finite");
  if (!finite(t.b) || t.determinant() == 0) fault(title + ": the transform is not finite or flattens its target");
}

// Holds indices to the sizes of the tables they lead into.
struct Bounds {
  const Scene& scene;
  const SceneFault& fault;
  const std::function<std::string()>& title;
  template <class Table>
  void must(uint32_t index) const {
    if (index >= (scene.*Table::rows).size()) fault(title() + " names a " + Table::one + " that is not there");
  }
  template <class Table>
  void may(uint32_t index) const {
    if (index != kNone) must<Table>(index);
  }
};

template <class Table>
void check_table(const Scene& s, const SceneFault& fault) {
  const auto& rows = s.*Table::rows;
  const auto check = [&](size_t begin, size_t end) {
    for (size_t k = begin; k < end; ++k) {
      const std::function<std::string()> title = [&] { return Table::title(rows[k], k); };
      if constexpr (requires(const Bounds& bounds) { Table::indices(rows[k], bounds); })
        Table::indices(rows[k], Bounds{s, fault, title});
      if constexpr (requires { Table::check(s, rows[k], k, fault); }) Table::check(s, rows[k], k, fault);
    }
  };
  if constexpr (requires { Table::heavy; })
    parallel_for(0, rows.size(), 1, check);
  else
    check(0, rows.size());
}

}  // namespace

namespace {
void check_arrays(const Mesh& m, const SceneFault& fault) {
  const std::string name = "mesh '" + m.name + "': ";
  if (m.positions.size() % 3 != 1 && !m.positions.empty())
    fault(name + "positions are not 3 floats a vertex and a pad");
  if (m.indices.size() % 3 != 0) fault(name + "indices are not 3 a triangle");
  const size_t n = m.vertex_count();
  if (!m.normals.empty() && m.normals.size() != n) fault(name + "as many normals as vertices are needed");
  if (!m.uvs.empty() && m.uvs.size() != 2 * n) fault(name + "two UVs a vertex are needed");
  // Reductions first: they vectorise, and a file is nearly always right.
  uint32_t largest = 0, faulty = 0;
  for (const uint32_t i : m.indices) largest = std::max(largest, i);
  if (!m.indices.empty() && largest >= n) fault(name + strf("vertex index %u of %zu", largest, n));
  for (const float p : std::span(m.positions.data(), 3 * n))
    faulty |= (std::bit_cast<uint32_t>(p) & 0x7f800000u) == 0x7f800000u;
  if (faulty) fault(name + "a coordinate is not finite");
  if (!m.stored) return;
  const Box3 box = box_of_positions(m), said = m.stored->box;
  if (!(box.low == said.low && box.high == said.high)) fault(name + "it is not as large as was said of it");
}
}  // namespace

void check_arrays(const Mesh& m, const std::string& file) {
  check_arrays(m, [&](const std::string& what) { bad(file, what); });
}

void MeshTable::check(const Scene&, const Mesh& m, size_t, const SceneFault& fault) {
  if (!m.stored) check_arrays(m, fault);
  size_t next = 0;
  for (const Part& p : m.parts) {
    if (p.first_triangle != next) fault("mesh '" + m.name + "': parts do not cover the triangles in order");
    next += p.triangle_count;
  }
  if (next != m.triangle_count()) fault("mesh '" + m.name + "': parts do not cover the triangles");
}

void GroupTable::check(const Scene&, const Group& g, size_t k, const SceneFault& fault) {
  for (const Placement& p : g.placements) {
    // Children come after parents, so the hierarchy cannot contain itself.
    if (p.kind == TargetKind::group && p.target <= k)
      fault("group '" + g.name + "' places a group that is not below it");
    check_transform(p.to_parent, "a placement", fault);
  }
}

void TrackTable::check(const Scene&, const SceneTrack& t, size_t, const SceneFault& fault) {
  if (!t.track) fault("the motion of " + t.name + " is not there");
}

void ScheduleTable::check(const Scene&, const Schedule& s, size_t, const SceneFault& fault) {
  if (!(s.life.begin < s.life.end)) fault(title(s, 0) + ": it ends before it begins");
  if (const std::string why = s.when.fault(); !why.empty()) fault(title(s, 0) + ": " + why);
  if (s.there.size() != s.when.times.size() || s.material.size() != s.when.times.size())
    fault(title(s, 0) + ": times and what holds from then on disagree");
}

void ClassMapTable::check(const Scene&, const ClassMap& m, size_t, const SceneFault& fault) {
  if (m.classes.size() != size_t{m.width} * m.height || m.classes.empty())
    fault("class map '" + m.name + "': size and data disagree");
  for (const uint16_t c : m.classes)
    if (c >= m.materials.size()) fault("class map '" + m.name + strf("': class %u has no material", c));
}

void PropertyMapTable::check(const Scene&, const PropertyMap& m, size_t, const SceneFault& fault) {
  const std::string name = "map '" + m.name + "': ";
  if (m.channels == 0 || m.values.empty() || m.values.size() != size_t{m.width} * m.height * m.channels)
    fault(name + "size and data disagree");
  const size_t expected = m.kind == MapKind::mixture  ? m.materials.size()
                          : m.kind == MapKind::cube   ? m.wavelength_um.size()
                          : m.kind == MapKind::normal ? 3
                                                      : 1;
  if (m.channels != expected) fault(name + strf("%u channels, %zu are needed", m.channels, expected));
  for (size_t k = 0; k < m.wavelength_um.size(); ++k)
    if (!(m.wavelength_um[k] > (k ? m.wavelength_um[k - 1] : 0)) || !std::isfinite(m.wavelength_um[k]))
      fault(name + "wavelengths do not ascend");
  float low = INFINITY, high = -INFINITY;
  const bool may_miss = m.kind != MapKind::bump && m.kind != MapKind::normal;
  for (size_t i = 0; i < m.values.size(); ++i) {
    const float v = m.values[i];
    if (may_miss && std::isnan(v) && std::isnan(m.values[i - i % m.channels])) continue;  // a gap
    if (!std::isfinite(v)) fault(name + "a value is not finite");
    low = std::min(low, v), high = std::max(high, v);
  }
  const bool share = m.kind == MapKind::mixture || m.kind == MapKind::cube || m.kind == MapKind::opacity;
  if (share && !(low >= 0 && high <= 1.0001f)) fault(name + strf("values from %g to %g, 0 to 1 are needed", low, high));
  if (m.kind == MapKind::temperature && !(low >= 1 && high <= 1e5f))
    fault(name + strf("temperatures from %g to %g K", low, high));
  if (m.kind == MapKind::curve_index && !(low >= 0 && high < static_cast<float>(m.family.size())))
    fault(name + strf("curve %g of %zu", high, m.family.size()));
}

void GridTable::check(const Scene&, const VoxelGrid& g, size_t, const SceneFault& fault) {
  const std::string name = "voxel grid '" + g.name + "': ";
  const size_t n = g.size();
  if (n == 0 || g.density.size() != n || (!g.kind.empty() && g.kind.size() != n) ||
      (!g.temperature.empty() && g.temperature.size() != n))
    fault(name + "size and data disagree");
  if (g.media.empty()) fault(name + "has no medium");
  for (const uint8_t k : g.kind)
    if (k >= g.media.size()) fault(name + strf("kind %u of %zu", k, g.media.size()));
  for (const float d : g.density)
    if (!(d >= 0 && std::isfinite(d))) fault(name + strf("density %g", d));
  for (const float t : g.temperature)
    if (!(t >= 0 && t <= 1e5f)) fault(name + strf("temperature %g K", t));
  check_transform(g.to_local, title(g, 0), fault);
}

void VolumeTable::check(const Scene&, const Volume& v, size_t, const SceneFault& fault) {
  check_transform(v.to_world, "a volume", fault);
}

void check_scene(const Scene& s, const std::string& file) {
  const SceneFault fault = [&](const std::string& what) { bad(file, what); };
  if (s.groups.empty()) fault("there is no root group");
  if (s.ambient != kNone && s.ambient >= s.media.size()) fault("the ambient medium is not there");
  for_each_table([&]<class Table>(Table) { check_table<Table>(s, fault); });
}

}  // namespace suite
