// What real air's light over an even ground is worth for a scene, its sun and what sensors look at: the
// limits of air that is solved as AirScattering::diffuse, each where it matters.
#pragma once
#include "base/diagnostics.h"
#include "scheduler/scheduler.h"

namespace suite {

// Diagnostics, none where nothing matters, or where the air is not solved for an even ground, but for the first two:
// - bands lie where the gases' tables are less sure than in general (air/gas_limits.h);
// - air that is traced goes on below a scene that ends;
// - beyond the scene the even ground goes on, unless there is an Earth, a surface without end or a scene that repeats
//   itself, or little of the ground's light comes from there (kMostFromBeyond);
// - the job's estimator goes back to no place in the air, so that neither single places nor shadows show in it;
// - media fill the scene: how much of the light of single places and of shadows that leaves out at most, for each
// sensor
//   that sees sunlight (air_left_out.h; unless both are less than kLeastLeftOut);
// - sun or moon stand lower than kLowSun at a capture;
// - a sensor looks past the ground along the limb from 10 km or more (the corners, edges and middles of its captures
//   are asked) under a sun lower than 85 degrees from the zenith.
// written: the sources; resolved here for every capture. Error: as resolve_sources.
std::vector<Diagnostic> diagnose_air(const SourceSpecs& written, const Scene& scene,
                                     std::span<const std::unique_ptr<Sensor>> sensors, const JobOptions& job);

inline constexpr double kMostFromBeyond = 0.05;
inline constexpr double kLeastLeftOut = 1e-3;      // of reflectance, of the sunlight on the way
inline constexpr double kLowSun = 80.5 * kDegree;  // from the zenith, rad

// Share of the light from an even ground that comes from further than `reach` (m, >= 0) to where air scatters it over
// the middle: the mean over heights with exp(-height / scale) of that of the solid angle. scale: m.
double share_from_beyond(double reach, double scale = 8000);

}  // namespace suite
