#include "scheduler/kits.h"

#include <algorithm>
#include <cmath>

namespace suite {

namespace {

// Materials that geometry or the Earth can show; the others are never baked.
std::vector<bool> shown_materials(const Scene& scene, const Tracer& tracer, const SourceSpecs& sources) {
  std::vector<bool> used = used_materials(scene, tracer.objects());
  if (sources.earth) used[earth_material(*sources.earth, scene)] = true;
  return used;
}

size_t nearest_band(std::span<const Band> bands, double reference_um) {
  size_t best = 0;
  for (size_t b = 0; b < bands.size(); ++b)
    if (std::fabs(bands[b].center_um - reference_um) < std::fabs(bands[best].center_um - reference_um)) best = b;
  return best;
}

}  // namespace

Kit Kits::get(size_t state, const Sensor& sensor, const Capture& capture, const std::shared_ptr<const Tracer>& tracer) {
  Held& held = states_[state];
  const SpectralState& spectral = sensor.states()[capture.state];
  if (!held.optics) {
    held.optics = std::make_unique<const Optics>(scene_, spectral, shown_materials(scene_, *tracer, sources_.written()),
                                                 LoadsAt{}, window_);
    ++optics_bakes_;
  }
  light(held, tracer, sources_.dated() ? moment_of(capture) : 0);
  const std::span<const Band> bands = sensor.bands(capture.state);
  const auto own = held.bands
                       .try_emplace({&sensor, capture.state},
                                    Bands{BandProjection(spectral, bands), nearest_band(bands, spectral.reference_um)})
                       .first;
  return {*held.optics, held.environment, own->second.projection, own->second.reference};
}

// Brings the lights of a state to a moment and to the geometry of a tracer, where glowing surfaces have their places.
void Kits::light(Held& held, const std::shared_ptr<const Tracer>& tracer, double moment) {
  const SourceSpecs& now = sources_.at(moment);
  if (!held.lamps_of || (held.environment.lamps_in_scene() && held.lamps_of != tracer)) {
    held.environment = bake_environment(now, *tracer, periodic_, held.optics->state());
    ++light_bakes_;
  } else if (held.moment != moment) {
    rebake_changed(held.environment, now, *tracer, held.optics->state());
    ++light_bakes_;
  }
  held.lamps_of = tracer;
  held.moment = moment;
}

void Kits::done(size_t state) {
  Held& held = states_[state];
  SUITE_CHECK(held.users > 0);
  if (--held.users == 0) held = {};
}

size_t Kits::held() const {
  return static_cast<size_t>(
      std::count_if(states_.begin(), states_.end(), [](auto& s) { return s.second.optics != nullptr; }));
}

}  // namespace suite
