// Definitions of kernel.h: manifold next-event estimation (MNEE): lights behind smooth interfaces (refracted_sight.h).
//
// Every node asks far lights that are small, and a place on one of the lamps, for all ways through such interfaces,
// whatever the straight line towards the light meets, and claims their light (path/claims.h). The light comes
// along a way with
//   w(out, direction) x transmittances and reflectances of interfaces, squared indices, and of what fills space
//     x |d(direction) / d(direction at a far light)|  x  radiance over its density, or irradiance;
//     x |d(direction) / d(m2 across the way at a lamp)|  x  radiance x cosine over the density of places, or intensity.
// That a point's light spreads so follows from its radiance being that of a small surface.
#pragma once
#include <algorithm>
#include <cmath>

#include "transport/kernel.h"

namespace suite {

template <class Surfaces, class Space, class Throughputs, class Estimator>
void PathKernel<Surfaces, Space, Throughputs, Estimator>::want_refracted(const NodeAt& node, const Asked& light,
                                                                         const LightSample& sample) {
  if (!asks_through(node)) return;
  refracted_questions_.push_back({static_cast<uint32_t>(&node - nodes_.data()),
                                  light.index,
                                  light.beam,
                                  {sample.direction, {}},
                                  sample.scale / (sample.density > 0 ? sample.density : 1),
                                  sample.spectrum,
                                  0});
}

template <class Surfaces, class Space, class Throughputs, class Estimator>
bool PathKernel<Surfaces, Space, Throughputs, Estimator>::asks_through(const NodeAt& node) const {
  if (node.event) return !Space::kGoesBack;  // the even field that it stands for knows no interfaces
  return !is_interface(node);                // Dirac lobes only
}

// A place on a lamp for every node.
template <class Surfaces, class Space, class Throughputs, class Estimator>
void PathKernel<Surfaces, Space, Throughputs, Estimator>::want_places() {
  for (const Asked& light : asked_) {
    if (!light.nature.placed) continue;
    for (const NodeAt& node : nodes_) {
      if (!asks_through(node)) continue;
      const auto drawn = light.light->draw_place(receiver(node), numbers(node, light.use), time(node));
      if (!drawn) continue;
      refracted_questions_.push_back({static_cast<uint32_t>(&node - nodes_.data()),
                                      light.index,
                                      light.beam,
                                      {{}, drawn->place, false, !drawn->point},
                                      1 / drawn->density,
                                      nullptr,
                                      drawn->member});
    }
  }
}

// Of light that smooth surfaces stop on its straight way: the share that is lost there, having not been asked for
// through them. passes: what they pass.
template <class Surfaces, class Space, class Throughputs, class Estimator>
double PathKernel<Surfaces, Space, Throughputs, Estimator>::lost(const Question& q, size_t ray, double passes) {
  if (!refracted_ || q.light == kFromAir || !is_refracted(environment_.lights[q.light]->nature())) return passes;
  if (Space::kGoesBack && nodes_[q.node].event) return passes;
  return refracted_->unfound(sight_rays_.rays()[ray], sight_rays_.distance()[ray]).value_or(passes);
}

template <class Surfaces, class Space, class Throughputs, class Estimator>
void PathKernel<Surfaces, Space, Throughputs, Estimator>::shine_refracted() {
  if constexpr (Surfaces::kDense > 0) {
    if (refracted_) guides_.assign(nodes_.size(), {});
    for (const RefractedQuestion& q : refracted_questions_) {
      const Path& path = paths_[nodes_[q.node].path];
      const std::vector<size_t>& set = refracted_->interfaces().set_of();
      const Suffix behind = path.claims.behind_interface(false);
      for (size_t k = 0; k < knots(); ++k) {
        if (set[k] != k) continue;
        bool alive = false;  // else an interface on the path has parted it from these wavelengths
        for (size_t other = k; other < knots(); ++other) alive = alive || (set[other] == k && path.relative[other] > 0);
        const ClaimedLight light{ClaimedLight::Kind::small, q.light};
        // Chains that began before this scattering bring it.
        if (owner(path.claims.all(), behind, light, k) == Technique::volume_chains) continue;
        if (alive) shine_refracted(q, k);
      }
    }
    if (refracted_)
      for (const NodeAt& node : nodes_) ask_sky(node);
  }
}

// Leaves the bins whose light takes the ways of a knot's.
template <class Surfaces, class Space, class Throughputs, class Estimator>
void PathKernel<Surfaces, Space, Throughputs, Estimator>::keep_bins_of(size_t knot, std::span<float> through) const {
  const std::vector<size_t>& set = refracted_->interfaces().set_of();
  for (size_t i = 0; i < bins_; ++i) through[i] *= set[static_cast<size_t>(knot_of_bin_[i])] == knot ? 1.0f : 0.0f;
}

// What is left of light along a way that has been begun, per bin, and its optical length. False: nothing.
template <class Surfaces, class Space, class Throughputs, class Estimator>
bool PathKernel<Surfaces, Space, Throughputs, Estimator>::weaken(const Path& path, const RefractedWay& way, size_t knot,
                                                                 bool sky, std::span<float> through, double& arrival) {
  Ray ray{way.origin, way.direction, path.time, path.draw};
  for (int i = 0; i < way.events; ++i) {
    const RefractedEvent& at = way.at[i];
    if (contacts_.covers(ray, at.hit, touching_)) return false;
    arrival += at.length * space_.follow_way(ray, at.length, through, transmission_);
    at.model->delta_weight(at.out_local, refracted_->interfaces().lobe(at.material, at.reflected),
                           static_cast<int>(knot), transmission_);
    for (size_t b = 0; b < bins_; ++b) through[b] *= transmission_[b];
    if (!at.reflected) space_.cross_way(at.hit, at.material, at.in);
    ray.origin = surface_.tracer().leave(at.hit, at.in);
    ray.direction = at.in;
  }
  if (is_behind_earth(ray, way.length)) return false;
  if (sky) return true;
  const double delay = space_.follow_way(ray, way.length, through, transmission_);
  if (std::isfinite(way.length)) arrival += way.length * delay;  // far lights shine evenly in time
  return std::any_of(through.begin(), through.end(), [](float t) { return t != 0; });
}

template <class Surfaces, class Space, class Throughputs, class Estimator>
RefractedSight::Node PathKernel<Surfaces, Space, Throughputs, Estimator>::from_node(const NodeAt& node) const {
  const uint32_t p = node.path;
  const Path& path = paths_[p];
  RefractedSight::Node from;
  from.time = path.time, from.draw = path.draw;
  if (node.event) {
    if constexpr (Space::kScatters) from.place = space_.place(p);
  } else {
    const Hit& hit = hits_[node.slot];
    const LightReceiver at = surfaces_.receiver(p, hit, -path.direction);
    from.place = hit.position;
    from.hit = &hit;
    if (!at.two_sided) from.side = dot(path.direction, hit.normal) < 0 ? hit.normal : -hit.normal;
  }
  return from;
}

template <class Surfaces, class Space, class Throughputs, class Estimator>
void PathKernel<Surfaces, Space, Throughputs, Estimator>::shine_refracted(const RefractedQuestion& q, size_t knot) {
  const NodeAt& node = nodes_[q.node];
  const Path& path = paths_[node.path];
  constexpr uint64_t kPurpose = 0x62656e74;
  const uint64_t seed = hash_of(hash_of(path.stream.key(), kPurpose, path.sample), path.order(), q.light, knot);
  std::optional<RefractedWay> first;
  for (const RefractedWay& way : refracted_->find(from_node(node), q.end, knot, seed))
    if (shine_along(way, q, knot) && kGuides && !first) first = way;
  if (first && !ask_along_chain(q, first->direction, first->at[0].length, knot)) guide(q, *first);
}

template <class Surfaces, class Space, class Throughputs, class Estimator>
bool PathKernel<Surfaces, Space, Throughputs, Estimator>::shine_along(const RefractedWay& way,
                                                                      const RefractedQuestion& q, size_t knot) {
  const NodeAt& node = nodes_[q.node];
  const uint32_t p = node.path;
  const Path& path = paths_[p];
  if (!node.event && !surfaces_.takes(p, hits_[node.slot], -path.direction, way.direction)) return false;
  const std::span<float> through = dense(p, 3), memory = throughputs_.take(p);
  const Factor factor = evaluate(node, way.direction, memory);
  for (size_t i = 0; i < bins_; ++i) through[i] = factor.scale * (factor.spectrum ? factor.spectrum[i] : 1.0f);
  keep_bins_of(knot, through);
  space_.begin_way(p, node.event, hits_[node.slot], node.event ? kNone : surfaces_.material(p), -path.direction,
                   way.direction);
  return shine_behind(way, q, knot, {through, 0, 1, 0, way.direction});
}

// What comes along a way to where its beginning has been reached.
template <class Surfaces, class Space, class Throughputs, class Estimator>
bool PathKernel<Surfaces, Space, Throughputs, Estimator>::shine_behind(const RefractedWay& way,
                                                                       const RefractedQuestion& q, size_t knot,
                                                                       const Reached& reached) {
  const NodeAt& node = nodes_[q.node];
  const uint32_t p = node.path;
  const Path& path = paths_[p];
  const auto most = static_cast<uint32_t>(options_.max_nodes);
  if (most > 0 && path.surfaces + static_cast<uint32_t>(way.events) >= most) return false;
  double arrival = reached.arrival;
  if (!weaken(path, way, knot, q.sky, reached.through, arrival)) return false;
  const auto from_light = sent(q, way);
  if (!from_light) return false;
  WaterSeen water = WaterSeen::nothing;
  if (waters_.any()) {
    water = water_behind(node, reached.first);
    if (reached.scatterings > 0) water = Waters::behind_scattering(water);
    for (int i = 0; i < way.events; ++i)
      water = waters_.behind_surface(water, way.at[i].material, way.at[i].hit.normal, way.at[i].out, way.at[i].in);
    if (water == WaterSeen::mirrored && !q.end.far) water = WaterSeen::other;
  }
  for (const bool doubtful : {false, true}) {
    if (doubtful && !way.doubtful) break;
    Contribution& c = contribution(p, q.light);
    c.events |= by_surface | by_dirac;
    if (node.event || reached.scatterings > 0) c.events |= by_medium;
    c.asked = !q.sky;
    c.beam = q.beam;
    c.water = water;
    c.order += static_cast<uint32_t>(way.events) + reached.scatterings;
    c.smooth += static_cast<uint32_t>(way.events);
    c.scale = static_cast<float>(from_light->scale * way.spreading * way.trials * reached.scale);
    c.factor = {1, reached.through.data()};
    c.radiance = from_light->spectrum;
    c.arrival += arrival;
    if (doubtful) c.missed = 0;  // there may be as much again
    contribute();
  }
  return true;
}

// What a light sends along a way, per solid angle there; of a lamp per m2 across the way, over the density of the
// place.
template <class Surfaces, class Space, class Throughputs, class Estimator>
auto PathKernel<Surfaces, Space, Throughputs, Estimator>::sent(const RefractedQuestion& q, const RefractedWay& way)
    -> std::optional<Sent> {
  const NodeAt& node = nodes_[q.node];
  if (q.sky) {
    const std::span<float> own = throughputs_.take(node.path);
    return Sent{q.scale, space_.sky_behind({way.last, way.to, 0}, transmission_, own)};
  }
  const Light& light = *environment_.lights[q.light];
  const double when = time(node);
  if (q.end.far) {
    if (q.spectrum) return Sent{q.scale, q.spectrum};
    const std::span<float> own = throughputs_.take(node.path);  // its shape changes with direction
    std::fill(own.begin(), own.end(), 0.0f);
    light.add(q.end.direction, when, 1, own);
    return Sent{q.scale, own.data()};
  }
  if (q.end.surface) {
    if (!light.draws(way.lamp)) return std::nullopt;
    const double cosine = -dot(way.to, way.lamp.normal);
    const auto met =
        light.met_surface(receiver(node), way.lamp, surface_.material(way.lamp), way.to, way.length, cosine, when);
    if (!met) return std::nullopt;
    return Sent{q.scale * met->scale * std::fabs(cosine), met->spectrum};
  }
  const auto sample = light.sample_member(q.member, 1, {way.last, {}, true}, {}, when);
  if (!sample) return std::nullopt;
  return Sent{q.scale * sample->scale * sample->distance * sample->distance, sample->spectrum};
}

}  // namespace suite
