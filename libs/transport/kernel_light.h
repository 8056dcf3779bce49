// Definitions of kernel.h: questions to lights, their answers, and how contributions are handed over.
#pragma once
#include <limits>

#include "transport/kernel.h"

namespace suite {

template <class Surfaces, class Space, class Throughputs, class Estimator>
std::array<double, 4> PathKernel<Surfaces, Space, Throughputs, Estimator>::numbers(const NodeAt& node,
                                                                                   dimensions::Use use) const {
  const Path& path = paths_[node.path];
  if (Space::kScatters && node.event) return dimensions::at_scattering(path.stream, path.sample, path.flights, use);
  return dimensions::at_surface(path.stream, path.sample, path.surfaces - 1, use);
}

template <class Surfaces, class Space, class Throughputs, class Estimator>
LightReceiver PathKernel<Surfaces, Space, Throughputs, Estimator>::receiver(const NodeAt& node) const {
  if constexpr (Space::kScatters)
    if (node.event) return {space_.place(node.path), {}, true};
  return surfaces_.receiver(node.path, hits_[node.slot], -paths_[node.path].direction);
}

template <class Surfaces, class Space, class Throughputs, class Estimator>
void PathKernel<Surfaces, Space, Throughputs, Estimator>::ask() {
  questions_.clear(), sight_rays_.clear(), space_.clear_sight();
  sight_rays_.first = first_stage_;
  for (const NodeAt& node : nodes_) {
    Path& path = paths_[node.path];
    path.u = numbers(node, dimensions::kOfScatter);
    if (!glows_) continue;
    path.last = receiver(node);
    path.last_length = path.length;
    path.last_draws = 1;
  }
  Estimator::ask(*this, options_);
  sight_rays_.blocked.resize(sight_rays_.size());
  space_.sight().begin(sight_rays_);
}

template <class Surfaces, class Space, class Throughputs, class Estimator>
void PathKernel<Surfaces, Space, Throughputs, Estimator>::propose(const NodeAt& node, const Asked& light,
                                                                  const LightSample& sample, int draws) {
  const uint32_t p = node.path;
  Path& path = paths_[p];
  const Hit& hit = hits_[node.slot];
  if (!(sample.scale > 0)) return;
  if (!node.event && !surfaces_.takes(p, hit, -path.direction, sample.direction)) return;
  if (!light.nature.far) path.last_draws = draws;
  Vec3 origin;
  if constexpr (Space::kScatters) {
    if (node.event) origin = space_.place(p);
  }
  if (!node.event) origin = surface_.tracer().leave(hit, sample.direction);
  Dir direction = sample.direction;
  double distance = sample.distance;
  if (distance < std::numeric_limits<double>::infinity()) {
    const Vec3 way = sample.end - origin;
    distance = length(way);
    if (!(distance > 0)) return;
    direction = way / distance;
  }
  if constexpr (Space::kScatters) {
    if (node.event)
      space_.see_from_event(p);
    else
      space_.see_from_surface(p, hit, surfaces_.material(p), -path.direction, direction);
  }
  sight_rays_.rays.emplace_back().set(origin, direction, path.time, path.draw);
  sight_rays_.distance.push_back(distance);
  sight_rays_.losable.push_back(!light.nature.wide);
  // Several samples are strata of one choice.
  const bool delta = !(sample.density > 0);
  questions_.push_back({static_cast<uint32_t>(&node - nodes_.data()), light.index, light.nature.disk,
                        light.nature.wide, sample.direction, delta ? 0 : sample.density * draws,
                        static_cast<float>(delta ? sample.scale / draws : sample.scale), sample.spectrum});
}

template <class Surfaces, class Space, class Throughputs, class Estimator>
void PathKernel<Surfaces, Space, Throughputs, Estimator>::answer() {
  for (size_t i = 0; i < questions_.size(); ++i) {
    const Question& q = questions_[i];
    double passes = 1;
    if (sight_rays_.blocked[i]) {
      passes = lost_ && !q.wide ? space_.sight().passes(i) : 0;
      if (!(passes > 0)) continue;
    }
    const Ray& ray = sight_rays_.rays[i];
    if (environment_.earth && environment_.earth->meet(ray.origin, ray.direction, sight_rays_.distance[i])) continue;
    shine(q, i, passes);
  }
}

// Density with which continuations are drawn towards `in` and get as far as the light, over all knots.
template <class Surfaces, class Space, class Throughputs, class Estimator>
double PathKernel<Surfaces, Space, Throughputs, Estimator>::chance(const NodeAt& node, Dir in,
                                                                   std::span<const double> reach) const {
  const Path& path = paths_[node.path];
  float density[kMaxKnots] = {};
  if constexpr (Space::kScatters)
    if (node.event) space_.densities(node.path, scattering_cosine(-path.direction, in), {density, knots_});
  if (!node.event) surfaces_.densities(node.path, -path.direction, in, {density, knots_});
  double sum = 0;
  for (size_t k = 0; k < knots_; ++k) sum += probability_[k] * path.relative[k] * density[k] * reach[k];
  return sum;
}

template <class Surfaces, class Space, class Throughputs, class Estimator>
Factor PathKernel<Surfaces, Space, Throughputs, Estimator>::evaluate(const NodeAt& node, Dir in,
                                                                     std::span<float> dense) {
  const Dir direction = paths_[node.path].direction;
  if constexpr (Space::kScatters)
    if (node.event) return space_.evaluate(node.path, scattering_cosine(-direction, in), dense);
  return surfaces_.evaluate(node.path, -direction, in, dense);
}

// A light that the node asked for arrives; or passes < 1 of it would, had smooth surfaces not bent it.
template <class Surfaces, class Space, class Throughputs, class Estimator>
void PathKernel<Surfaces, Space, Throughputs, Estimator>::shine(const Question& q, size_t i, double passes) {
  const NodeAt& node = nodes_[q.node];
  const uint32_t p = node.path;
  const bool arrives = !sight_rays_.blocked[i];
  double reach[kMaxKnots];
  std::fill_n(reach, knots_, 1.0);
  const bool dim =
      space_.dims(sight_rays_.rays[i], sight_rays_.distance[i], i, transmission_, std::span(reach, knots_));
  Contribution c = contribution(p, q.light);
  c.events |= node.event ? by_medium : by_surface;
  c.asked = true;
  double denominator = 1;
  const double by_chance = q.density > 0 || !arrives ? chance(node, q.direction, {reach, knots_}) : 0;
  if (q.density > 0) denominator = arrives ? Estimator::asked(q.density, by_chance, q.disk) : q.density;
  if (!arrives) {
    c.missed = q.density > 0 ? by_chance / q.density : 0;
    if (!(by_chance > 0) || c.missed > LostLight::kOftenMet) return;
  }
  c.scale = static_cast<float>(passes * q.scale / denominator);
  constexpr bool kNeeds = Surfaces::kDense > 0 || Space::kFills;
  const std::span<float> memory = kNeeds ? dense(p, 2) : std::span<float>{};
  c.factor = evaluate(node, q.direction, memory);
  if (dim) {
    for (size_t k = 0; k < bins_; ++k)
      memory[k] = (c.factor.spectrum ? c.factor.spectrum[k] : 1.0f) * transmission_[k];
    c.factor.spectrum = memory.data();
  }
  if (kNeeds && c.factor.spectrum != memory.data()) throughputs_.give_back(p);
  c.radiance = q.spectrum;
  if (!c.radiance) {  // its shape changes with direction
    const std::span<float> radiance = dense(p);
    std::fill(radiance.begin(), radiance.end(), 0.0f);
    environment_.lights[q.light]->add(q.direction, 1, radiance);
    c.radiance = radiance.data();
  }
  if (arrives && keep_first_ && q.light == environment_.sun && !node.event && is_first(node)) firsts_[p].sunlit = true;
  if (sight_rays_.distance[i] < std::numeric_limits<double>::infinity())
    c.arrival += space_.optical_way(p, i, sight_rays_.distance[i]);
  contribute(c);
}

// A contribution of path p as it stands. Far lights shine evenly in time: their arrival is that of the last event.
template <class Surfaces, class Space, class Throughputs, class Estimator>
Contribution PathKernel<Surfaces, Space, Throughputs, Estimator>::contribution(uint32_t p, uint16_t light) const {
  const Path& path = paths_[p];
  Contribution c;
  c.path = p;
  c.light = light;
  c.events = path.events;
  c.order = path.order();
  c.arrival = path.arrival;
  return c;
}

template <class Surfaces, class Space, class Throughputs, class Estimator>
void PathKernel<Surfaces, Space, Throughputs, Estimator>::hand_over() {
  if (contributions_.empty()) return;
  sink_.add(contributions_, throughputs_);
  contributions_.clear();
}

// Memory for one spectrum of path p, `count` of which will be asked for before anything else is handed over.
template <class Surfaces, class Space, class Throughputs, class Estimator>
std::span<float> PathKernel<Surfaces, Space, Throughputs, Estimator>::dense(uint32_t p, uint32_t count) {
  if (!throughputs_.has_room(p, count)) {
    hand_over();
    throughputs_.make_room(p);
  }
  return throughputs_.take(p);
}

}  // namespace suite
