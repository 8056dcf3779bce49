// Definitions of kernel.h: next-event estimation (NEE): light samples, shadow rays, handing over of contributions.
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

// Whether anything but what fills space shines at a path that leaves the scene.
template <class Surfaces, class Space, class Throughputs, class Estimator>
bool PathKernel<Surfaces, Space, Throughputs, Estimator>::meets_outside(const Path& path) const {
  return std::any_of(outside_.begin(), outside_.end(), [&](const Asked& light) {
    return light.light->met_outside(path.direction, path.time).has_value();
  });
}

template <class Surfaces, class Space, class Throughputs, class Estimator>
LightReceiver PathKernel<Surfaces, Space, Throughputs, Estimator>::receiver(const NodeAt& node) const {
  if constexpr (Space::kScatters)
    if (node.event) return {space_.place(node.path), {}, true};
  return surfaces_.receiver(node.path, hits_[node.slot], -paths_[node.path].direction);
}

template <class Surfaces, class Space, class Throughputs, class Estimator>
void PathKernel<Surfaces, Space, Throughputs, Estimator>::ask() {
  sight_rays_.clear(), space_.clear_sight(), refracted_questions_.clear();
  sight_rays_.first = first_stage_;
  points_.clear();
  if constexpr (Surfaces::kDense > 0)
    if (gloss_) find_gloss();
  for (const NodeAt& node : nodes_) {
    Path& path = paths_[node.path];
    const uint32_t block = Space::kScatters && node.event
                               ? dimensions::block_at_scattering(path.flights, dimensions::kOfScatter)
                               : dimensions::block_at_surface(path.surfaces - 1, dimensions::kOfScatter);
    if (block == dimensions::kHashed)
      path.u = numbers(node, dimensions::kOfScatter);
    else
      points_.push_back(path.stream.point(path.sample, block, path.u));
    if (glowing_.empty()) continue;
    last_[node.path] = {receiver(node), path.length, 1};
  }
  SampleStream::draw(points_);
  Estimator::ask(*this, options_);
  if (refracted_) want_places();
  space_.sight().begin(sight_rays_);
}

template <class Surfaces, class Space, class Throughputs, class Estimator>
void PathKernel<Surfaces, Space, Throughputs, Estimator>::propose(const NodeAt& node, const Asked& light,
                                                                  const LightSample& sample, int draws, double asks) {
  const uint32_t p = node.path;
  const Path& path = paths_[p];
  const Hit& hit = hits_[node.slot];
  if (!(sample.scale > 0)) return;
  if (refracted_ && light.nature.far && is_refracted(light.nature)) want_refracted(node, light, sample);
  if (Space::kGoesBack && node.event && light.index == kFromAir) return;  // the same as over the even ground
  if (!node.event && !surfaces_.takes(p, hit, -path.direction, sample.direction)) return;
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
  // Several samples are strata of one choice.
  const bool delta = !(sample.density > 0);
  questions_[sight_rays_.size()] = {static_cast<uint32_t>(&node - nodes_.data()),
                                    light.index,
                                    light.nature.disk,
                                    light.nature.wide,
                                    light.beam,
                                    sample.direction,
                                    delta ? 0 : sample.density * draws,
                                    static_cast<float>((delta ? sample.scale / draws : sample.scale) / asks),
                                    sample.spectrum};
  sight_rays_.add(distance, !light.nature.wide).set(origin, direction, path.time, path.draw);
}

template <class Surfaces, class Space, class Throughputs, class Estimator>
void PathKernel<Surfaces, Space, Throughputs, Estimator>::answer() {
  shine_refracted();
  const std::span<const uint8_t> blocked = sight_rays_.blocked();
  for (size_t i = 0; i < blocked.size(); ++i) {
    const Question& q = questions_[i];
    const Ray& ray = sight_rays_.rays()[i];
    const bool behind_earth = is_behind_earth(ray, sight_rays_.distance()[i]);
    if constexpr (Space::kGoesBack)
      if (nodes_[q.node].event && q.beam && space_.in_air(nodes_[q.node].path)) {
        lack(q, i, blocked[i] || behind_earth);  // it shines in the even field already
        continue;
      }
    double passes = 1;
    if (blocked[i]) {
      passes = lost_ && !q.wide ? space_.sight().passes(i) : 0;
      if (passes > 0) passes = lost(q, i, passes);
      if (!(passes > 0)) continue;
    }
    if (!behind_earth) shine(q, i, passes);
  }
}

