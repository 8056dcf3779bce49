// The materials of a scene baked for one spectral state.
#pragma once
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "air/air_spec.h"
#include "air/shells.h"
#include "motion/time_span.h"
#include "optics/models.h"
#include "scene/scene.h"
#include "spectral/state.h"
#include "surface/material_maps.h"

namespace suite {

struct BakedMaterial {
  const ScatterModel* model = nullptr;
  // Whose w times Mueller matrices polarise its emission; null = those of `model`. Mixtures of unequal temperatures.
  const ScatterModel* emitting = nullptr;
  std::vector<float> blackbody;        // Planck radiance at the material's temperature per bin; empty = does not emit
  double kelvin = 0;                   // that temperature; of a mixture's parts their mean by share; 0 = does not emit
  bool needs_tangent = false;          // some direction along the surface is preferred
  std::unique_ptr<MaterialMaps> maps;  // null = the same everywhere
  std::unique_ptr<const ScatterModel> owned;  // what `model` points to, unless it is an Interaction's
};

// What is known of surfaces whose temperature models ask for loads and bring none of their own.
struct Heating {
  // The temperatures themselves, of all that ask for loads; null = they follow from loads.
  std::shared_ptr<const TemperatureField> field = nullptr;
  LoadsAt loads = {};    // what heats them; empty = nothing says so
  bool pending = false;  // it is yet to be found: until then they do not glow
};

// Layers of air among the media of a state: paths are scattered in them.
struct AirLayers {
  Shells shells;
  uint32_t first;  // medium of layer 0; the others follow
};

class Optics {
 public:
  // Bakes the materials for which used[i] is true (all when empty). A temperature model that asks for loads where there
  // are none is an Error unless they are pending. Models that bring their own are solved here once, for the times of
  // the window; the others are asked at hits, with position, normal, instance and triangle. air: real air, whose
  // layers are media like those of the scene where it is traced; null = none. Error naming the material when one cannot
  // be baked. Keeps a reference to the scene.
  Optics(const Scene& scene, SpectralState state, const std::vector<bool>& used = {}, const Heating& heating = {},
         TimeSpan window = {}, std::shared_ptr<const AirSpec> air = nullptr);

  const BakedMaterial& material(uint32_t index) const { return materials_[index]; }
  // The scene's media, all of them where a ray can meet one, else none; then the clear matter of interfaces, where
  // there are others, and layers of air.
  std::span<const BakedMedium> media() const { return media_; }
  // The medium behind a material's surface: that which it names, or, of an interface that names none on either side,
  // clear matter of its index, which it encloses. kNone: none. A number of matter().
  uint32_t medium_behind(uint32_t material) const { return behind_[material]; }
  // Clear matter alone, where nothing else fills space and media() is empty; and either kind, by its number.
  std::span<const BakedMedium> clear() const { return clear_; }
  const BakedMedium& matter(uint32_t medium) const { return media_.empty() ? clear_[medium] : media_[medium]; }
  // Null = no air among them.
  const AirLayers* air() const { return air_ ? &*air_ : nullptr; }
  // False when every medium scatters alike at all wavelengths, so that flights need not be weighed between knots.
  bool spectral_flights() const { return spectral_flights_; }
  bool any_emission() const { return any_emission_; }
  // The state the materials are baked for: the given one, with its knots reduced to the reference when the shape of no
  // material or medium changes with wavelength, because the estimator then is the same at every knot; and with knots
  // added at the bins where media scatter least and most, so that no wavelength's flights are far from all knots'.
  const SpectralState& state() const { return state_; }

 private:
  void bake_all(const Scene& scene, const std::vector<bool>& used, const Heating& heating);
  void bake_one(const Scene& scene, size_t index, const Heating& heating);
  bool one_shape() const;
  void bake_media(const Scene& scene, const std::vector<bool>& used);
  void bake_clear(const Scene& scene, const std::vector<bool>& used, uint32_t first, std::vector<BakedMedium>& into);
  void settle_indices(const Scene& scene);
  SpectralState state_;
  TimeSpan window_;
  std::vector<BakedMaterial> materials_;
  std::vector<BakedMedium> media_, clear_;
  std::vector<uint32_t> behind_;  // per material
  std::shared_ptr<const AirSpec> traced_;
  std::optional<AirLayers> air_;
  bool any_emission_ = false, spectral_flights_ = false;
};

// Error naming the material when its temperature is a table that does not reach over the times from begin to end (s).
void check_temperatures(const Scene& scene, double begin, double end);

// The material of a place as it is there: `base` itself where nothing varies, else `made`, filled with the help of
// `memory`. time: s. out: towards the viewer in the shading frame (emission of mixtures).
const BakedMaterial* material_here(const BakedMaterial& base, const SpectralState& state, const MapPlace& place,
                                   double time, Dir out, LocalMaterial& memory, BakedMaterial& made);

}  // namespace suite
