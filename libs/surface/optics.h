// The materials of a scene baked for one spectral state.
#pragma once
#include <memory>
#include <vector>

#include "optics/models.h"
#include "scene/scene.h"
#include "spectral/state.h"

namespace suite {

struct BakedMaterial {
  std::unique_ptr<const ScatterModel> model;
  std::vector<float> blackbody;       // Planck radiance at the material's temperature per bin; empty = does not emit
};

class Optics {
 public:
  // Bakes the materials for which used[i] is true (all when empty). Error naming the material when one cannot be baked.
  Optics(const Scene& scene, SpectralState state, const std::vector<bool>& used = {});

  const BakedMaterial& material(uint32_t index) const { return materials_[index]; }
  // The scene's media, all of them where a ray can meet one, else none.
  std::span<const BakedMedium> media() const { return media_; }
  // False when every medium scatters alike at all wavelengths, so that flights need not be weighed between knots.
  bool spectral_flights() const { return spectral_flights_; }
  bool any_emission() const { return any_emission_; }
  // The state the materials are baked for: the given one, with its knots reduced to the reference when the shape of no
  // material or medium changes with wavelength, because the estimator then is the same at every knot; and with knots
  // added at the bins where media scatter least and most, so that no wavelength's flights are far from all knots'.
  const SpectralState& state() const { return state_; }

 private:
  void bake_all(const Scene& scene, const std::vector<bool>& used);
  void bake_media(const Scene& scene);
  SpectralState state_;
  std::vector<BakedMaterial> materials_;
  std::vector<BakedMedium> media_;
  bool any_emission_ = false, spectral_flights_ = false;
};

}  // namespace suite