// Density with which continuations are drawn towards `in` and get as far as the light, over all knots.
template <class Surfaces, class Space, class Throughputs, class Estimator>
double PathKernel<Surfaces, Space, Throughputs, Estimator>::chance(const NodeAt& node, Dir in,
                                                                   std::span<const double> reach) const {
  const Path& path = paths_[node.path];
  float density[kMaxKnots] = {};
  if constexpr (Space::kScatters)
    if (node.event) space_.densities(node.path, -path.direction, in, {density, knots()});
  if (!node.event) {
    surfaces_.densities(node.path, -path.direction, in, {density, knots()});
    if constexpr (Surfaces::kDense > 0) share_with_gloss(node, in, {density, knots()});
  }
  if constexpr (Surfaces::kKnots == 1) return density[0] * reach[0];
  return path.relative.mean(P(), density, reach);
}

template <class Surfaces, class Space, class Throughputs, class Estimator>
Factor PathKernel<Surfaces, Space, Throughputs, Estimator>::evaluate(const NodeAt& node, Dir in,
                                                                     std::span<float> dense) {
  const Dir direction = paths_[node.path].direction;
  if constexpr (Space::kScatters)
    if (node.event) return space_.evaluate(node.path, scattering_cosine(-direction, in), dense);
  return surfaces_.evaluate(node.path, -direction, in, dense);
}

// A beam that the air has been given comes to a place in it in part, or not at all.
template <class Surfaces, class Space, class Throughputs, class Estimator>
void PathKernel<Surfaces, Space, Throughputs, Estimator>::lack(const Question& q, size_t i, bool blocked) {
  const NodeAt& node = nodes_[q.node];
  if (!space_.lacks(sight_rays_.rays()[i], sight_rays_.distance()[i], i, blocked, transmission_)) return;
  const std::span<float> memory = dense(node.path, 2);
  evaluate(node, q.direction, memory);
  for (size_t k = 0; k < bins_; ++k) memory[k] *= transmission_[k];
  const float* radiance = q.spectrum;
  if (!radiance) {
    const std::span<float> own = dense(node.path);
    std::fill(own.begin(), own.end(), 0.0f);
    environment_.lights[q.light]->add(q.direction, sight_rays_.rays()[i].time, 1, own);
    radiance = own.data();
  }
  Contribution& c = contribution(node.path, q.light);
  c.asked = c.beam = true;
  if (waters_.any()) c.water = water_behind(node, q.direction);
  c.scale = static_cast<float>(-q.scale / (q.density > 0 ? q.density : 1));
  c.factor = {1, memory.data()};
  c.radiance = radiance;
  contribute();
}

