#include "heat/seen_warmth.h"

#include <algorithm>

#include "spectral/planck.h"
#include "thermal/models.h"

namespace suite {

bool waits_for_heat(const Scene& scene) {
  return std::ranges::any_of(scene.temperatures, [](const TemperatureBinding& t) { return t.spec.model == "heat"; });
}

double hottest_given(const Scene& scene) {
  double most = 0;
  for (const Material& m : scene.materials) most = std::max(most, m.temperature_k);
  for (const PropertyMap& map : scene.property_maps)
    if (map.kind == MapKind::temperature)
      for (const float kelvin : map.values)
        if (double{kelvin} > most) most = double{kelvin};
  for (const TemperatureBinding& t : scene.temperatures)
    if (!t.spec.model.empty()) most = std::max(most, hottest_given(t.spec));
  return most;
}

bool sees_warmth(const SpectralState& state, double kelvin) {
  constexpr double kGlowing = 1e-3;  // W/(m2 sr um)
  return planck_radiance(state.high_um, kelvin) > kGlowing;
}

bool sees_warmth(const SpectralState& state) { return sees_warmth(state, kWeatherBelow); }

}  // namespace suite
