#include "surface/optics.h"

#include <algorithm>
#include <cmath>

#include "air/air_media.h"
#include "optics/interface.h"
#include "spectral/planck.h"
#include "thermal/models.h"

namespace suite {

namespace {

// The temperatures a map or a model can give, so that a table covers them.
void widen(double& low, double& high, double kelvin) {
  low = std::min(low, kelvin);
  high = std::max(high, kelvin);
}

void range_of(const TemperatureSpec& spec, double& low, double& high) {
  if (!spec.kelvins.empty())
    for (const double k : spec.kelvins) widen(low, high, k);
  else if (spec.model == "constant")
    widen(low, high, spec.numbers.at("kelvin"));
  else
    widen(low, high, 2), widen(low, high, 2000);  // what a simulated slab may reach
}

// low, high: of the temperature model, if there is one.
std::shared_ptr<const BlackbodyTable> table_for(const PropertyMap* map, double low, double high, double constant_k,
                                                const SpectralState& state) {
  if (map)
    for (const float k : map->values) widen(low, high, double{k});
  if (constant_k > 0) widen(low, high, constant_k);
  return std::make_shared<BlackbodyTable>(state.bins, low, high);
}

std::unique_ptr<const TemperatureField> field_for(const TemperatureSpec& spec, const LoadsAt& loads) {
  std::shared_ptr<const TemperatureModel> model = make_temperature_model(spec);
  if (model->needs_loads() && !loads)
    throw Error(
        "temperature model '" + spec.model + "' needs the loads of its surface, which nothing here gives",
        "give the simulation a `heat:` and a `weather:`, or the material a constant, tabulated or mapped temperature");
  return field_of(std::move(model), loads);
}

// The fault, naming the material once.
Error of_material(const Error& e, const std::string& material) {
  const std::string name = "material '" + material + "': ";
  return Error(e.where(), e.message().starts_with(name) ? e.message() : name + e.message(), e.hint(), e.code());
}

// Error: naming the material.
std::unique_ptr<SolvedField> solved_field(const TemperatureSpec& spec, const std::string& material, double begin,
                                          double end) {
  try {
    return std::make_unique<SolvedField>(spec, begin, end);
  } catch (const Error& e) {
    throw of_material(e, material);
  }
}

// Whether what the model asks for is still to be found.
bool waits(const TemperatureSpec& spec, const Heating& heating) {
  return heating.pending && spec.loads.empty() && make_temperature_model(spec)->needs_loads();
}

// Every curve of the family that the map uses, in place of one of the model's.
std::vector<std::unique_ptr<const ScatterModel>> bake_family(const PropertyMap& map, const ModelSpec& model,
                                                             const SpectralState& state) {
  std::vector<std::unique_ptr<const ScatterModel>> variants(map.family.size());
  std::vector<bool> seen(map.family.size(), false);
  for (const float v : map.values) seen[static_cast<size_t>(v)] = true;
  ModelSpec spec = model;
  for (size_t k = 0; k < variants.size(); ++k) {
    if (!seen[k]) continue;
    spec.curves[map.parameter] = map.family[k];
    check_model(spec);
    variants[k] = bake(spec, state);
  }
  return variants;
}

}  // namespace

namespace {
// Every bin takes the index of its knot.
void take_index_of_knots(BakedMedium& m, const SpectralState& state) {
  const std::vector<int> knot_of_bin = state.knot_of_bin();
  const std::vector<float> own = m.index_squared;
  for (size_t i = 0; i < own.size(); ++i) {
    m.index_squared[i] = own[state.knots[static_cast<size_t>(knot_of_bin[i])]];
    if (!m.blackbody.empty()) m.blackbody[i] *= m.index_squared[i] / own[i];
  }
}
}  // namespace

Optics::Optics(const Scene& scene, SpectralState state, const std::vector<bool>& used, const Heating& heating,
               TimeSpan window, std::shared_ptr<const AirSpec> air)
    : state_(std::move(state)), window_(window) {
  if (air && air->scattering == AirScattering::traced) traced_ = air;
  // Places in the air are drawn by what its light does at the knots.
  const bool lit_air = air && air->scattering == AirScattering::diffuse && air->adjacency;
  if (uses_media(scene) || traced_) bake_media(scene, used);
  bake_all(scene, used, heating);
  if (state_.knots.size() > 1 && !spectral_flights_ && !lit_air && one_shape()) {
    state_.knots.erase(state_.knots.begin() + 1, state_.knots.end());
    bake_all(scene, used, heating);
    if (!media_.empty()) bake_media(scene, used);
  }
  if (media_.empty()) bake_clear(scene, used, 0, clear_);
  settle_indices(scene);
}

// Clear matter of interfaces that name no medium; its numbers begin with `first`.
void Optics::bake_clear(const Scene& scene, const std::vector<bool>& used, uint32_t first,
                        std::vector<BakedMedium>& into) {
  behind_.clear();
  for (size_t i = 0; i < scene.materials.size(); ++i) {
    const Material& m = scene.materials[i];
    behind_.push_back(m.inside);
    if (m.bounds_medium() || !is_interface(m.surface) || !(used.empty() || used[i])) continue;
    const Curve& index = m.surface.curves.at("index");
    const bool nothing = index.min() == 1 && index.max() == 1;
    if (nothing || !index.covers(state_.low_um, state_.high_um)) continue;  // that the material itself reports
    Medium clear;
    clear.id = "clear matter of '" + m.id + "'";
    clear.index = index;
    behind_.back() = first++;
    into.emplace_back(clear, state_);
  }
}

// A smooth interface bends all wavelengths of a knot alike: radiance that it passes is scaled by the squared index of
// the knot, and so must be what matter beside it emits. Rough ones scale each bin by its own.
void Optics::settle_indices(const Scene& scene) {
  std::vector<bool> smooth(std::max(media_.size(), clear_.size()));
  for (size_t i = 0; i < materials_.size(); ++i) {
    const ScatterModel* const model = materials_[i].model;
    if (!model || !model->has_delta() || model->opaque()) continue;
    for (const uint32_t medium : {behind_[i], scene.materials[i].outside})
      if (medium != kNone) smooth[medium] = true;
  }
  for (size_t m = 0; m < smooth.size(); ++m)
    if (smooth[m]) take_index_of_knots((media_.empty() ? clear_ : media_)[m], state_);
}

// Mixed materials change their shape with wavelength wherever the shares of their parts do.
bool Optics::one_shape() const {
  return std::all_of(materials_.begin(), materials_.end(), [](const BakedMaterial& m) {
    if (m.model && !m.model->spectrally_uniform_shape()) return false;
    if (!m.maps) return true;
    const auto uniform = [](const auto& v) { return !v || v->spectrally_uniform_shape(); };
    if (m.maps->mixture || !std::all_of(m.maps->variants.begin(), m.maps->variants.end(), uniform)) return false;
    return !m.maps->cube || m.maps->cube->one_shape();
  });
}

void Optics::bake_media(const Scene& scene, const std::vector<bool>& used) {
  const auto bake_them = [&] {
    media_.clear();
    for (const Medium& m : scene.media) {
      try {
        media_.emplace_back(m, state_);
      } catch (const Error& e) {
        throw Error(e.where(), "medium '" + m.id + "': " + e.message(), e.hint(), e.code());
      }
    }
    bake_clear(scene, used, static_cast<uint32_t>(media_.size()), media_);
    if (!traced_) return;
    const auto column = std::make_shared<const AirColumn>(bake_column(*traced_, state_));
    air_ = {column->shells, static_cast<uint32_t>(media_.size())};
    for (BakedMedium& m : air_media(column, state_)) media_.push_back(std::move(m));
  };
  bake_them();
  const size_t before = state_.knots.size();
  for (const BakedMedium& m : media_) {
    spectral_flights_ = spectral_flights_ || !m.uniform();
    const auto [least, most] = std::minmax_element(m.scattering.begin(), m.scattering.end());
    if (*least == *most || before == 1) continue;
    for (const auto bin : {least, most}) {
      const size_t b = static_cast<size_t>(bin - m.scattering.begin());
      if (state_.knots.size() < kMaxKnots &&
          std::find(state_.knots.begin(), state_.knots.end(), b) == state_.knots.end())
        state_.knots.push_back(b);
    }
  }
  if (state_.knots.size() != before) bake_them();
}

void Optics::bake_all(const Scene& scene, const std::vector<bool>& used, const Heating& heating) {
  materials_.clear();
  materials_.resize(scene.materials.size());
  const auto wanted = [&](size_t i) { return used.empty() || used[i]; };
  for (size_t i = 0; i < materials_.size(); ++i) {
    if (!wanted(i) || scene.materials[i].surface.model.empty()) continue;  // empty: a name that a map decides
    try {
      bake_one(scene, i, heating);
    } catch (const Error& e) {
      throw of_material(e, scene.materials[i].id);
    }
  }
  // Parts of mixtures exist now; what they need, the mixture needs.
  for (const PropertyBinding& b : scene.property_bindings) {
    const PropertyMap& map = scene.property_maps[b.property_map];
    if (map.kind != MapKind::mixture || !materials_[b.material].maps) continue;
    MaterialMaps& maps = *materials_[b.material].maps;
    for (const uint32_t id : map.materials) {
      const BakedMaterial& part = materials_[id];
      if (!part.model)
        throw Error("material '" + scene.materials[b.material].id + "': part '" + scene.materials[id].id +
                    "' of its mixture has no model");
      if (part.maps && (part.maps->mixture || part.maps->bends()))
        throw Error("material '" + scene.materials[b.material].id + "': part '" + scene.materials[id].id +
                        "' of its mixture has a mixture, bump or normal map",
                    "parts may have curve index, texture, cube and temperature maps");
      maps.parts.push_back(&part);
      maps.needs_uv |= part.maps && part.maps->needs_uv;
      materials_[b.material].needs_tangent |= part.needs_tangent;
    }
  }
}

namespace {
// What property maps say of a material; whether any says something.
bool bake_maps(const Scene& scene, size_t index, const SpectralState& state, MaterialMaps& maps) {
  const ModelSpec& model = scene.materials[index].surface;
  bool any = false;
  for (const PropertyBinding& b : scene.property_bindings) {
    const PropertyMap& map = scene.property_maps[b.property_map];
    if (b.material != index || map.kind == MapKind::opacity) continue;  // rays decide about holes
    any = true;
    maps.needs_uv |= map.projection == Projection::uv;
    switch (map.kind) {
      case MapKind::mixture:
        maps.mixture = &map;
        break;
      case MapKind::curve_index:
        maps.curve_index = &map;
        maps.variants = bake_family(map, model, state);
        break;
      case MapKind::cube:
        maps.cube = std::make_unique<BakedCube>(map, model, state);
        break;
      case MapKind::temperature:
        maps.temperature = &map;
        break;
      case MapKind::bump:
        maps.bump = &map;
        break;
      case MapKind::normal:
        maps.normal = &map;
        break;
      case MapKind::opacity:
        break;
    }
  }
  return any;
}
}  // namespace

void Optics::bake_one(const Scene& scene, size_t index, const Heating& heating) {
  const Material& m = scene.materials[index];
  BakedMaterial& baked = materials_[index];
  baked.owned = bake(m.surface, state_);
  baked.model = baked.owned.get();
  baked.needs_tangent = !baked.model->isotropic();
  baked.kelvin = m.temperature_k;
  if (m.temperature_k > 0) {
    any_emission_ = true;
    for (const Bin& b : state_.bins)
      baked.blackbody.push_back(
          static_cast<float>(planck_band_radiance(b.low_um, b.high_um, m.temperature_k) / (b.high_um - b.low_um)));
  }
  auto maps = std::make_unique<MaterialMaps>();
  bool any = bake_maps(scene, index, state_, *maps);
  const TemperatureSpec* spec = nullptr;
  for (const TemperatureBinding& t : scene.temperatures)
    if (t.material == index && !t.spec.model.empty() && !waits(t.spec, heating)) spec = &t.spec, any = true;
  if (!any) return;
  maps->constant_k = m.temperature_k, maps->material = static_cast<uint32_t>(index);
  if (maps->temperature || spec) {
    any_emission_ = true;
    double low = INFINITY, high = 0;
    if (spec && !spec->loads.empty()) {
      auto solved = solved_field(*spec, m.id, window_.begin, window_.end);
      low = solved->range()[0], high = solved->range()[1];
      maps->field = std::move(solved);
    } else if (spec && heating.field && make_temperature_model(*spec)->needs_loads()) {
      maps->field = heating.field;
      low = heating.field->range()[0], high = heating.field->range()[1];
    } else if (spec) {
      maps->field = field_for(*spec, heating.loads);
      range_of(*spec, low, high);
    }
    maps->blackbody = table_for(maps->temperature, low, high, m.temperature_k, state_);
  }
  baked.maps = std::move(maps);
}

void check_temperatures(const Scene& scene, double begin, double end) {
  for (const TemperatureBinding& t : scene.temperatures) {
    if (!t.spec.loads.empty() && !t.spec.loads_repeat &&
        (begin < t.spec.load_times.front() || end > t.spec.load_times.back()))
      throw Error(
          strf("material '%s': its loads are given from %g to %g s, %g to %g s are simulated",
               scene.materials[t.material].id.c_str(), t.spec.load_times.front(), t.spec.load_times.back(), begin, end),
          "give a longer table, or 'repeat: true'");
    if (t.spec.times.empty() || t.spec.repeat) continue;
    if (begin < t.spec.times.front() || end > t.spec.times.back())
      throw Error(strf("material '%s': its temperatures are given from %g to %g s, %g to %g s are simulated",
                       scene.materials[t.material].id.c_str(), t.spec.times.front(), t.spec.times.back(), begin, end),
                  "give a longer table, or 'repeat: true'");
  }
}

}  // namespace suite
