#include "scheduler/kits.h"

#include <algorithm>
#include <cmath>

#include "scheduler/scene_albedo.h"

namespace suite {

namespace {

// Materials that geometry or the Earth can show; the others are never baked.
std::vector<bool> shown_materials(const Tracer& tracer, const SourceSpecs& sources) {
  std::vector<bool> used = used_materials(tracer);
  if (sources.earth) used[earth_material(*sources.earth, tracer.scene())] = true;
  return used;
}

size_t nearest_band(std::span<const Band> bands, double reference_um) {
  size_t best = 0;
  for (size_t b = 0; b < bands.size(); ++b)
    if (std::fabs(bands[b].center_um - reference_um) < std::fabs(bands[best].center_um - reference_um)) best = b;
  return best;
}

// Whether lights depend on the geometry of a tracer: glowing surfaces, and an Earth that lies under all there is.
bool by_geometry(const SourceSpecs& sources) {
  return (sources.earth && !sources.earth->height) ||
         std::any_of(sources.lights.begin(), sources.lights.end(), [](const auto& l) { return l->in_scene(); });
}

}  // namespace

Kit Kits::get(size_t state, const Sensor& sensor, const Capture& capture, const std::shared_ptr<const Tracer>& tracer) {
  using Kind = KitCache::Kind;
  const SpectralState& spectral = sensor.states()[capture.state];
  Kit kit;
  kit.optics = cache_.get<Optics>({Kind::optics, state}, [&] {
    ++optics_bakes_;
    return std::make_shared<const Optics>(scene_, spectral, shown_materials(*tracer, sources_.written()), heating_,
                                          window_, sources_.at(sources_.on_grid(moment_of(capture))).air);
  });
  const auto lit = lights(state, *kit.optics, tracer, sources_.on_grid(moment_of(capture)));
  kit.environment = {lit, &lit->environment};
  kit.bands = cache_.get<Kit::Bands>({Kind::bands, state, &sensor, static_cast<double>(capture.state)}, [&] {
    const std::span<const Band> bands = sensor.bands(capture.state);
    return std::make_shared<const Kit::Bands>(
        Kit::Bands{BandProjection(spectral, bands), nearest_band(bands, spectral.reference_um)});
  });
  return kit;
}

SourceSpecs Kits::sources_over(size_t state, const Optics& optics, const Tracer& tracer, double moment) {
  SourceSpecs sources = sources_.at(moment);
  if (!asks_for_scene(sources.air)) return sources;
  std::shared_ptr<const AirSpec>& air = airs_[state];
  if (!air) air = over_scene(sources.air, tracer, optics, window_.begin);
  sources.air = air;
  return sources;
}

// Lights at other moments share what dates do not move with the first ones that were baked.
std::shared_ptr<const Kits::Lit> Kits::lights(size_t state, const Optics& optics,
                                              const std::shared_ptr<const Tracer>& tracer, double moment) {
  const bool by_tracer = by_geometry(sources_.written());
  const Tracer* const of = by_tracer ? tracer.get() : nullptr;
  const auto first = cache_.get<Lit>({KitCache::Kind::lights, state, of}, [&] {
    ++light_bakes_;
    return std::make_shared<const Lit>(
        Lit{bake_environment(sources_over(state, optics, *tracer, moment), *tracer, periodic_, optics.state()),
            by_tracer ? tracer : nullptr, moment});
  });
  if (first->moment == moment) return first;
  return cache_.get<Lit>({KitCache::Kind::lights_at, state, of, moment}, [&] {
    ++light_bakes_;
    Lit lit = *first;
    rebake_changed(lit.environment, sources_over(state, optics, *tracer, moment), *tracer, optics.state());
    lit.moment = moment;
    return std::make_shared<const Lit>(std::move(lit));
  });
}

void Kits::done(size_t state) {
  size_t& left = users_[state];
  SUITE_CHECK(left > 0);
  if (--left == 0) cache_.drop(state), airs_.erase(state);
}

}  // namespace suite
