// What the air's light is worth for a scene, its sun and what sensors look at, each limit where it matters: of the
// quick atmosphere, of air that is traced, and of air that is solved for an even ground (AirScattering::diffuse).
#pragma once
#include "base/diagnostics.h"
#include "scheduler/scheduler.h"

namespace suite {

// Diagnostics, none where nothing matters, or where the air is not solved for an even ground, but for the first four:
// - the quick atmosphere scatters light once: how much is missing (scattered_once.h);
// - bands lie where the gases' tables are less sure than in general (air/gas_limits.h);
// - a sensor looks from within haze: how far its sunlit light is from another program's (air/ACCURACY.md);
// - air that is traced goes on below a scene that ends, and how bright that makes the horizon (glow_from_below);
// - beyond the scene the even ground goes on, unless there is an Earth, a surface without end or a scene that repeats
//   itself, or little of the ground's light comes from there (kMostFromBeyond);
// - the job's estimator goes back to no place in the air, so that neither single places nor shadows show in it;
// - sun or moon stand lower than kLowSun at a capture;
// - a sensor looks past the ground along the limb from 10 km or more (the corners, edges and middles of its captures
//   are asked) under a sun lower than 85 degrees from the zenith.
// written: the sources; resolved here for every capture. Error: as resolve_sources.
std::vector<Diagnostic> diagnose_air(const SourceSpecs& written, const Scene& scene,
                                     std::span<const std::unique_ptr<Sensor>> sensors, const JobOptions& job);

inline constexpr double kMostFromBeyond = 0.05;
inline constexpr double kLowSun = 80.5 * kDegree;  // from the zenith, rad

// Share of the light from an even ground that comes from further than `reach` (m, >= 0) to where air scatters it over
// the middle: the mean over heights with exp(-height / scale) of that of the solid angle. scale: m.
double share_from_beyond(double reach, double scale = 8000);

// By how much traced air that goes on below a dark scene is too bright at most, of itself: 2 degrees over the horizon,
// at the ground. sun: zenith angle, rad. Bounds what runs with and without `earth` differ by (0.55 um, rural aerosol of
// 23 km, albedo 0.05, suns from 80 to 92 degrees), away from the sun: 48 % where the scene reaches 2 km, 15 % for 15
// km, 6 % for 50 km; with the sun at 92 degrees, where the missing Earth would shade the air, 70 +- 11 %, 17 +- 5 % and
// 18 +- 16 %; in the zenith a third of it, but 12 +- 4 % with the sun at 92 degrees (15 km).
double glow_from_below(double reach, double sun);

}  // namespace suite