// A light that the node asked for arrives; or passes < 1 of it would, had smooth surfaces not bent it.
template <class Surfaces, class Space, class Throughputs, class Estimator>
void PathKernel<Surfaces, Space, Throughputs, Estimator>::shine(const Question& q, size_t i, double passes) {
  const NodeAt& node = nodes_[q.node];
  const uint32_t p = node.path;
  const bool arrives = !sight_rays_.blocked()[i];
  const double distance = sight_rays_.distance()[i];
  double reach[kMaxKnots];
  std::fill_n(reach, knots(), 1.0);
  // The air's own light comes as it is.
  const bool of_air = q.light == kFromAir;
  const bool dim = !of_air && space_.dims(sight_rays_.rays()[i], distance, i, transmission_, std::span(reach, knots()));
  double denominator = 1, missed = std::numeric_limits<double>::infinity();
  const double by_chance = q.density > 0 || !arrives ? chance(node, q.direction, {reach, knots()}) : 0;
  if (q.density > 0) denominator = arrives ? Estimator::asked(q.density, by_chance, q.disk) : q.density;
  if (!arrives) {
    missed = q.density > 0 ? by_chance / q.density : 0;
    if (!(by_chance > 0) || missed > LostLight::kOftenMet) return;
  }
  constexpr bool kNeeds = Surfaces::kDense > 0 || Space::kFills;
  const std::span<float> memory = kNeeds ? dense(p, 2) : std::span<float>{};
  Factor factor = evaluate(node, q.direction, memory);
  if (dim) {
    for (size_t k = 0; k < bins_; ++k) memory[k] = (factor.spectrum ? factor.spectrum[k] : 1.0f) * transmission_[k];
    factor.spectrum = memory.data();
  }
  if (kNeeds && factor.spectrum != memory.data()) throughputs_.give_back(p);
  const float* radiance = q.spectrum;
  if (!radiance) {  // its shape changes with direction
    const std::span<float> own = dense(p);
    if (of_air) {
      radiance = space_.sky_radiance(sight_rays_.rays()[i], transmission_, own);
      if (radiance != own.data()) throughputs_.give_back(p);
    } else {
      std::fill(own.begin(), own.end(), 0.0f);
      environment_.lights[q.light]->add(q.direction, sight_rays_.rays()[i].time, 1, own);
      radiance = own.data();
    }
  }
  if (arrives && keep_first_ && q.light == environment_.sun && !node.event && is_first(node)) firsts_[p].sunlit = true;
  Contribution& c = contribution(p, q.light);
  c.events |= node.event ? by_medium : by_surface;
  c.asked = true, c.beam = q.beam;
  if (waters_.any()) {
    c.water = water_behind(node, q.direction);
    if (c.water == WaterSeen::mirrored && distance < std::numeric_limits<double>::infinity())
      c.water = WaterSeen::other;
  }
  c.scale = static_cast<float>(passes * q.scale / denominator * beside_sides(node, q.light));
  c.factor = factor;
  c.radiance = radiance;
  c.missed = static_cast<float>(missed);
  if (distance < std::numeric_limits<double>::infinity()) {
    // From the surface itself: the ray starts some float places off it.
    const double off = node.event ? 0 : step_along(hits_[node.slot], q.direction);
    c.arrival += space_.optical_way(p, i, distance + off);
  }
  if constexpr (kStokes) c.polarised = polarise(node, q.direction);
  contribute();
  if constexpr (kStokes) hand_over();  // the next light has other matrices
}

template <class Surfaces, class Space, class Throughputs, class Estimator>
WaterSeen PathKernel<Surfaces, Space, Throughputs, Estimator>::water_behind(const NodeAt& node, Dir in) const {
  const Path& path = paths_[node.path];
  if (node.event) return Waters::behind_scattering(path.water);
  return waters_.behind_surface(path.water, surfaces_.material(node.path), hits_[node.slot].normal, -path.direction,
                                in);
}

// Far lights shine evenly in time: their arrival is that of the last event.
template <class Surfaces, class Space, class Throughputs, class Estimator>
Contribution& PathKernel<Surfaces, Space, Throughputs, Estimator>::contribution(uint32_t p, uint16_t light) {
  if (pending_ == contributions_.size()) hand_over();
  const Path& path = paths_[p];
  Contribution& c = contributions_[pending_];
  c.path = p;
  c.light = light;
  c.events = path.events;
  c.asked = c.beam = false;
  c.water = path.water == WaterSeen::mirrored ? WaterSeen::other : path.water;
  c.order = path.order();
  c.smooth = path.smooth;
  c.scale = 1;
  c.factor = {};
  c.radiance = nullptr;
  c.arrival = path.arrival;
  c.missed = std::numeric_limits<float>::infinity();
  c.polarised = nullptr, c.unknown = 0;
  return c;
}

template <class Surfaces, class Space, class Throughputs, class Estimator>
void PathKernel<Surfaces, Space, Throughputs, Estimator>::hand_over() {
  if (pending_ == 0) return;
  sink_.add({contributions_.data(), pending_}, throughputs_);
  pending_ = 0;
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
