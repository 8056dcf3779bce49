// Definitions of kernel.h: what only some paths come to. Lights on sensors' own rays through the air, receivers,
// surfaces that shine or are warm; and what techniques add where a path goes on: branches, claims, another roulette.
#pragma once
#include <algorithm>
#include <limits>
#include <optional>
#include <utility>

#include "transport/kernel.h"

namespace suite {

// Lights that shine on the way of sensors' own rays, unweakened by what these meet.
template <class Wave>
void PathKernel<Wave>::see_from_above() {
  for (size_t i = 0; i < active_.size(); ++i) {
    const uint32_t p = active_[i];
    const Path& path = wave_.paths[p];
    for (const SampledLight& light : wave_.lights.outside) {
      if (!light.nature.above || !light.light->is_below(path.origin)) continue;
      Light::RayFromAbove ray{path.origin, path.direction, wave_.way_to(wave_.hits[i], path), {}, path.points_apart};
      if (wave_.environment.atmosphere && std::isinf(ray.length)) {
        wave_.transmission.assign(wave_.bins, 1.0f);
        wave_.environment.atmosphere->transmittance(ray.from, ray.direction, ray.length, wave_.transmission);
        ray.air = wave_.transmission;
      }
      const std::span<float> memory = wave_.dense(p);
      std::fill(memory.begin(), memory.end(), 0.0f);
      light.light->add_from_above(ray, memory);
      wave_.contribution(p, light.index).radiance = memory.data();
      wave_.contribute();
    }
  }
  wave_.hand_over();
}

// The first node of a path that starts at a receiver.
template <class Wave>
void PathKernel<Wave>::receive(uint32_t p) {
  if constexpr (requires(Surfaces & s) { s.receive(p, wave_.hits[0], receivers_[p]); }) {
    Path& path = wave_.paths[p];
    const auto slot = static_cast<uint32_t>(active_.size());
    active_.push_back(p);
    Hit& hit = wave_.hits[slot];
    hit = {};
    hit.position = path.origin;
    hit.normal = path.direction;
    hit.time = path.time;
    wave_.surfaces.receive(p, hit, receivers_[p]);
    ++path.surfaces;
    path.direction = -path.direction;  // out, as the receiver sees it, is along its normal
    wave_.nodes.push_back({p, slot, false});
  }
}

// A surface met by chance may shine; what an explicit sample of it brings is shared with it.
template <class Wave>
void PathKernel<Wave>::meet_glow(uint32_t p, const Hit& hit) {
  const Path& path = wave_.paths[p];
  const LastAsked& last = wave_.last[p];
  const bool shared = path.order() > 1 && wave_.options.explicit_sources && path.last_density > 0;
  double distance = hit.distance;
  if (Space::kScatters && shared)  // boundaries of media may have been passed on the way
    distance = wave_.surface.tracer().periodic() ? path.length - last.length : length(hit.position - last.at.position);
  const double cosine = -dot(path.direction, hit.normal);
  for (const SampledLight& light : wave_.lights.glowing) {
    if (light.nature.placed && !is_left_to_chance(p, {ClaimedLight::Kind::small, light.index}) &&
        light.light->draws(hit))
      continue;
    const auto met =
        light.light->met_surface(last.at, hit, wave_.surfaces.material(p), path.direction, distance, cosine, path.time);
    if (!met) continue;
    Contribution& c = wave_.contribution(p, light.index);
    c.order -= 1;  // not scattered by what shines
    c.scale = static_cast<float>(met->scale);
    if (shared && met->density > 0)
      c.scale *= static_cast<float>(
          Estimator::by_chance(light.nature, path.before * last.draws * met->density / path.last_density));
    c.radiance = met->spectrum;
    if (c.scale == 0) continue;
    wave_.leaves(c, met->source, -path.direction, path.time);
    wave_.contribute();
    if constexpr (Wave::kStokes) wave_.hand_over();
  }
}

// Warm surfaces.
template <class Wave>
void PathKernel<Wave>::emit(uint32_t p) {
  if constexpr (Surfaces::kDense > 0) {
    if (!wave_.surfaces.warm(p)) return;
    const std::span<float> memory = wave_.dense(p);
    const auto emission = wave_.surfaces.emission(p, -wave_.paths[p].direction, memory);
    wave_.space.emit_within(p, memory);
    Contribution& c = wave_.contribution(p, kFromMatter);
    c.order -= 1;  // not scattered by what emits
    c.factor = emission.emissivity;
    c.radiance = emission.radiance;
    if constexpr (Wave::kStokes) c.polarised = wave_.polarise_emission(p);
    wave_.contribute();
    if constexpr (Wave::kStokes) wave_.hand_over();
  }
}

// The branches of a node that are kept.
template <class Wave>
void PathKernel<Wave>::branch(size_t i) {
  if constexpr (Space::kMedia) {
    const PathNode& node = wave_.nodes[i];
    const auto on_by = [&](size_t j, const Continuation& on) { return go_on(j, on); };
    if (techniques_.guide.guides(wave_, node)) techniques_.splitting.branch_guided(wave_, techniques_.guide, i, on_by);
    if (goes_to_end(node)) techniques_.splitting.branch_to_end(wave_, techniques_.ends, i, on_by);
    if (techniques_.manifold.on() && wave_.is_first(node) && !node.event &&
        techniques_.manifold.is_interface(wave_, node))
      techniques_.splitting.branch_mirrored(wave_, techniques_.manifold, i, on_by);
  }
}

// How much more of its light a path is worth to roulette that comes to a smooth surface from within water: most leave
// there, with the light of a sky that nobody asks for through the surface, and end; to end them first saves next to
// nothing. A value of 6 takes 0.5 to 0.7 of the work to an error in the bay of sample_scenes, coastal to red.
template <class Wave>
double PathKernel<Wave>::ahead(size_t i, const Continuation& on) const {
  if constexpr (Space::kMedia) {
    constexpr double kLeaves = 6, kClaimed = 0.1;
    const double index = wave_.space.index(wave_.nodes[i].path);
    if (techniques_.chains.passes_into_claimed_sky(wave_, techniques_.manifold, i, on))
      return kClaimed;  // what others bring is not worth while
    if (techniques_.manifold.on() && techniques_.splitting.on() && on.dirac && index > 1)
      return kLeaves * index * index;
  }
  return 1;
}

// The claims on the light that the path may meet behind the node.
template <class Wave>
void PathKernel<Wave>::leave_claims(const PathNode& node, const Continuation& on) {
  Claim manifold = Claim::manifold(RefractedWay::kMostEvents);
  PathClaims& claims = wave_.paths[node.path].claims;
  const NodeClaims* made = techniques_.chains.claims(wave_, node);
  if constexpr (Wave::kWatched) {
    const bool interface = !node.event && techniques_.manifold.is_interface(wave_, node);
    wave_.throughputs.leave_node(node.path,
                                 {node.event, interface, on.dirac, !node.event && wave_.passes(node, on), on.in});
    made = wave_.throughputs.claim(made, manifold);
  }
  if (node.event) {
    if (wave_.in_air(node)) return claims.clear();  // it asks for nothing through interfaces
    return claims.leave_scattering(made, manifold, on.in);
  }
  if (techniques_.manifold.is_interface(wave_, node)) return claims.meet_interface(!wave_.passes(node, on));
  // Nodes ask for what comes by other than Dirac lobes.
  if (!on.dirac) claims.leave_surface(made, manifold, on.in);
}

template <class Wave>
TraceStatistics PathKernel<Wave>::take_statistics() {
  TraceStatistics all = wave_.space.take_statistics();
  const TraceStatistics touching = std::exchange(wave_.touching, {});
  all.rays += touching.rays, all.cycles += touching.cycles;
  return all;
}

// The first smooth interface of a path: what water mirrors is weak, but in dark bands all there is. A power of 1/2:
// counts of strata have no rest. Nothing: it does not mirror.
template <class Wave>
std::optional<bool> PathKernel<Wave>::draw_at_interface(const PathNode& node, double lobe_u, std::span<float> memory,
                                                        Continuation& on) {
  if constexpr (Surfaces::kDense > 0) {
    constexpr double kLeast = 0.125;
    const Path& path = wave_.paths[node.path];
    const Dir out = -path.direction;
    const int mirror = techniques_.manifold.interfaces().lobe(wave_.surfaces.material(node.path), true);
    if (mirror == SmoothInterfaces::kNoLobe) return std::nullopt;
    if (!techniques_.splitting.on())
      return wave_.surfaces.sample_either(node.path, out, mirror, kLeast, lobe_u, path.knot, memory, on);
    // Beside the branch that is kept.
    const bool all = wave_.surfaces.mirrors(node.path, out, mirror, path.knot) >= 1;
    return wave_.surfaces.sample_way(node.path, out, mirror, all, path.knot, memory, on);
  }
  return std::nullopt;
}

template <class Wave>
const PathRecord& PathKernel<Wave>::record(uint32_t p) {
  if (!techniques_.residual.has_been_back(p)) wave_.records[p].size = wave_.paths[p].surfaces;
  PathRecord& record = techniques_.residual.record(p, wave_.records[p]);
  record.size = techniques_.splitting.surfaces(p, record.size);
  return record;
}

template <class Wave>
bool PathKernel<Wave>::is_left_to_chance(uint32_t p, ClaimedLight light) {
  const Path& path = wave_.paths[p];
  const bool claimed = techniques_.manifold.is_claimed(path, light);
  if constexpr (Wave::kWatched)
    if (techniques_.manifold.on()) wave_.throughputs.meet_light(p, light, techniques_.manifold.hero_of(path), claimed);
  return !claimed;
}

}  // namespace suite
