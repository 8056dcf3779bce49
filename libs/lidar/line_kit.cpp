#include "lidar/line_kit.h"

#include <algorithm>

#include "scheduler/scene_albedo.h"
#include "spectral/planck.h"

namespace suite {

// One bin as wide as the line.
SpectralState LineKit::state_of(double wavelength_um, double width_um) {
  const double width = std::clamp(width_um, 1e-9 * wavelength_um, 0.1 * wavelength_um);
  const Band line[] = {Band::rectangular("laser", wavelength_um, width)};
  return make_state(line, 2 * width, wavelength_um, 1);
}

LineKit::LineKit(const Tracer& tracer, const SourceSpecs& passive, double um, double width_um, TimeSpan window)
    : optics(tracer.scene(), state_of(um, width_um), used_materials(tracer), {.pending = true}, window, passive.air),
      surface(tracer, optics),
      environment(bake(tracer, passive, window.begin)),
      wavelength_um(um),
      photons_of_joule(um * 1e-6 / (kPlanckConstant * kSpeedOfLight)) {}

Environment LineKit::bake(const Tracer& tracer, SourceSpecs passive, double time) const {
  if (asks_for_scene(passive.air)) passive.air = over_scene(passive.air, tracer, optics, time);
  return bake_environment(passive, tracer, false, optics.state());
}

bool LineKit::leaves(size_t medium) const {
  const std::vector<Medium>& named = surface.tracer().scene().media;
  return medium < named.size() && medium < optics.media().size() && named[medium].phase.model == "leaves";
}

bool LineKit::any_leaves() const {
  for (size_t m = 0; m < optics.media().size(); ++m)
    if (leaves(m)) return true;
  return false;
}

bool LineKit::shines() const {
  constexpr double kWarm = 2.5;  // um: beyond it the air glows
  if (!environment.lights.empty() || optics.any_emission()) return true;
  if (environment.atmosphere && wavelength_um > kWarm) return true;
  const auto& materials = surface.tracer().scene().materials;
  for (uint32_t m = 0; m < materials.size(); ++m)
    if (!optics.material(m).blackbody.empty()) return true;
  return false;
}

}  // namespace suite
