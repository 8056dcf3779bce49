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
  path.begin(wave_.knots());
  if (techniques_.manifold.on()) path.claims.clear();  // else nobody makes or reads claims
  techniques_.splitting.start(p);
  if (wave_.knots() > 1)
    path.knot = Estimator::draw_knot(stream.hashed(sample, dimensions::kKnot), static_cast<int>(wave_.heroes.count));
  PathRecord& record = wave_.records[p];
  record.time = ray.ray.time, record.end = PathEnd::absorbed;
  record.truncated = record.leaked = 0;
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
        if (techniques_.manifold.on()) look_through();
        stage_ = Stage::look_through;
        break;
      case Stage::look_through:
        if (techniques_.manifold.next(wave_, techniques_.chains, techniques_.guide, request)) return true;
        resolve();
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
        stage_ = Stage::go_on;
        break;
      case Stage::go_on:
        go_on();
        stage_ = Stage::settle;
        break;
      case Stage::settle:
        if (techniques_.chains.next_settled(wave_, techniques_.manifold, request)) return true;
        end_stage();
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

}  // namespace suite
