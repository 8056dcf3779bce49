// What a sample has to do with its sensor: the ray that it starts with, and the bin that its radiance goes into.
#pragma once
#include <span>
#include <vector>

#include "math/sampling.h"
#include "sensor/sensor.h"
#include "trace/tracer.h"
#include "transport/lane.h"

namespace suite {

// Asks the sensor for the ray of a sample. first: the sample's numbers of dimensions::kSensor; index: of the sample in
// the stream, which gives the others. weights: where the sensor may leave spectral weights, one a bin of the state.
SensorRay ask_ray(const Sensor& sensor, const Capture& capture, size_t problem, const std::array<double, 4>& first,
                  const SampleStream& stream, uint32_t index, std::span<float> weights);

// Puts a ray that starts on a surface on that side of it to which the ray goes (a receiver: to which it faces), as far
// off as rays leave it; no other ray is changed. touched: memory. Returns whether it was on one.
bool stand_off(const Tracer& tracer, Ray& ray, std::vector<Hit>& touched, TraceStatistics& statistics);

// The bin of a capture that a path's radiance goes into, or Capture::bins when none is right.
size_t bin_of(const Capture& capture, const PathRecord& path);

}  // namespace suite
