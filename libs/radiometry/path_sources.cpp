// The part of the path generator that deals with sources of light: explicit samples at the nodes, and how much of a
// source counts that a path met by chance (the formulas stand in path_generator.h).
#include <algorithm>
#include <cmath>
#include <limits>

#include "radiometry/lost_light.h"
#include "radiometry/path_generator.h"
#include "radiometry/volume_paths.h"

namespace suite {

namespace {

constexpr double kFar = std::numeric_limits<double>::infinity();

// How lamps see a node: opaque surfaces take light on the side that the path sees.
LightReceiver receiver_of(const Node& node) {
  const bool opaque = node.at.baked->model->opaque();
  const Dir n = node.at.frame.z;
  return {node.at.position, opaque && dot(node.out, node.at.geometric_normal) < 0 ? -n : n, !opaque};
}

}  // namespace

void PathGenerator::escape(Path& path, const Live& live) const {
  path.end = PathEnd::escaped;
  path.escape = live.direction;
  path.escape_factor = 1 / live.shares;
  const bool by_chance = live.last_density > 0 && options_.explicit_sources;
  auto factor = [&](double density, bool disk) {
    if (!by_chance || !(density > 0)) return path.escape_factor;
    return paper_ ? 0 : 1 / shared_density(live.shares, live.shares_before * density / live.last_density, disk);
  };
  if (environment_.sky)
    path.sky_factor =
        factor(environment_.sky->tabulated() && !paper_ ? environment_.sky->density(live.direction) : 0, false);
  if (environment_.sun_disk && environment_.sun_disk->contains(live.direction))
    path.sun_factor = factor(environment_.sun_disk->density(), true);
  if (environment_.moon_disk && environment_.moon_disk->contains(live.direction))
    path.moon_factor = factor(environment_.moon_disk->density(), true);
}

// Proposes a sample of a source: a visibility ray of the given length, or to `end` when that is given.
void PathGenerator::ask(Wave& wave, uint32_t p, uint8_t slot, const ExplicitLight& light, double distance,
                        const Vec3* end) {
  Node& node = wave.node(p, wave.path(p).size - 1);
  const double in_side = dot(light.direction, node.at.geometric_normal);
  if (node.at.baked->model->opaque() && in_side * dot(node.out, node.at.geometric_normal) <= 0) return;
  // Light may come in only from the side of the surface that the shading frame says it comes from.
  if (in_side * dot(light.direction, node.at.frame.z) <= 0) return;
  node.light[slot] = light;
  const Vec3 origin = surface_.tracer().leave(node.hit, light.direction);
  Dir direction = light.direction;
  if (end) {
    const Vec3 way = *end - origin;
    distance = length(way);
    if (!(distance > 0)) return;
    direction = way / distance;
  }
  wave.rays.emplace_back().set(origin, direction, wave.path(p).ray.time, wave.path(p).ray.draw);
  wave.distance.push_back(distance);
  wave.owner.push_back(p);
  wave.light.push_back(slot);
}

// Sun and Moon.
void PathGenerator::ask_disks(Wave& wave, uint32_t p) {
  const Live& live = live_[p];
  auto ask_disk = [&](uint8_t slot, const Sun& disk, Vec2 u) {
    const DirectionSample drawn = disk.draw(u);
    ask(wave, p, slot, {drawn.direction, drawn.density, 1, disk.spectrum(), nullptr, 0}, kFar, nullptr);
  };
  if (environment_.sun_disk) ask_disk(light_sun, *environment_.sun_disk, {live.u[2], live.u[3]});
  if (!environment_.moon_disk) return;
  const std::array<double, 4> v =
      live.stream.draw(live.sample, kMoonBlock + static_cast<uint32_t>(wave.path(p).size - 1));
  ask_disk(light_moon, *environment_.moon_disk, {v[0], v[1]});
}

// Sky and lamps.
void PathGenerator::ask_around(Wave& wave, uint32_t p) {
  const Live& live = live_[p];
  if (environment_.sky && environment_.sky->tabulated()) {
    const std::array<double, 4> v =
        live.stream.draw(live.sample, kLobeBlock + static_cast<uint32_t>(wave.path(p).size - 1));
    const DirectionSample drawn = environment_.sky->draw({v[2], v[3]});
    const float* spectrum = environment_.sky->spectrum();
    const double relative = spectrum ? environment_.sky->relative(drawn.direction) : 1;
    if (relative > 0)
      ask(wave, p, light_sky, {drawn.direction, drawn.density, static_cast<float>(relative), spectrum, nullptr, 0},
          kFar, nullptr);
  }
  if (environment_.lamps) ask_lamps(wave, p);
}

void PathGenerator::ask_lamps(Wave& wave, uint32_t p) {
  const Live& live = live_[p];
  const int n = wave.path(p).size - 1;
  const std::array<double, 4> v = live.stream.draw(live.sample, kLampBlock + static_cast<uint32_t>(n));
  const LightReceiver at = receiver_of(wave.node(p, n));
  const int draws = lamp_draws(n);
  // Strata of the choice; the place on each lamp is the first one's, turned round.
  const auto turned = [](double u, int k) { return u + k * (1.0 / kLampDraws) - (u + k * (1.0 / kLampDraws) >= 1); };
  for (int k = 0; k < draws; ++k) {
    auto lamp = environment_.lamps->sample(at, {(k + v[0]) / draws, turned(v[1], k), turned(v[2], k), turned(v[3], k)},
                                           wave.path(p).ray.time);
    if (!lamp) continue;
    if (lamp->density > 0)
      lamp->density *= draws;
    else
      lamp->scale /= draws;
    ask_lamp(wave, p, k, lamp);
  }
}

void PathGenerator::ask_lamp(Wave& wave, uint32_t p, int draw, const std::optional<LightSample>& lamp) {
  if (!lamp) return;
  ask(wave, p, static_cast<uint8_t>(light_lamp + draw),
      {lamp->direction, lamp->density, static_cast<float>(lamp->scale), lamp->spectrum, nullptr, 0, lamp->distance},
      lamp->distance, &lamp->end);
}

// Method::paper: one of all sources, each as likely as the others.
void PathGenerator::ask_one(Wave& wave, uint32_t p) {
  const Live& live = live_[p];
  const int n = wave.path(p).size - 1;
  const Sun* disks[2] = {environment_.sun_disk, environment_.moon_disk};
  const size_t lamps = environment_.lamps ? environment_.lamps->size() : 0;
  const size_t sources = (disks[0] != nullptr) + (disks[1] != nullptr) + lamps;
  if (sources == 0) return;
  const std::array<double, 4> v = live.stream.draw(live.sample, kLampBlock + static_cast<uint32_t>(n));
  size_t chosen = std::min(sources - 1, static_cast<size_t>(v[0] * static_cast<double>(sources)));
  if (chosen < lamps)
    return ask_lamp(wave, p, 0,
                    environment_.lamps->sample_member(chosen, 1.0 / static_cast<double>(sources),
                                                      receiver_of(wave.node(p, n)), v, wave.path(p).ray.time));
  chosen -= lamps;
  const uint8_t slot = chosen == 0 && disks[0] ? light_sun : light_moon;
  const Sun& disk = slot == light_sun ? *disks[0] : *disks[1];
  const DirectionSample drawn = disk.draw({v[1], v[2]});
  ask(wave, p, slot, {drawn.direction, drawn.density, static_cast<float>(sources), disk.spectrum(), nullptr, 0}, kFar,
      nullptr);
}

// A surface met by chance may glow; what an explicit sample of it brings is shared with it.
void PathGenerator::meet_glow(Wave& wave, uint32_t p) {
  const Live& live = live_[p];
  const int n = wave.path(p).size - 1;
  Node& node = wave.node(p, n);
  const double cosine = dot(node.out, node.at.geometric_normal);
  node.glow = environment_.lamps->glow(node.at.material, cosine > 0);
  if (!node.glow) return;
  node.glow_factor = node.spectral_factor;
  if ((n == 0 && !live.scattered) || !options_.explicit_sources || !(live.last_density > 0)) return;
  if (paper_) {
    if (environment_.lamps->draws(node.hit)) node.glow = nullptr;
    return;
  }
  const LightReceiver from = live.scattered ? LightReceiver{live.place, {}, true} : receiver_of(wave.node(p, n - 1));
  // Boundaries of media may have been passed on the way.
  double distance = node.hit.distance;
  if (volume_ && surface_.tracer().periodic())
    distance = node.optical_length - (live.scattered ? live.length_at_place : wave.node(p, n - 1).optical_length);
  else if (volume_)
    distance = length(node.hit.position - from.position);
  const int draws = live.scattered ? 1 : lamp_draws(n - 1);
  const double density = draws * environment_.lamps->density(from, node.hit, -node.out, distance, cosine);
  if (density > 0) node.glow_factor = 1 / (live.shares + live.shares_before * density / live.last_density);
}

// Adds a visible sample: as a factored light of the node, or to its direct radiance.
void PathGenerator::add_explicit(Wave& wave, uint32_t p, uint8_t slot, size_t ray) {
  const int n = wave.path(p).size - 1;
  Node& node = wave.node(p, n);
  ExplicitLight& light = node.light[slot];
  const Live& live = live_[p];
  const ScatterModel& model = *node.at.baked->model;
  const Dir out = node.at.frame.to_local(node.out), in = node.at.frame.to_local(light.direction);
  double reach[kMaxKnots];
  std::fill_n(reach, knots_, 1.0);
  const bool dim = volume_ && volume_->dims(ray, transmission_, {reach, knots_});
  double denominator = live.shares;
  if (light.density > 0)
    denominator =
        shared_density(live.shares * light.density,
                       paper_ ? 0 : density_by_chance(live, model, out, in, {reach, knots_}), slot <= light_moon);
  const float scale = static_cast<float>(light.radiance_scale / denominator);
  const Atmosphere* air = environment_.atmosphere.get();
  if (light.spectrum && !air && !dim) {
    if (const auto factored = model.factored(out, in)) {
      light.scatter = factored->spectrum;
      light.scale = scale * factored->scale;
      node.lights |= static_cast<uint8_t>(1u << slot);
      return;
    }
  }
  const std::span<float> w = wave.scratch();
  model.eval(out, in, w);
  if (dim)
    for (size_t i = 0; i < w.size(); ++i) w[i] *= transmission_[i];
  const std::span<float> direct = wave.direct(p, n);
  if (!node.has_direct) std::fill(direct.begin(), direct.end(), 0.0f);
  node.has_direct = true;
  add_shining(wave, node, light, scale, direct);
}

double PathGenerator::density_by_chance(const Live& live, const ScatterModel& model, Dir out, Dir in,
                                        std::span<const double> reach) const {
  float pdf[kMaxKnots];
  model.pdf(out, in, {pdf, knots_});
  double sum = 0;
  for (size_t k = 0; k < knots_; ++k) sum += knot_probability_[k] * live.relative[k] * pdf[k] * reach[k];
  return sum;
}

void PathGenerator::add_shining(Wave& wave, const Node& node, const ExplicitLight& light, float scale,
                                std::span<float> sum) const {
  const Atmosphere* air = environment_.atmosphere.get();
  const std::span<float> w = wave.scratch();
  if (!light.spectrum || air) {
    // What arrives, as a spectrum of its own: the sky's in this direction, through the air.
    const std::span<float> arriving = wave.scratch2();
    if (air)
      air->transmittance(node.at.position, light.direction, light.distance, arriving);
    else
      std::fill(arriving.begin(), arriving.end(), 1.0f);
    for (size_t i = 0; i < w.size(); ++i) w[i] *= arriving[i];
    std::fill(arriving.begin(), arriving.end(), 0.0f);
    if (light.spectrum)
      std::copy_n(light.spectrum, arriving.size(), arriving.begin());
    else
      environment_.sky->add(light.direction, 1, arriving);
    for (size_t i = 0; i < w.size(); ++i) sum[i] += w[i] * arriving[i] * scale;
    return;
  }
  for (size_t i = 0; i < w.size(); ++i) sum[i] += w[i] * light.spectrum[i] * scale;
}

void PathGenerator::look_for_lost(Wave& wave, TraceStatistics& statistics) {
  if (!volume_) {  // with media, visibility has found it on its way
    lost_->begin(wave.rays.size());
    for (size_t i = 0; i < wave.rays.size(); ++i)
      if (wave.blocked[i] && wave.light[i] != light_sky) lost_->want(i);
    lost_->look(wave.rays, wave.distance, statistics);
  }
  for (size_t i = 0; i < wave.rays.size(); ++i) {
    if (!wave.blocked[i] || wave.light[i] == light_sky) continue;
    const double passes = volume_ ? volume_->passes(i) : lost_->passes(i);
    if (passes > 0) miss(wave, wave.owner[i], wave.light[i], i, passes);
  }
}

void PathGenerator::miss(Wave& wave, uint32_t p, uint8_t slot, size_t ray, double passes) {
  if (environment_.earth &&
      environment_.earth->meet(wave.rays[ray].origin, wave.rays[ray].direction, wave.distance[ray]))
    return;
  const Live& live = live_[p];
  Path& path = wave.path(p);
  Node& node = wave.node(p, path.size - 1);
  const ExplicitLight& light = node.light[slot];
  double reach[kMaxKnots];
  std::fill_n(reach, knots_, 1.0);
  const bool dim = volume_ && volume_->dims(ray, transmission_, {reach, knots_});
  const ScatterModel& model = *node.at.baked->model;
  const Dir out = node.at.frame.to_local(node.out), in = node.at.frame.to_local(light.direction);
  const double by_chance = density_by_chance(live, model, out, in, {reach, knots_});
  const double chance = light.density > 0 ? by_chance / (live.shares * light.density) : 0;
  if (!(by_chance > 0) || chance > LostLight::kOftenMet) return;
  const std::span<float> w = wave.scratch();
  model.eval(out, in, w);
  if (dim)
    for (size_t i = 0; i < w.size(); ++i) w[i] *= transmission_[i];
  const std::span<float> missed = wave.missed(p, path.size - 1);
  if (!node.has_missed) std::fill(missed.begin(), missed.end(), 0.0f);
  node.has_missed = true;
  path.missed_chance = std::min(path.missed_chance, chance);
  const double density = live.shares * (light.density > 0 ? light.density : 1);
  add_shining(wave, node, light, static_cast<float>(passes * light.radiance_scale / density), missed);
}

}  // namespace suite
