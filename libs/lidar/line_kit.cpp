#include "lidar/line_kit.h"

#include <algorithm>

#include "scheduler/scene_albedo.h"
#include "spectral/planck.h"

namespace suite {

namespace {

// One bin of this width.
SpectralState state_of(double wavelength_um, double width_um) {
  const Band line[] = {Band::rectangular("laser", wavelength_um, width_um)};
  return make_state(line, 2 * width_um, wavelength_um, 1);
}
double line_width(const LineKit::Line& line) {
  return std::clamp(line.width_um, 1e-9 * line.wavelength_um, 0.1 * line.wavelength_um);
}

}  // namespace

LineKit::LineKit(const Tracer& tracer, const SourceSpecs& passive, const Line& line, TimeSpan window)
    : optics(tracer.scene(), state_of(line.wavelength_um, line_width(line)), used_materials(tracer), {.pending = true},
             window, passive.air),
      surface(tracer, optics),
      environment(bake(tracer, passive, line, window.begin)),
      wavelength_um(line.wavelength_um),
      photons_of_joule(line.wavelength_um * 1e-6 / (kPlanckConstant * kSpeedOfLight)) {}

Environment LineKit::bake(const Tracer& tracer, SourceSpecs passive, const Line& line, double time) const {
  if (asks_for_scene(passive.air)) passive.air = over_scene(passive.air, tracer, optics, time);
  Environment all = bake_environment(passive, tracer, false, optics.state());
  const double filter = std::min(line.filter_um, 1.9 * line.wavelength_um);
  if (!(filter > line_width(line))) return all;
  const SpectralState through_filter = state_of(line.wavelength_um, filter);
  for (size_t i = 0; i < all.lights.size(); ++i)
    if (!passive.has_air() || !all.lights[i]->beam()) all.lights[i] = passive.lights[i]->bake(tracer, through_filter);
  return all;
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

bool LineKit::any_smooth() const {
  const auto& materials = surface.tracer().scene().materials;
  for (uint32_t m = 0; m < materials.size(); ++m)
    if (const ScatterModel* const model = optics.material(m).model; model && model->has_delta()) return true;
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
