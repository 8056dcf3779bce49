// What a sample has to do with its sensor: the ray that it starts with, and the bin that its radiance goes into.
#pragma once
#include <span>

#include "math/sampling.h"
#include "sensor/sensor.h"
#include "transport/lane.h"

namespace suite {

// Asks the sensor for the ray of a sample. first: the sample's numbers of dimensions::kSensor; index: of the sample in
// the stream, which gives the others. weights: where the sensor may leave spectral weights, one a bin of the state.
SensorRay ask_ray(const Sensor& sensor, const Capture& capture, size_t problem, const std::array<double, 4>& first,
                  const SampleStream& stream, uint32_t index, std::span<float> weights);

// The bin of a capture that a path's radiance goes into, or Capture::bins when none is right.
size_t bin_of(const Capture& capture, const PathRecord& path);

}  // namespace suite
