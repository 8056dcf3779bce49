// Definitions of techniques/manifold.h: what lights send along the ways that have been found.
#pragma once
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "transport/techniques/manifold.h"

namespace suite {

template <class Wave>
void Manifold<Wave>::keep_bins_of(const Wave& wave, size_t knot, SuffixThroughput<Wave>& suffix) const {
  const std::vector<size_t>& set = sight_->interfaces().set_of();
  for (size_t i = 0; i < wave.bins; ++i)
    suffix.spectrum()[i] *= set[static_cast<size_t>(wave.heroes.of_bin[i])] == knot ? 1.0f : 0.0f;
}

template <class Wave>
bool Manifold<Wave>::follow(Wave& wave, const Path& path, const RefractedWay& way, size_t knot, bool sky,
                            SuffixThroughput<Wave>& suffix, double& arrival) {
  Ray ray{way.origin, way.direction, path.time, path.draw};
  for (int i = 0; i < way.events; ++i) {
    const RefractedEvent& at = way.at[i];
    if (wave.contacts.covers(ray, at.hit, wave.touching)) return false;
    arrival += at.length * suffix.follow(ray, at.length);
    suffix.meet(at, sight_->interfaces().lobe(at.material, at.reflected), knot, path.time);
    if (!at.reflected) wave.space.cross_way(at.hit, at.material, at.in);
    ray.origin = wave.surface.tracer().leave(at.hit, at.in);
    ray.direction = at.in;
  }
  if (wave.is_behind_earth(ray, way.length)) return false;
  if (sky) return true;
  const double delay = suffix.follow(ray, way.length);
  if (std::isfinite(way.length)) arrival += way.length * delay;  // far lights shine evenly in time
  return std::ranges::any_of(suffix.spectrum(), [](float t) { return t != 0; });
}

template <class Wave>
WayStart Manifold<Wave>::from_node(const Wave& wave, const PathNode& node) const {
  const uint32_t p = node.path;
  const Path& path = wave.paths[p];
  WayStart from;
  from.time = path.time, from.draw = path.draw;
  if (node.event) {
    if constexpr (Wave::Space::kScatters) from.place = wave.space.place(p);
  } else {
    const Hit& hit = wave.hits[node.slot];
    const LightReceiver at = wave.surfaces.receiver(p, hit, -path.direction);
    from.place = hit.position;
    from.hit = &hit;
    if (!at.two_sided) from.side = dot(path.direction, hit.normal) < 0 ? hit.normal : -hit.normal;
  }
  return from;
}

template <class Wave>
bool Manifold<Wave>::shine_along(Wave& wave, const RefractedWay& way, const RefractedQuestion& q, size_t knot) {
  const PathNode& node = wave.nodes[q.node];
  const uint32_t p = node.path;
  const Path& path = wave.paths[p];
  if (!node.event && !wave.surfaces.takes(p, wave.hits[node.slot], -path.direction, way.direction)) return false;
  SuffixThroughput<Wave> suffix(wave, wave.dense(p, 2));
  suffix.leave(node, way.direction);
  keep_bins_of(wave, knot, suffix);
  wave.space.begin_way(p, node.event, wave.hits[node.slot], node.event ? kNone : wave.surfaces.material(p),
                       -path.direction, way.direction);
  return shine_behind(wave, way, q, knot, {0, 1, 0, way.direction}, suffix);
}

template <class Wave>
bool Manifold<Wave>::shine_behind(Wave& wave, const RefractedWay& way, const RefractedQuestion& q, size_t knot,
                                  const Reached& reached, SuffixThroughput<Wave>& suffix) {
  const PathNode& node = wave.nodes[q.node];
  const uint32_t p = node.path;
  const Path& path = wave.paths[p];
  const auto most = static_cast<uint32_t>(wave.options.max_nodes);
  if (most > 0 && path.surfaces + static_cast<uint32_t>(way.events) >= most) return false;
  double arrival = reached.arrival;
  if (!follow(wave, path, way, knot, q.sky, suffix, arrival)) return false;
  const auto from_light = sent(wave, q, way);
  if (!from_light) return false;
  WaterSeen water = WaterSeen::nothing;
  if (wave.waters.any()) {
    water = wave.water_behind(node, reached.first);
    if (reached.scatterings > 0) water = Waters::behind_scattering(water);
    for (int i = 0; i < way.events; ++i)
      water = wave.waters.behind_surface(water, way.at[i].material, way.at[i].hit.normal, way.at[i].out, way.at[i].in);
    if (water == WaterSeen::mirrored && !q.end.far) water = WaterSeen::other;
  }
  for (const bool doubtful : {false, true}) {
    if (doubtful && !way.doubtful) break;
    Contribution& c = wave.contribution(p, q.light);
    c.events |= by_surface | by_dirac;
    if (node.event || reached.scatterings > 0) c.events |= by_medium;
    c.asked = !q.sky;
    c.beam = q.beam;
    c.water = water;
    c.order += static_cast<uint32_t>(way.events) + reached.scatterings;
    c.smooth += static_cast<uint32_t>(way.events);
    c.scale = static_cast<float>(from_light->scale * way.spreading * way.trials * reached.scale);
    c.radiance = from_light->spectrum;
    c.arrival += arrival;
    if (doubtful) c.missed = 0;  // there may be as much again
    wave.leaves(c, from_light->source, -way.to, wave.time(node));
    suffix.contribute(c);
  }
  return true;
}

// What a light sends along a way, per solid angle there; of a lamp per m2 across the way, over the density of the
// place.
template <class Wave>
auto Manifold<Wave>::sent(Wave& wave, const RefractedQuestion& q, const RefractedWay& way) -> std::optional<Sent> {
  const PathNode& node = wave.nodes[q.node];
  if (q.sky) {
    const std::span<float> own = wave.throughputs.take(node.path);
    return Sent{q.scale, wave.space.sky_behind({way.last, way.to, 0}, wave.transmission, own)};
  }
  const Light& light = *wave.environment.lights[q.light];
  const double when = wave.time(node);
  if (q.end.far) {
    if (q.spectrum) return Sent{q.scale, q.spectrum};
    const std::span<float> own = wave.throughputs.take(node.path);  // its shape changes with direction
    std::fill(own.begin(), own.end(), 0.0f);
    light.add(q.end.direction, when, 1, own);
    return Sent{q.scale, own.data()};
  }
  if (q.end.surface) {
    if (!light.draws(way.lamp)) return std::nullopt;
    const double cosine = -dot(way.to, way.lamp.normal);
    const auto met = light.met_surface(wave.receiver(node), way.lamp, wave.surface.material(way.lamp), way.to,
                                       way.length, cosine, when);
    if (!met) return std::nullopt;
    return Sent{q.scale * met->scale * std::fabs(cosine), met->spectrum, met->source};
  }
  const auto sample = light.sample_member(q.member, 1, {way.last, {}, true}, {}, when);
  if (!sample) return std::nullopt;
  return Sent{q.scale * sample->scale * sample->distance * sample->distance, sample->spectrum, sample->source};
}

}  // namespace suite
