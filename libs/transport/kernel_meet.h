// Definitions of kernel.h: what paths come to: surfaces, the Earth, the outside, and the lights that they meet there by
// chance.
#pragma once
#include <algorithm>
#include <limits>
#include <utility>

#include "transport/kernel.h"

namespace suite {

// Sorts paths by what they have come to.
template <class Wave>
void PathKernel<Wave>::arrive() {
  wave_.nodes.clear(), onward_.clear();
  for (uint32_t i = 0; i < active_.size(); ++i) {
    const uint32_t p = active_[i];
    if constexpr (Space::kScatters) {
      const Arrival arrival = flights_[i].arrival;
      if (arrival == Arrival::onward) onward_.push_back(p);
      if (arrival == Arrival::scattered) {
        ++wave_.paths[p].scatterings;
        wave_.paths[p].events |= by_medium;
        wave_.nodes.push_back({p, i, true});
      }
      if (arrival != Arrival::met) continue;
    }
    if (!(wave_.hits[i].hit() ? meet(p, i) : meet_earth(p, i))) continue;
    wave_.nodes.push_back({p, i, false});
    if (techniques_.manifold.on() && !techniques_.manifold.is_interface(wave_, wave_.nodes.back()))
      wave_.paths[p].claims.clear();
  }
  nodes_met_ += wave_.nodes.size();
  for (const uint32_t p : std::exchange(received_, {})) receive(p);
  for (const uint32_t p : techniques_.residual.returned()) {
    const auto slot = static_cast<uint32_t>(active_.size());
    active_.push_back(p);
    wave_.hits[slot] = {};
    wave_.nodes.push_back({p, slot, true});
  }
  nodes_met_ += techniques_.residual.returned().size();
  techniques_.residual.clear_returned();
}

// A path meets a surface. False when nothing scatters there.
template <class Wave>
bool PathKernel<Wave>::meet(uint32_t p, uint32_t slot) {
  Path& path = wave_.paths[p];
  Hit& hit = wave_.hits[slot];
  if constexpr (Surfaces::kDense > 0)
    wave_.contacts.settle({{}, path.direction, path.time, path.draw}, hit, wave_.touching);
  const bool first = is_first_surface(p);
  path.length += hit.distance;
  path.arrival += wave_.space.delay(p) * hit.distance;
  const bool scatters = wave_.surfaces.meet(p, hit, -path.direction, path.time, first);
  enter_node(p, hit, first);
  if (!wave_.lights.glowing.empty()) meet_glow(p, hit);
  emit(p);
  return scatters;
}

template <class Wave>
void PathKernel<Wave>::enter_node(uint32_t p, const Hit& hit, bool first) {
  Path& path = wave_.paths[p];
  ++path.surfaces;
  if (!first || !keep_first_) return;
  wave_.records[p].met = !wave_.records[p].scattered_first;
  firsts_[p] = {hit.object, -path.direction, path.length, false, &wave_.surfaces.interaction(p)};
}

// A path that missed the scene meets the Earth under it, if there is one; false when the path ends.
template <class Wave>
bool PathKernel<Wave>::meet_earth(uint32_t p, uint32_t slot) {
  Path& path = wave_.paths[p];
  const auto met = wave_.environment.earth ? wave_.environment.earth->meet(path.origin, path.direction,
                                                                           std::numeric_limits<double>::infinity())
                                           : std::nullopt;
  if (!met) {
    escape(p, Space::kGoesBack && flights_[slot].difference);
    return false;
  }
  Hit& hit = wave_.hits[slot];
  hit = {};
  hit.distance = met->distance;
  hit.position = met->position;
  hit.normal = met->normal;
  hit.step = Earth::step;
  hit.time = path.time;
  const bool first = is_first_surface(p);
  path.length += hit.distance;
  path.arrival += hit.distance;
  const bool scatters = wave_.surfaces.meet_earth(p, hit, wave_.environment.earth->material(), first);
  enter_node(p, hit, first);
  emit(p);
  return scatters;
}

// What a path meets outside the scene. in_field: but for beams, which the field of the air has.
template <class Wave>
void PathKernel<Wave>::escape(uint32_t p, bool in_field) {
  const Path& path = wave_.paths[p];
  wave_.records[p].end = PathEnd::escaped;
  wave_.records[p].escape = path.direction;
  for (const SampledLight& light : wave_.lights.outside) {
    if (in_field && light.beam) continue;
    if (light.nature.above && path.order() == 0 && light.light->is_below(path.origin)) continue;
    if (is_refracted(light.nature) && !is_left_to_chance(p, {ClaimedLight::Kind::small, light.index})) continue;
    const auto met = light.light->met_outside(path.direction, path.time);
    if (!met) continue;
    std::span<float> memory;
    if (!met->spectrum) {  // its shape changes with direction
      memory = wave_.dense(p);
      std::fill(memory.begin(), memory.end(), 0.0f);
      const bool apart = path.points_apart && (path.order() == 0 || (mirrors_ && FlatMirrors::is_along(path)));
      apart ? light.light->add_without_points(path.direction, path.time, 1, memory)
            : light.light->add(path.direction, path.time, 1, memory);
    }
    Contribution& c = wave_.contribution(p, light.index);
    c.scale = static_cast<float>(met->scale);
    if (wave_.options.explicit_sources && path.last_density > 0 && met->density > 0)
      c.scale *= static_cast<float>(Estimator::by_chance(light.nature, path.before * met->density / path.last_density));
    c.beam = light.beam;
    c.water = path.water;
    c.radiance = met->spectrum;
    if (!c.radiance) c.radiance = memory.data();
    if (c.scale != 0) wave_.contribute();
  }
}

}  // namespace suite
