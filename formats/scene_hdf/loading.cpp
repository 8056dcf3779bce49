// Which parts of a scene a simulation can see. See needs.h.
#include <algorithm>
#include <cmath>

#include "formats/scene_hdf/internal.h"
#include "spectral/planck.h"
#include "sqt/bundle.h"
#include "thermal/models.h"

namespace suite {

namespace {
constexpr double kDark = 1e-9;           // W/(m2 sr um): below this nothing glows
constexpr double kHottestWeather = 450;  // K, what sun and sky may make of a surface
constexpr double kHottestSlab = 1500;    // K, what loads may make of a slab

// Whether a model prefers a direction along the surface, from what is written of it.
bool anisotropic(const ModelSpec& m) {
  if (m.bundle) return !m.bundle->info().function.isotropic;
  const auto rough = m.numbers.find("roughness_y");
  return m.model == "sqt" || (rough != m.numbers.end() && rough->second > 0);
}
}  // namespace

bool Loading::sees(double low_um, double high_um) const {
  const auto overlaps = [&](const auto& w) { return low_um <= w[1] && high_um >= w[0]; };
  return needs.windows_um.empty() || needs.temperatures ||
         std::any_of(needs.windows_um.begin(), needs.windows_um.end(), overlaps);
}

bool Loading::glows(double kelvin) const {
  // Radiance rises with wavelength as long as a blackbody is dark on its short side.
  const auto shows = [&](const auto& w) {
    return planck_radiance(w[1], kelvin) > kDark || planck_radiance(w[0], kelvin) > kDark;
  };
  return needs.windows_um.empty() || needs.temperatures ||
         std::any_of(needs.windows_um.begin(), needs.windows_um.end(), shows);
}

std::pair<size_t, size_t> Loading::channels(const std::vector<double>& um) const {
  if (needs.windows_um.empty() || um.empty()) return {0, um.size()};
  double low = INFINITY, high = 0;
  for (const auto& w : needs.windows_um) low = std::min(low, w[0]), high = std::max(high, w[1]);
  const auto above = std::upper_bound(um.begin(), um.end(), low), from = above == um.begin() ? above : above - 1;
  const auto last = std::lower_bound(um.begin(), um.end(), high);
  const auto to = last == um.end() ? last : last + 1;
  return {static_cast<size_t>(from - um.begin()), static_cast<size_t>(std::max(to, from + 1) - um.begin())};
}

Curve Loading::within(const Curve& curve) const {
  if (curve.is_constant() || needs.windows_um.empty()) return curve;
  // One that is too short is kept as it is, for the message that says from where to where it goes.
  for (const auto& w : needs.windows_um)
    if (!curve.covers(w[0], w[1])) return curve;
  const auto [from, to] = channels(curve.wavelength_um());
  if (to - from == curve.value().size()) return curve;
  const auto part = [&](const std::vector<double>& v) {
    return std::vector<double>(v.begin() + static_cast<std::ptrdiff_t>(from),
                               v.begin() + static_cast<std::ptrdiff_t>(to));
  };
  // Wholly beside the windows: the rule outside the range decides, which the nearest point keeps.
  return Curve(part(curve.wavelength_um()), part(curve.value()), curve.outside());
}

LoadRow& Loading::row(const char* feature) {
  for (LoadRow& r : report.rows)
    if (r.feature == feature) return r;
  report.rows.push_back({feature, {}, 0, 0});
  // Rows stand for the whole load.
  report.rows.reserve(16);
  return report.rows.back();
}

std::vector<bool> meshes_with_uvs(const Scene& s, Loading& loading) {
  std::vector<bool> asks(s.materials.size(), false);
  for (size_t m = 0; m < asks.size(); ++m) asks[m] = anisotropic(s.materials[m].surface);
  // Maps, and what leads to a material with one; binding to binding until nothing is added.
  for (const PropertyBinding& b : s.property_bindings)
    if (s.property_maps[b.property_map].projection == Projection::uv && b.material < asks.size())
      asks[b.material] = true;
  for (const MapBinding& b : s.map_bindings)
    if (b.class_map < s.class_maps.size() && b.material < asks.size() &&
        s.class_maps[b.class_map].projection == Projection::uv)
      asks[b.material] = true;
  const auto any_of = [&](const std::vector<uint32_t>& ids) {
    return std::any_of(ids.begin(), ids.end(), [&](uint32_t id) { return id < asks.size() && asks[id]; });
  };
  for (const PropertyBinding& b : s.property_bindings)
    if (b.material < asks.size() && any_of(s.property_maps[b.property_map].materials)) asks[b.material] = true;
  for (const MapBinding& b : s.map_bindings)
    if (b.class_map < s.class_maps.size() && b.material < asks.size() && any_of(s.class_maps[b.class_map].materials))
      asks[b.material] = true;
  bool all = loading.needs.windows_um.empty();
  for (const Group& g : s.groups)
    for (const Placement& p : g.placements)
      all = all || (p.material_override < asks.size() && asks[p.material_override]);
  for (const Schedule& one : s.schedules) all = all || any_of(one.material);
  std::vector<bool> with(s.meshes.size(), all);
  for (size_t k = 0; k < s.meshes.size(); ++k)
    for (const Part& p : s.meshes[k].parts)
      if (p.material < asks.size() && asks[p.material]) with[k] = true;
  const bool any = std::find(with.begin(), with.end(), true) != with.end();
  loading.row("texture coordinates").why =
      loading.needs.windows_um.empty() ? "no sensor said what it needs"
      : any                            ? "for maps placed by UV and models with a direction along the surface"
                                       : "no map is placed by UV and no model has a direction along the surface";
  return with;
}

namespace {
void drop_temperatures(Scene& s, Loading& loading) {
  double hottest = 0;
  for (const Material& m : s.materials) hottest = std::max(hottest, m.temperature_k);
  for (const TemperatureBinding& t : s.temperatures) {
    hottest = std::max(hottest, hottest_given(t.spec));
    if (t.spec.model == "slab") hottest = std::max(hottest, kHottestSlab), loading.conducts = true;
    if (t.spec.model == "heat") hottest = std::max(hottest, kHottestWeather), loading.conducts = true;
  }
  for (const PropertyMap& m : s.property_maps)
    if (m.kind == MapKind::temperature) hottest = INFINITY;  // some map was found to glow
  LoadRow &heat = loading.row("temperatures"), &layers = loading.row("layers");
  for (const Material& m : s.materials)
    heat.stored += m.temperature_k > 0 ? 8 : 0, layers.stored += 8 * m.thermal.size();
  const bool glow = std::isinf(hottest) || loading.glows(hottest);
  heat.why = loading.needs.windows_um.empty() ? "no sensor said what it needs"
             : loading.needs.temperatures     ? "a sensor collects them as truth"
             : glow                           ? "they glow in some window"
                                              : "they glow in no window";
  layers.why = glow && loading.conducts ? "a temperature model conducts heat" : "no temperature model conducts heat";
  if (loading.needs.windows_um.empty()) layers.why = heat.why;
  if (glow) {
    for (const Material& m : s.materials) heat.read += m.temperature_k > 0 ? 8 : 0;
    for (const TemperatureBinding& t : s.temperatures) heat.read += 16 * t.spec.times.size();
  } else {
    for (Material& m : s.materials) m.temperature_k = 0;
    s.temperatures.clear();
  }
  if (loading.needs.windows_um.empty() || (glow && loading.conducts)) {
    layers.read = layers.stored;
    return;
  }
  for (Material& m : s.materials) m.thermal.clear();
  for (TemperatureBinding& t : s.temperatures)
    if (t.spec.model != "slab" && t.spec.model != "heat") t.spec.layers.clear();
}
}  // namespace

void drop_unseen(Scene& s, Loading& loading) {
  drop_temperatures(s, loading);
  LoadRow& curves = loading.row("curves");
  curves.why = loading.needs.windows_um.empty() ? "no sensor said what it needs" : "points within the spectral windows";
  loading.row("cube channels").why =
      loading.needs.windows_um.empty() ? "no sensor said what it needs" : "channels within the spectral windows";
  const auto clip = [&](Curve& c) {
    curves.stored += 16 * c.value().size();
    c = loading.within(c);
    curves.read += 16 * c.value().size();
  };
  for (Material& m : s.materials)
    for (auto& [name, curve] : m.surface.curves) clip(curve);
  for (PropertyMap& m : s.property_maps)
    for (Curve& curve : m.family) clip(curve);
}

}  // namespace suite
