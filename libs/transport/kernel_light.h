// Definitions of kernel.h: next-event estimation (NEE): light samples, shadow rays, contributions.
#pragma once
#include <limits>

#include "transport/kernel.h"
#include "transport/techniques/suffix_throughput.h"

namespace suite {

template <class Wave>
void PathKernel<Wave>::sample_lights() {
  wave_.sight_rays.clear(), wave_.space.clear_sight();
  techniques_.manifold.begin();
  wave_.sight_rays.first = first_stage_;
  points_.clear();
  techniques_.caustics.find(wave_);
  techniques_.ends.find(wave_);
  for (const PathNode& node : wave_.nodes) {
    Path& path = wave_.paths[node.path];
    const uint32_t block = Space::kScatters && node.event
                               ? dimensions::block_at_scattering(path.flights, dimensions::kOfScatter)
                               : dimensions::block_at_surface(path.surfaces - 1, dimensions::kOfScatter);
    if (block == dimensions::kHashed)
      path.u = wave_.numbers(node, dimensions::kOfScatter);
    else
      points_.push_back(path.stream.point(path.sample, block, path.u));
    if (wave_.lights.glowing.empty()) continue;
    wave_.last[node.path] = {wave_.receiver(node), path.length, 1};
  }
  SampleStream::draw(points_);
  Estimator::sample_lights(*this, wave_.options);
  if (techniques_.manifold.on()) techniques_.manifold.want_places(wave_);
  wave_.space.sight().begin(wave_.sight_rays);
}

template <class Wave>
void PathKernel<Wave>::expect(size_t n) {
  wave_.sight_rays.expect(n);
  if (questions_.size() < wave_.sight_rays.size() + n) questions_.resize(2 * (wave_.sight_rays.size() + n));
}

template <class Wave>
void PathKernel<Wave>::set_draws(const PathNode& node, const SampledLight& light, int draws) {
  if (!light.nature.far && !wave_.lights.glowing.empty()) wave_.last[node.path].draws = draws;
}

template <class Wave>
void PathKernel<Wave>::connect(const PathNode& node, const SampledLight& light, const LightSample& sample, int draws,
                               double asks) {
  const uint32_t p = node.path;
  const Path& path = wave_.paths[p];
  const Hit& hit = wave_.hits[node.slot];
  if (!(sample.scale > 0)) return;
  if (techniques_.manifold.on() && light.nature.far && is_refracted(light.nature))
    techniques_.manifold.want(wave_, node, light, sample);
  if (wave_.in_air(node) && light.index == kFromAir) return;  // the same as over the even ground
  if (!node.event && !wave_.surfaces.takes(p, hit, -path.direction, sample.direction)) return;
  Vec3 origin;
  if constexpr (Space::kScatters) {
    if (node.event) origin = wave_.space.place(p);
  }
  if (!node.event) origin = wave_.surface.tracer().leave(hit, sample.direction);
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
      wave_.space.see_from_event(p);
    else
      wave_.space.see_from_surface(p, hit, wave_.surfaces.material(p), -path.direction, direction);
  }
  // Several samples are strata of one choice.
  const bool delta = !(sample.density > 0);
  questions_[wave_.sight_rays.size()] = {static_cast<uint32_t>(wave_.number_of(node)),
                                         light.index,
                                         light.nature.disk,
                                         light.nature.wide,
                                         light.beam,
                                         sample.direction,
                                         delta ? 0 : sample.density * draws,
                                         static_cast<float>((delta ? sample.scale / draws : sample.scale) / asks),
                                         sample.spectrum,
                                         sample.source};
  wave_.sight_rays.add(distance, !light.nature.wide).set(origin, direction, path.time, path.draw);
}

// What techniques look for through smooth interfaces, once shadow rays are known.
template <class Wave>
void PathKernel<Wave>::look_through() {
  techniques_.manifold.look(wave_, techniques_.chains, techniques_.guide);
  const std::span<const uint8_t> blocked = wave_.sight_rays.blocked();
  for (size_t i = 0; wave_.lost && i < blocked.size(); ++i)
    if (blocked[i] && !questions_[i].wide && wave_.space.sight().passes(i) > 0)
      techniques_.manifold.want_lost(wave_, questions_[i], i);
}

template <class Wave>
void PathKernel<Wave>::resolve() {
  const std::span<const uint8_t> blocked = wave_.sight_rays.blocked();
  for (size_t i = 0; i < blocked.size(); ++i) {
    const Question& q = questions_[i];
    const Ray& ray = wave_.sight_rays.rays()[i];
    const bool behind_earth = wave_.is_behind_earth(ray, wave_.sight_rays.distance()[i]);
    if constexpr (Space::kGoesBack)
      if (q.beam && wave_.in_air(wave_.nodes[q.node])) {
        lack(q, i, blocked[i] || behind_earth);  // it shines in the even field already
        continue;
      }
    double passes = 1;
    if (blocked[i]) {
      passes = wave_.lost && !q.wide ? wave_.space.sight().passes(i) : 0;
      if (passes > 0) passes = techniques_.manifold.lost(wave_, q, i, passes);
      if (!(passes > 0)) continue;
    }
    if (!behind_earth) shine(q, i, passes);
  }
  wave_.hand_over();
}

// Density with which continuations are drawn towards `in` and get as far as the light, over all hero wavelengths.
template <class Wave>
double PathKernel<Wave>::chance(const PathNode& node, Dir in, std::span<const double> reach) const {
  const Path& path = wave_.paths[node.path];
  float density[kMaxKnots] = {};
  if constexpr (Space::kScatters)
    if (node.event) wave_.space.densities(node.path, -path.direction, in, {density, wave_.knots()});
  if (!node.event) {
    wave_.surfaces.densities(node.path, -path.direction, in, {density, wave_.knots()});
    if constexpr (Surfaces::kDense > 0) techniques_.caustics.share(wave_, node, in, {density, wave_.knots()});
  }
  if (goes_to_end(node)) techniques_.ends.share(wave_, node, in, {density, wave_.knots()});
  if constexpr (Surfaces::kKnots == 1) return density[0] * reach[0];
  return path.relative.mean(wave_.P(), density, reach);
}

