// Materials and the maps that vary them: names become numbers; what a curve, a class or a map cannot be is filed.
#include "optics/stored_range.h"
#include "scene/baker.h"
#include "spectral/wavelength.h"

namespace suite {

uint32_t Baker::material_id(const Reference& ref) {
  if (const auto found = material_ids_.find(ref.name); found != material_ids_.end()) {
    used_materials_.insert(ref.name);
    return found->second;
  }
  const auto known = names_of(draft_.materials, [](const DraftMaterial& m) { return m.material.id; });
  add("SP102", ref.where, "unknown material '" + ref.name + "'; " + name_hint(ref.name, known));
  return kNone;
}

void Baker::check_coverage(const DraftMaterial& m) {
  const auto check = [&](const std::string& what, const Curve& curve) {
    if (!curve.is_constant() && curve.low_um() > kLongestWave)
      add("SP110", m.where,
          strf("material '%s': %s is given from %s", m.material.id.c_str(), what.c_str(), curve.range_text().c_str()));
    for (const SpectralWindow& w : draft_.windows)
      if (!curve.covers(w.low_um, w.high_um))
        add("SP104", m.where,
            strf("material '%s': %s is given from %s, the window is %g to %g um", m.material.id.c_str(), what.c_str(),
                 curve.range_text().c_str(), w.low_um, w.high_um));
  };
  for (const auto& [name, curve] : m.material.surface.curves) check(name, curve);
  for (const SpectralWindow& w : draft_.windows)
    if (const std::string text = beyond_stored(m.material.surface, w.low_um, w.high_um); !text.empty())
      add("SP104", m.where,
          strf("material '%s': %s, the window is %g to %g um", m.material.id.c_str(), text.c_str(), w.low_um,
               w.high_um));
  for (const DraftPropertyMap& map : draft_.property_maps)
    for (const Reference& r : m.property_maps)
      if (r.name == map.map.name) check_map_coverage(m, map.map, check);
}

// Beyond the channels of a cube its rule decides, as beyond the points of a curve.
void Baker::check_map_coverage(const DraftMaterial& m, const PropertyMap& map,
                               const std::function<void(const std::string&, const Curve&)>& check) {
  for (const Curve& curve : map.family) check("a curve of map '" + map.name + "'", curve);
  if (map.kind != MapKind::cube || map.outside != Outside::error || map.wavelength_um.empty()) return;
  for (const SpectralWindow& w : draft_.windows)
    if (w.low_um < map.wavelength_um.front() || w.high_um > map.wavelength_um.back())
      add("SP104", m.where,
          strf("material '%s': cube '%s' has channels from %g to %g um, the window is %g to %g um",
               m.material.id.c_str(), map.name.c_str(), map.wavelength_um.front(), map.wavelength_um.back(), w.low_um,
               w.high_um));
}

// A table that ends must hold for the whole time that is looked at.
void Baker::check_times(const DraftMaterial& m) {
  if (!draft_.times || !m.temperature || m.temperature->times.empty() || m.temperature->repeat) return;
  const std::vector<double>& t = m.temperature->times;
  if (draft_.times->begin < t.front() || draft_.times->end > t.back())
    add("SP106", m.where,
        strf("material '%s': temperatures are given from %g to %g s, 'times_s' is %g to %g s", m.material.id.c_str(),
             t.front(), t.back(), draft_.times->begin, draft_.times->end));
}

// What a map puts in place of the reflectance must leave room for the transmittance, and the other way round.
void Baker::check_map_energy(const DraftMaterial& m, const PropertyMap& map, const Where& where) {
  const bool reflects = map.parameter == "reflectance";
  if (!reflects && map.parameter != "transmittance") return;
  const auto other = m.material.surface.curves.find(reflects ? "transmittance" : "reflectance");
  if (other == m.material.surface.curves.end()) return;
  const auto too_much = [&](double um, double value) {
    if (!other->second.covers(um, um) || value + other->second.at(um) <= 1 + 1e-6) return false;
    add("SP105", where,
        strf("material '%s': map '%s' has %s %g, with %s %g at %g um", m.material.id.c_str(), map.name.c_str(),
             map.parameter.c_str(), value, other->first.c_str(), other->second.at(um), um));
    return true;
  };
  if (map.kind == MapKind::cube) {
    std::vector<float> highest(map.channels, 0);
    for (size_t i = 0; i < map.values.size(); ++i)
      highest[i % map.channels] = std::max(highest[i % map.channels], map.values[i]);
    for (size_t c = 0; c < highest.size(); ++c)
      if (too_much(map.wavelength_um[c], highest[c])) return;
  }
  for (const Curve& curve : map.family)
    for (size_t k = 0; k < curve.value().size(); ++k)
      if (curve.is_constant() ? too_much(1, curve.value()[0]) : too_much(curve.wavelength_um()[k], curve.value()[k]))
        return;
}

void Baker::materials() {
  for (const DraftMaterial& m : draft_.materials) {
    material_ids_[m.material.id] = static_cast<uint32_t>(scene_.materials.size());
    scene_.materials.push_back(m.material);
    if (m.temperature) scene_.temperatures.push_back({material_ids_[m.material.id], *m.temperature});
    if (m.has_model) check_coverage(m);
    check_times(m);
    // The sum over both sides' shares must stay below 1 wherever either curve has a knot.
    const auto& curves = m.material.surface.curves;
    const auto rho = curves.find("reflectance"), tau = curves.find("transmittance");
    if (rho == curves.end() || tau == curves.end()) continue;
    for (const Curve* c : {&rho->second, &tau->second})
      for (const double w : c->wavelength_um())
        if (rho->second.covers(w, w) && tau->second.covers(w, w) && rho->second.at(w) + tau->second.at(w) > 1 + 1e-9) {
          add("SP105", m.where,
              strf("material '%s': reflectance %g + transmittance %g at %g um", m.material.id.c_str(),
                   rho->second.at(w), tau->second.at(w), w));
          goto next;
        }
  next:;
  }
}

// Where a map says nothing, a material without a model of its own is as the map's first, and as warm unless it says
// otherwise.
void Baker::take_surface(size_t m, const DraftMaterial& first) {
  const DraftMaterial& own = draft_.materials[m];
  scene_.materials[m].surface = first.material.surface;
  if (own.temperature || own.material.temperature_k > 0) return;
  scene_.materials[m].temperature_k = first.material.temperature_k;
  if (first.temperature) scene_.temperatures.push_back({static_cast<uint32_t>(m), *first.temperature});
}

void Baker::class_maps() {
  for (const DraftClassMap& d : draft_.class_maps) {
    ClassMap map = d.map;
    map_ids_[map.name] = static_cast<uint32_t>(scene_.class_maps.size());
    // Renumber the raster's values to 0, 1, ... in the order of the values.
    std::map<uint16_t, uint16_t> index;
    for (const auto& [value, ref] : d.materials) {
      index[value] = static_cast<uint16_t>(map.materials.size());
      map.materials.push_back(material_id(ref));
    }
    std::map<uint16_t, size_t> missing;
    for (uint16_t& c : map.classes) {
      const auto found = index.find(c);
      if (found == index.end())
        ++missing[c];
      else
        c = found->second;
    }
    for (const auto& [value, count] : missing)
      report_.add("SP502", map.name, {d.where, strf("class %u (%zu pixels) has no material", value, count)});
    scene_.class_maps.push_back(std::move(map));
  }
  for (size_t m = 0; m < draft_.materials.size(); ++m) {
    const DraftMaterial& d = draft_.materials[m];
    if (!d.map.given()) continue;
    const auto found = map_ids_.find(d.map.name);
    if (found == map_ids_.end() && draft_.failed_maps.count(d.map.name)) continue;
    if (found == map_ids_.end()) {
      const auto known = names_of(draft_.class_maps, [](const DraftClassMap& c) { return c.map.name; });
      add("SP501", d.map.where, "unknown map '" + d.map.name + "'; " + name_hint(d.map.name, known));
      continue;
    }
    used_maps_.insert(d.map.name);
    const ClassMap& map = scene_.class_maps[found->second];
    scene_.map_bindings.push_back({static_cast<uint32_t>(m), found->second});
    for (const uint32_t id : map.materials)
      if (id == m || (id != kNone && draft_.materials[id].map.given()))
        add("SP501", d.map.where,
            "map '" + d.map.name + "' leads to material '" + draft_.materials[id].material.id +
                "', which a map decides again");
    if (!d.has_model && !map.materials.empty() && map.materials.front() != kNone)
      take_surface(m, draft_.materials[map.materials.front()]);
  }
}

// A mixture puts whole materials side by side, which cannot be mixtures or bend the surface themselves.
void Baker::check_parts(const PropertyMap& map, const Where& where) {
  for (const uint32_t id : map.materials) {
    if (id == kNone) continue;
    const DraftMaterial& part = draft_.materials[id];
    bool fits = part.has_model && !part.map.given();
    for (const Reference& r : part.property_maps)
      for (const DraftPropertyMap& m : draft_.property_maps)
        if (m.map.name == r.name && (m.map.kind == MapKind::mixture || m.map.kind >= MapKind::bump)) fits = false;
    if (!fits)
      add("SP501", where,
          "material '" + part.material.id + "' cannot be part of mixture '" + map.name +
              "': a part has a model and at most curve index, texture, cube and temperature maps");
  }
}

void Baker::property_maps() {
  std::map<std::string, uint32_t> ids;
  for (const DraftPropertyMap& d : draft_.property_maps) {
    PropertyMap map = d.map;
    for (const Reference& r : d.materials) map.materials.push_back(material_id(r));
    ids[map.name] = static_cast<uint32_t>(scene_.property_maps.size());
    scene_.property_maps.push_back(std::move(map));
  }
  for (size_t m = 0; m < draft_.materials.size(); ++m) {
    std::set<MapKind> kinds;
    for (const Reference& r : draft_.materials[m].property_maps) {
      const auto found = ids.find(r.name);
      if (found == ids.end() && draft_.failed_maps.count(r.name)) continue;
      if (found == ids.end()) {
        add("SP501", r.where,
            "unknown map '" + r.name + "'; " +
                name_hint(r.name, names_of(draft_.property_maps, [](const auto& p) { return p.map.name; })));
        continue;
      }
      used_maps_.insert(r.name);
      const PropertyMap& map = scene_.property_maps[found->second];
      check_parts(map, r.where);
      check_map_energy(draft_.materials[m], map, r.where);
      if (!kinds.insert(map.kind).second)
        add("SP501", r.where,
            "material '" + draft_.materials[m].material.id + "' has two maps of the kind of '" + r.name + "'");
      if (!map.parameter.empty() && !scene_.materials[m].surface.curves.count(map.parameter))
        add("SP501", r.where,
            "the model of material '" + draft_.materials[m].material.id + "' has no curve '" + map.parameter +
                "' for map '" + r.name + "'");
      scene_.property_bindings.push_back({static_cast<uint32_t>(m), found->second});
    }
  }
}

}  // namespace suite
