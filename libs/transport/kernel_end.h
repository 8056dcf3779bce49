// Definitions of kernel.h: how paths end. Outside the scene, with the lights that they meet there by chance; by Russian
// roulette; at the limit of nodes; because a model gave what is no number.
#pragma once
#include <limits>

#include "transport/kernel.h"

namespace suite {

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
    if (c.scale == 0) continue;
    wave_.leaves(c, met->source, -path.direction, path.time);
    wave_.contribute();
    if constexpr (Wave::kStokes) wave_.hand_over();
  }
}

// The probability with which the path has survived; 0 when roulette ends it.
template <class Wave>
double PathKernel<Wave>::survives(uint32_t p, double brightest) {
  Path& path = wave_.paths[p];
  const double alive = Estimator::survival(brightest, path.order(), wave_.options.roulette_after);
  if (alive == 1) return 1;
  if (dimensions::of_roulette(path.stream, path.sample, path.order() - 1) >= alive) {
    wave_.records[p].end = PathEnd::roulette;
    return 0;
  }
  for (size_t k = 0; k < wave_.knots(); ++k) path.throughput[k] /= alive;
  return alive;
}

// Whether the path has as many nodes as it may have. Of two branches to the next scattering the open one would bring
// all light by itself.
template <class Wave>
bool PathKernel<Wave>::cut(size_t i, const Continuation& on) {
  const bool event = wave_.nodes[i].event;
  const uint32_t p = wave_.nodes[i].path;
  const Path& path = wave_.paths[p];
  const uint32_t most = event ? wave_.options.max_scatterings : static_cast<uint32_t>(wave_.options.max_nodes);
  if (most == 0 || (event ? path.scatterings : path.surfaces) < most) return false;
  wave_.records[p].end = PathEnd::max_nodes;
  leave(i, on);
  const double index = wave_.space.index(p);
  if (on.branch != Branch::forced) wave_.records[p].truncated += path.throughput[0] * path.share * index * index;
  return true;
}

// A path that cannot go on because a model gave what is no number: its sample is rejected and counted.
template <class Wave>
bool PathKernel<Wave>::fail(uint32_t p) {
  wave_.contribution(p, kFromMatter).scale = std::numeric_limits<float>::quiet_NaN();
  wave_.contribute();
  wave_.hand_over();
  return false;
}

}  // namespace suite
