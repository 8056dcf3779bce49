#include "heat/seen_warmth.h"

#include <algorithm>

#include "spectral/planck.h"

namespace suite {

bool waits_for_heat(const Scene& scene) {
  return std::ranges::any_of(scene.temperatures, [](const TemperatureBinding& t) { return t.spec.model == "heat"; });
}

bool sees_warmth(const SpectralState& state) {
  constexpr double kHottest = 450, kGlowing = 1e-3;  // K, W/(m2 sr um)
  return planck_radiance(state.high_um, kHottest) > kGlowing;
}

}  // namespace suite
