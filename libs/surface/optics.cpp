#include "surface/optics.h"

#include <algorithm>

#include "spectral/planck.h"

namespace suite {

Optics::Optics(const Scene& scene, SpectralState state, const std::vector<bool>& used) : state_(std::move(state)) {
  if (uses_media(scene)) bake_media(scene);
  bake_all(scene, used);
  bool uniform = !spectral_flights_;
  for (const BakedMaterial& m : materials_) uniform = uniform && (!m.model || m.model->spectrally_uniform_shape());
  if (uniform && state_.knots.size() > 1) {
    state_.knots.erase(state_.knots.begin() + 1, state_.knots.end());
    bake_all(scene, used);
    if (!media_.empty()) bake_media(scene);
  }
}

void Optics::bake_media(const Scene& scene) {
  const auto bake_them = [&] {
    media_.clear();
    for (const Medium& m : scene.media) {
      try {
        media_.emplace_back(m, state_);
      } catch (const Error& e) {
        throw Error(e.where(), "medium '" + m.id + "': " + e.message(), e.hint(), e.code());
      }
    }
  };
  bake_them();
  const size_t before = state_.knots.size();
  for (const BakedMedium& m : media_) {
    spectral_flights_ = spectral_flights_ || !m.uniform();
    const auto [least, most] = std::minmax_element(m.scattering.begin(), m.scattering.end());
    if (*least == *most || before == 1) continue;
    for (const auto bin : {least, most}) {
      const size_t b = static_cast<size_t>(bin - m.scattering.begin());
      if (state_.knots.size() < kMaxKnots && std::find(state_.knots.begin(), state_.knots.end(), b) == state_.knots.end()) state_.knots.push_back(b);
    }
  }
  if (state_.knots.size() != before) bake_them();
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
