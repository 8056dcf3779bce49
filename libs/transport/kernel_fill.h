// Definitions of kernel.h: flights through what fills space.
#pragma once
#include <algorithm>
#include <limits>

#include "transport/kernel.h"

namespace suite {

// Whether anything but what fills space shines at a path that leaves the scene.
template <class Wave>
bool PathKernel<Wave>::meets_outside(const Path& path) const {
  return std::any_of(wave_.lights.outside.begin(), wave_.lights.outside.end(), [&](const SampledLight& light) {
    return light.light->met_outside(path.direction, path.time).has_value();
  });
}

// Flies every path to its next event, then weakens its light. Nothing may change a throughput before the contributions
// that were made with it have been handed over.
template <class Wave>
void PathKernel<Wave>::fly() {
  if (first_stage_) wave_.space.begin_wave();
  for (size_t i = 0; i < active_.size(); ++i) fly_one(i);
  wave_.hand_over();
  for (size_t i = 0; i < active_.size(); ++i) techniques_.residual.pass(wave_, active_[i], flights_[i].length);
  for (size_t i = 0; i < active_.size(); ++i)
    if (flights_[i].weakened) wave_.throughputs.attenuate(active_[i], flights_[i].through);
}

template <class Wave>
void PathKernel<Wave>::fly_one(size_t slot) {
  const uint32_t p = active_[slot];
  Path& path = wave_.paths[p];
  Hit& hit = wave_.hits[slot];
  const double length = wave_.way_to(hit, path);
  if (!wave_.throughputs.has_room(p, Space::kDense)) wave_.throughputs.make_room(p);
  const std::span<float> through = wave_.throughputs.take(p), emitted = wave_.throughputs.take(p);
  Contribution& c = wave_.contribution(p, Space::kEmitter);
  c.water = path.water;
  techniques_.residual.begin_flight(p, path);
  const double before = path.length;
  const bool ends = hit.hit() || length < std::numeric_limits<double>::infinity() || meets_outside(path);
  flights_[slot] = wave_.space.fly(p, path, wave_.records[p], hit, rays_[slot], length, ends, through, emitted);
  const Flight& flight = flights_[slot];
  const double flown = path.length - before;
  if (flight.arrival == Arrival::scattered) path.claims.scatter(flown);
  if (flight.arrival == Arrival::onward) path.claims.pass_boundary(flown);
  if constexpr (Wave::kWatched) wave_.throughputs.fly(p, flight.arrival, flown);
  const bool leaves = flight.arrival == Arrival::met && length == std::numeric_limits<double>::infinity();
  c.radiance = leaves && !is_left_to_chance(p, ClaimedLight::sky()) ? nullptr : flight.emitted;
  // The sky of the air was asked for, too.
  if (const Light* sky = c.radiance && length == std::numeric_limits<double>::infinity() ? wave_.space.sky() : nullptr)
    if (const double density = wave_.space.sky_density(path.direction);
        density > 0 && wave_.options.explicit_sources && path.last_density > 0)
      c.scale = static_cast<float>(Estimator::by_chance(sky->nature(), path.before * density / path.last_density));
  if constexpr (Wave::kStokes)
    if (c.radiance && Space::kEmitter == kFromAir) {
      // In a mirror neighbouring directions would be told apart.
      const bool scattered = path.last_density > 0 && length == std::numeric_limits<double>::infinity();
      c.radiance = wave_.polarise_air(scattered ? Wave::AirWay::sky : Wave::AirWay::exact, path.origin, path.direction,
                                      length, c.radiance);
      wave_.lit_by_air(c);
      wave_.contribute();
      return wave_.hand_over();  // the next way has other light
    }
  if (c.radiance) return wave_.contribute();
  wave_.throughputs.give_back(p);
  if (!flight.through.spectrum) wave_.throughputs.give_back(p);
}

}  // namespace suite
