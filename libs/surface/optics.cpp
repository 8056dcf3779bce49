#include "surface/optics.h"

#include "spectral/planck.h"

namespace suite {

Optics::Optics(const Scene& scene, SpectralState state, const std::vector<bool>& used) : state_(std::move(state)) {
  bake_all(scene, used);
  bool uniform = true;
  for (const BakedMaterial& m : materials_) uniform = uniform && (!m.model || m.model->spectrally_uniform_shape());
  if (uniform && state_.knots.size() > 1) {
    state_.knots.erase(state_.knots.begin() + 1, state_.knots.end());
    bake_all(scene, used);
  }
}

void Optics::bake_all(const Scene& scene, const std::vector<bool>& used) {
  materials_.clear();
  materials_.resize(scene.materials.size());
  for (size_t i = 0; i < materials_.size(); ++i) {
    if (!used.empty() && !used[i]) continue;
    const Material& m = scene.materials[i];
    if (m.surface.model.empty()) continue;  // a name that a map decides
    try {
      materials_[i].model = bake(m.surface, state_);
    } catch (const Error& e) {
      throw Error(e.where(), "material '" + m.id + "': " + e.message(), e.hint(), e.code());
    }
    if (m.temperature_k > 0) {
      any_emission_ = true;
      for (const Bin& b : state_.bins)
        materials_[i].blackbody.push_back(static_cast<float>(planck_band_radiance(b.low_um, b.high_um, m.temperature_k) / (b.high_um - b.low_um)));
    }
  }
}

}  // namespace suite
