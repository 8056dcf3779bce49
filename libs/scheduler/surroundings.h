// What surfaces that refract are surrounded by, against what they refract for.
//
// A surface bends light by one index, of its back over its front, from the two media that its material names; what a
// scene puts in front of it is not asked. Glass in water whose material names no `outside` bends light as in air. And
// of two refracting faces that lie in each other, a path takes the first and starts beyond the second.
#pragma once
#include <string>
#include <vector>

#include "scheduler/shortfall.h"
#include "sensor/sensor.h"
#include "surface/surface.h"

namespace suite {

// Diagnostics of refracting surfaces with another index in front or behind than they are made for (by more than
// kApart), about those that lie in each other, about bodies of media of equal priority that overlap in part, and about
// boundaries that part media of different indices and bend nothing; and about matter so dense that what rays skip where
// they leave a surface of a large object counts (kSkipped of the light). Looked for along a few rays through each
// refracting object, so that what is small may be missed.
constexpr double kApart = 0.02, kSkipped = 1e-3;
std::vector<Diagnostic> diagnose_surroundings(const Tracer& tracer, const Optics& optics);

// These, after what paths of at most so many a problem will not find (diagnose_lost_light), for a sensor that sees
// polarisation which techniques are off, and which surfaces have no images of stars (diagnose_points).
std::vector<Diagnostic> diagnose_light_paths(const Tracer& tracer, const SourceSpecs& sources, const Optics& optics,
                                             const PipelineOptions& options, uint32_t paths, const Sensor& sensor,
                                             const Environment& environment);

}  // namespace suite
