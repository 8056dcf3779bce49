// Definitions of kernel.h: how it is made, and how paths start.
#pragma once
#include <algorithm>

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

}  // namespace suite
