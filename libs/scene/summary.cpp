#include "scene/summary.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "base/progress.h"
#include "motion/track.h"
#include "scene/tables.h"

namespace suite {

std::vector<double> flattened_counts(const Scene& s) {
  std::vector<double> groups(s.groups.size(), 0), meshes(s.meshes.size(), 0);
  if (!groups.empty()) groups[0] = 1;
  for (size_t g = 0; g < s.groups.size(); ++g)  // parents come before their children
    for (const Placement& p : s.groups[g].placements) {
      if (p.kind == TargetKind::group) groups[p.target] += groups[g];
      if (p.kind == TargetKind::mesh) meshes[p.target] += groups[g];
    }
  return meshes;
}

std::string MeshTable::summary(const Scene& s) {
  size_t vertices = 0, triangles = 0, bytes = 0;
  double flat = 0;
  const std::vector<double> counts = flattened_counts(s);
  for (size_t i = 0; i < s.meshes.size(); ++i) {
    const Mesh& m = s.meshes[i];
    vertices += m.vertex_count();
    triangles += m.triangle_count();
    flat += counts[i] * static_cast<double>(m.triangle_count());
    bytes += m.bytes();
  }
  return strf("meshes        %zu with %zu vertices, %zu triangles (%s); flattened %s triangles\n", s.meshes.size(),
              vertices, triangles, human_bytes(static_cast<double>(bytes)).c_str(), human_count(flat).c_str());
}

std::string GroupTable::summary(const Scene& s) {
  size_t placements = 0;
  for (const Group& g : s.groups) placements += g.placements.size();
  return strf("placements    %zu in %zu groups\n", placements, s.groups.size());
}

std::string ClassMapTable::summary(const Scene& s) {
  size_t pixels = 0;
  for (const ClassMap& m : s.class_maps) pixels += m.classes.size();
  return s.class_maps.empty() ? "" : strf("class maps    %zu with %zu pixels\n", s.class_maps.size(), pixels);
}

std::string MaterialTable::summary(const Scene& s) {
  std::string out = strf("materials     %zu\n", s.materials.size());
  for (const Material& m : s.materials) {
    out += strf("  %-20s %s", m.id.c_str(), m.surface.model.c_str());
    for (const auto& [name, curve] : m.surface.curves)
      out += curve.is_constant() ? strf("; %s %g", name.c_str(), curve.value().front())
                                 : strf("; %s %g to %g um, outside: %s", name.c_str(), curve.low_um(), curve.high_um(),
                                        to_text(curve.outside()));
    for (const auto& [name, text] : m.surface.texts) out += "; " + name + " " + text;
    if (m.temperature_k > 0) out += strf("; %g K", m.temperature_k);
    out += "\n";
  }
  return out;
}

std::string MediumTable::summary(const Scene& s) {
  if (s.media.empty()) return "";
  std::string out = strf("media         %zu\n", s.media.size());
  for (size_t i = 0; i < s.media.size(); ++i) {
    const Medium& m = s.media[i];
    out += strf("  %-20s absorption %g to %g, scattering %g to %g 1/m%s%s", m.id.c_str(), m.absorption.min(),
                m.absorption.max(), m.scattering.min(), m.scattering.max(), m.phase.model.empty() ? "" : "; ",
                m.phase.model.c_str());
    if (m.temperature_k > 0) out += strf("; %g K", m.temperature_k);
    out += s.ambient == i ? "; ambient\n" : "\n";
  }
  return out;
}

std::string GridTable::summary(const Scene& s) {
  if (s.grids.empty()) return "";
  std::string out = strf("voxel grids   %zu\n", s.grids.size());
  for (const VoxelGrid& g : s.grids) {
    const size_t filled =
        static_cast<size_t>(std::count_if(g.density.begin(), g.density.end(), [](float d) { return d > 0; }));
    out += strf("  %-20s %u x %u x %u cells, %.1f %% filled%s\n", g.name.c_str(), g.cells[0], g.cells[1], g.cells[2],
                100.0 * static_cast<double>(filled) / static_cast<double>(g.size()),
                g.temperature.empty() ? "" : ", temperatures");
  }
  return out;
}

namespace {
// What holds in part of the spectrum or for some time only: a simulation that looks beyond is refused.
std::string coverage_text(const Scene& s) {
  std::string out;
  for (const PropertyMap& m : s.property_maps) {
    if (m.kind == MapKind::cube && !m.wavelength_um.empty())
      out += strf("  cube '%s': %g to %g um, outside: %s\n", m.name.c_str(), m.wavelength_um.front(),
                  m.wavelength_um.back(), to_text(m.outside));
    for (const Curve& c : m.family)
      if (!c.is_constant() && c.outside() == Outside::error) {
        out += strf("  map '%s': a curve from %g to %g um\n", m.name.c_str(), c.low_um(), c.high_um());
        break;
      }
  }
  for (const TemperatureBinding& t : s.temperatures)
    if (!t.spec.times.empty())
      out += strf("  temperatures of '%s': %g to %g s%s\n", s.materials[t.material].id.c_str(), t.spec.times.front(),
                  t.spec.times.back(), t.spec.repeat ? ", repeated" : "");
  for (const SceneTrack& t : s.tracks)
    if (const TimeSpan c = t.track->covered();
        !t.track->absent_outside() && (std::isfinite(c.begin) || std::isfinite(c.end)))
      out += strf("  motion of %s: %g to %g s\n", t.name.c_str(), c.begin, c.end);
  return out.empty() ? "" : "limited to\n" + out;
}
}  // namespace

namespace {
// What a table has to say; without words of its own, how many rows it has.
template <class Table>
std::string table_text(const Scene& s) {
  if constexpr (requires { Table::summary(s); }) return Table::summary(s);
  const size_t count = (s.*Table::rows).size();
  std::string label = Table::name;
  std::replace(label.begin(), label.end(), '_', ' ');
  return count ? strf("%-13s %zu\n", label.c_str(), count) : "";
}

std::set<std::string> features(const Scene& s) {
  std::set<std::string> uses;
  for_each_table([&]<class Table>(Table) {
    if constexpr (requires { Table::feature; })
      if (!(s.*Table::rows).empty()) uses.insert(Table::feature);
  });
  for (const Mesh& m : s.meshes) {
    if (!m.normals.empty()) uses.insert("vertex normals");
    if (!m.uvs.empty()) uses.insert("texture coordinates");
  }
  for (const Material& m : s.materials)
    if (m.temperature_k > 0) uses.insert("temperatures");
  for (const PropertyMap& m : s.property_maps)
    uses.insert(m.kind == MapKind::temperature ? "temperature maps" : "property maps");
  if (uses_media(s)) uses.insert("media");
  if (s.groups.size() > 1) uses.insert("nested groups");
  return uses;
}
}  // namespace

std::string summary_text(const Scene& s) {
  std::string out = strf("scene         %s\n", s.name.c_str());
  if (s.origin.given)
    out += strf("origin        %.9f N %.9f E, %.3f m above WGS84\n", s.origin.latitude_deg, s.origin.longitude_deg,
                s.origin.ellipsoid_height_m);
  if (s.curved) out += "curvature     laid onto WGS84; draped maps lie on the flat plane\n";
  if (!s.bounds.empty())
    out += strf("extent        x %.3f to %.3f, y %.3f to %.3f, z %.3f to %.3f m\n", s.bounds.low.x, s.bounds.high.x,
                s.bounds.low.y, s.bounds.high.y, s.bounds.low.z, s.bounds.high.z);
  for_each_table([&]<class Table>(Table) { out += table_text<Table>(s); });
  out += coverage_text(s) + "uses          ";
  const std::set<std::string> uses = features(s);
  for (const std::string& u : uses) out += (u == *uses.begin() ? "" : ", ") + u;
  return out + "\n";
}

}  // namespace suite
