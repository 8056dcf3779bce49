// Definitions of kernel.h: how paths start and fly.
#pragma once
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "transport/kernel.h"

namespace suite {

template <class Wave>
PathKernel<Wave>::PathKernel(const KernelContext& c, size_t width, Throughputs& throughputs, Sink<Throughputs>& sink)
    : wave_(c, width, throughputs, sink),
      keep_first_(c.keep_first),
      draws_(c.surface.tracer().has_holes() || wave_.lost),
      mirrors_(c.mirrors),
      above_(std::any_of(wave_.lights.outside.begin(), wave_.lights.outside.end(),
                         [](const SampledLight& light) { return light.nature.above; })),
      firsts_(c.keep_first ? width : 0),
      receivers_(c.receivers ? width : 0),
      rays_(width),
      flights_(Space::kFills ? width : 0) {
  techniques_.prepare(c, wave_);
  for (auto* list : {&active_, &received_, &onward_}) list->reserve(width);
  points_.reserve(width);
}

template <class Wave>
void PathKernel<Wave>::start(uint32_t p, const SensorRay& ray, const SampleStream& stream, uint32_t sample) {
  Path& path = wave_.paths[p];
  path.stream = stream, path.sample = sample;
  if (draws_) path.draw = static_cast<uint32_t>(hash_of(stream.key(), sample));
  path.origin = ray.ray.origin, path.direction = ray.ray.direction;
  path.time = ray.ray.time;
  path.length = path.arrival = path.last_density = 0;
  path.before = 1;
  path.surfaces = path.scatterings = path.smooth = path.flights = 0, path.events = 0;
  if (techniques_.manifold.on()) path.claims.clear();  // else nobody makes or reads claims
  path.branch = Branch::none, path.sided = false;
  path.share = 1;
  techniques_.splitting.start(p);
  path.water = WaterSeen::nothing, path.knot = 0;
  path.relative.start(wave_.knots());
  std::fill_n(path.throughput, wave_.knots(), 1.0);
  if (wave_.knots() > 1)
    path.knot = Estimator::draw_knot(stream.hashed(sample, dimensions::kKnot), static_cast<int>(wave_.heroes.count));
  PathRecord& record = wave_.records[p];
  record.time = ray.ray.time, record.end = PathEnd::absorbed;
  record.truncated = record.strayed = 0;
  record.scattered_first = record.met = false;
  record.received = ray.receiver != SensorRay::Receiver::none;
  path.received = record.received, path.points_apart = ray.points_apart && !Space::kMedia;
  if (mirrors_) FlatMirrors::begin(path);
  wave_.space.start(p, path);
  techniques_.residual.start(p);
  if (!record.received) return active_.push_back(p);
  receivers_[p] = ray.receiver;
  received_.push_back(p);
}

template <class Wave>
bool PathKernel<Wave>::next(TraceRequest& request) {
  for (;;) switch (stage_) {
      case Stage::leave:
        if (active_.empty() && received_.empty() && !techniques_.residual.any_returned()) {
          first_stage_ = true;
          return false;
        }
        stage_ = Stage::beside;
        if (active_.empty()) break;  // all start at receivers or places in the air
        request_hits(request);
        return true;
      case Stage::beside:
        stage_ = techniques_.equiangular.begin(wave_, active_) ? Stage::look_beside : Stage::arrive;
        nodes_met_ += techniques_.equiangular.take_nodes();
        break;
      case Stage::look_beside:
        if (wave_.space.sight().next(request)) return true;
        techniques_.equiangular.answer(wave_);
        stage_ = Stage::arrive;
        break;
      case Stage::arrive:
        if (first_stage_ && above_) see_from_above();
        if constexpr (Space::kFills) fly();
        arrive();
        sample_lights();
        stage_ = Stage::look;
        break;
      case Stage::look:
        if (wave_.space.sight().next(request)) return true;
        resolve();
        wave_.hand_over();
        stage_ = Stage::go_on;
        if (!techniques_.side.begin(wave_, request)) break;
        stage_ = Stage::fly_aside;
        return true;
      case Stage::fly_aside:
        nodes_met_ += techniques_.side.fly(wave_);
        stage_ = Stage::look_aside;
        break;
      case Stage::look_aside:
        if (wave_.space.sight().next(request)) return true;
        techniques_.side.answer(wave_);
        wave_.hand_over();
        stage_ = Stage::go_on;
        break;
      case Stage::go_on:
        go_on();
        first_stage_ = false;
        stage_ = Stage::leave;
        break;
    }
}

template <class Wave>
void PathKernel<Wave>::request_hits(TraceRequest& request) {
  const size_t n = active_.size();
  for (size_t i = 0; i < n; ++i) {
    const Path& path = wave_.paths[active_[i]];
    rays_[i].set(wave_.space.ray_from(active_[i], path), path.direction, path.time, path.draw);
  }
  request = {TraceRequest::Kind::nearest, {rays_.data(), n}, first_stage_, {wave_.hits.data(), n}, {}, {}};
}

// Whether anything but what fills space shines at a path that leaves the scene.
template <class Wave>
bool PathKernel<Wave>::meets_outside(const Path& path) const {
  return std::any_of(wave_.lights.outside.begin(), wave_.lights.outside.end(), [&](const SampledLight& light) {
    return light.light->met_outside(path.direction, path.time).has_value();
  });
}

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

// Flies every path to its next event, then weakens its light. Nothing may change a throughput before the contributions
// that were made with it have been handed over.
template <class Wave>
void PathKernel<Wave>::fly() {
  if (first_stage_) wave_.space.begin_wave();
  for (size_t i = 0; i < active_.size(); ++i) fly_one(i);
  wave_.hand_over();
  for (size_t i = 0; i < active_.size(); ++i) techniques_.residual.pass(wave_, active_[i], flights_[i].length);
  for (size_t i = 0; i < active_.size(); ++i)
    if (flights_[i].weakened) wave_.throughputs.attenuate(active_[i], flights_[i].through);
}

template <class Wave>
void PathKernel<Wave>::fly_one(size_t slot) {
  const uint32_t p = active_[slot];
  Path& path = wave_.paths[p];
  Hit& hit = wave_.hits[slot];
  const double length = wave_.way_to(hit, path);
  if (!wave_.throughputs.has_room(p, Space::kDense)) wave_.throughputs.make_room(p);
  const std::span<float> through = wave_.throughputs.take(p), emitted = wave_.throughputs.take(p);
  Contribution& c = wave_.contribution(p, Space::kEmitter);
  c.water = path.water;
  techniques_.residual.begin_flight(p, path);
  const double before = path.length;
  const bool ends = hit.hit() || length < std::numeric_limits<double>::infinity() || meets_outside(path);
  flights_[slot] = wave_.space.fly(p, path, wave_.records[p], hit, rays_[slot], length, ends, through, emitted);
  const Flight& flight = flights_[slot];
  const double flown = path.length - before;
  if (flight.arrival == Arrival::scattered) path.claims.scatter(flown);
  if (flight.arrival == Arrival::onward) path.claims.pass_boundary(flown);
  const bool leaves = flight.arrival == Arrival::met && length == std::numeric_limits<double>::infinity();
  c.radiance = leaves && techniques_.manifold.is_claimed(path, ClaimedLight::sky()) ? nullptr : flight.emitted;
  // The sky of the air was asked for, too.
  if (const Light* sky = c.radiance && length == std::numeric_limits<double>::infinity() ? wave_.space.sky() : nullptr)
    if (const double density = wave_.space.sky_density(path.direction);
        density > 0 && wave_.options.explicit_sources && path.last_density > 0)
      c.scale = static_cast<float>(Estimator::by_chance(sky->nature(), path.before * density / path.last_density));
  if constexpr (Wave::kStokes)
    if (c.radiance && Space::kEmitter == kFromAir) {
      // In a mirror neighbouring directions would be told apart.
      const bool scattered = path.last_density > 0 && length == std::numeric_limits<double>::infinity();
      c.radiance = wave_.polarise_air(scattered ? Wave::AirWay::sky : Wave::AirWay::exact, path.origin, path.direction,
                                      length, c.radiance);
      wave_.lit_by_air(c);
      wave_.contribute();
      return wave_.hand_over();  // the next way has other light
    }
  if (c.radiance) return wave_.contribute();
  wave_.throughputs.give_back(p);
  if (!flight.through.spectrum) wave_.throughputs.give_back(p);
}

}  // namespace suite
