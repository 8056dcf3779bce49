// Definitions of kernel.h: what paths come to: surfaces, the Earth.
#pragma once
#include <limits>
#include <utility>

#include "transport/kernel_end.h"

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

}  // namespace suite