// The spectrum of a sample whose shape changes with direction, in memory of its path.
template <class Wave>
const float* PathKernel<Wave>::spectrum_of(const Question& q, size_t i) {
  const uint32_t p = wave_.nodes[q.node].path;
  const Ray& ray = wave_.sight_rays.rays()[i];
  const std::span<float> own = wave_.dense(p);
  if (q.light == kFromAir) {
    const float* const radiance = wave_.space.sky_radiance(ray, wave_.transmission, own);
    if (radiance != own.data()) wave_.throughputs.give_back(p);
    if constexpr (Wave::kStokes)
      return wave_.polarise_air(Wave::AirWay::sky, ray.origin, q.direction, wave_.sight_rays.distance()[i], radiance);
    return radiance;
  }
  std::fill(own.begin(), own.end(), 0.0f);
  wave_.environment.lights[q.light]->add(q.direction, ray.time, 1, own);
  return own.data();
}

// A beam that the air has been given comes to a place in it in part, or not at all.
template <class Wave>
void PathKernel<Wave>::lack(const Question& q, size_t i, bool blocked) {
  const PathNode& node = wave_.nodes[q.node];
  if (!wave_.space.lacks(wave_.sight_rays.rays()[i], wave_.sight_rays.distance()[i], i, blocked, wave_.transmission))
    return;
  SuffixThroughput<Wave> suffix(wave_, wave_.dense(node.path, 2));
  suffix.leave_as_is(node, q.direction);
  suffix.weaken_as_is(wave_.transmission);
  const float* const radiance = q.spectrum ? q.spectrum : spectrum_of(q, i);
  Contribution& c = wave_.contribution(node.path, q.light);
  c.asked = c.beam = true;
  if (wave_.waters.any()) c.water = wave_.water_behind(node, q.direction);
  c.scale = static_cast<float>(-q.scale / (q.density > 0 ? q.density : 1));
  c.factor = suffix.as_is();
  c.radiance = radiance;
  wave_.contribute();
}

// A light sample arrives; or passes < 1 of it would, had smooth surfaces not bent it.
template <class Wave>
void PathKernel<Wave>::shine(const Question& q, size_t i, double passes) {
  const PathNode& node = wave_.nodes[q.node];
  const uint32_t p = node.path;
  const bool arrives = !wave_.sight_rays.blocked()[i];
  const double distance = wave_.sight_rays.distance()[i];
  double reach[kMaxKnots];
  std::fill_n(reach, wave_.knots(), 1.0);
  // The air's own light comes as it is.
  const bool of_air = q.light == kFromAir;
  const bool dim = !of_air && wave_.space.dims(wave_.sight_rays.rays()[i], distance, i, wave_.transmission,
                                               std::span(reach, wave_.knots()));
  double denominator = 1, missed = std::numeric_limits<double>::infinity();
  const double by_chance = q.density > 0 || !arrives ? chance(node, q.direction, {reach, wave_.knots()}) : 0;
  if (q.density > 0) denominator = arrives ? Estimator::asked(q.density, by_chance, q.disk) : q.density;
  if (!arrives) {
    missed = q.density > 0 ? by_chance / q.density : 0;
    if (!(by_chance > 0) || missed > LostLight::kOftenMet) return;
  }
  constexpr bool kNeeds = Surfaces::kDense > 0 || Space::kFills;
  SuffixThroughput<Wave> suffix(wave_, kNeeds ? wave_.dense(p, 2) : std::span<float>{});
  suffix.leave_as_is(node, q.direction);
  if (dim) suffix.weaken_as_is(wave_.transmission);
  if (kNeeds && !suffix.stands_in_memory()) wave_.throughputs.give_back(p);
  const float* const radiance = q.spectrum ? q.spectrum : spectrum_of(q, i);
  if (arrives && keep_first_ && q.light == wave_.environment.sun && !node.event && wave_.is_first(node))
    firsts_[p].sunlit = true;
  Contribution& c = wave_.contribution(p, q.light);
  c.events |= node.event ? by_medium : by_surface;
  c.asked = true, c.beam = q.beam;
  if (wave_.waters.any()) {
    c.water = wave_.water_behind(node, q.direction);
    if (c.water == WaterSeen::mirrored && distance < std::numeric_limits<double>::infinity())
      c.water = WaterSeen::other;
  }
  const bool point = arrives && !(q.density > 0) && distance < std::numeric_limits<double>::infinity();
  c.scale = static_cast<float>(passes * q.scale / denominator * techniques_.side.beside(wave_, node, q.light) *
                               techniques_.equiangular.beside(wave_, node, q.light, point));
  c.factor = suffix.as_is();
  c.radiance = radiance;
  c.missed = static_cast<float>(missed);
  if (distance < std::numeric_limits<double>::infinity()) {
    // From the surface itself: the ray starts some float places off it.
    const double off = node.event ? 0 : step_along(wave_.hits[node.slot], q.direction);
    c.arrival += wave_.space.optical_way(p, i, distance + off);
  }
  if constexpr (Wave::kStokes) {
    c.polarised = wave_.polarise(node, q.direction);
    if (of_air) wave_.lit_by_air(c);
    wave_.leaves(c, q.source, -q.direction, wave_.time(node));
  }
  wave_.contribute();
  if constexpr (Wave::kStokes) wave_.hand_over();  // the next light has other matrices
}

}  // namespace suite
