// How much light the quick atmosphere, which scatters a beam once, leaves out of what sensors look at.
#pragma once
#include "scheduler/scheduler.h"

namespace suite {

// A sentence for each sensor that sees less than it should by kLeastNotShown or more in some band below 3 um: along the
// middle of its first, middle and last capture, over a black ground and over one of albedo 0.3
// (light/scattered_again.h). Of many bands eight are looked at. written: with the quick atmosphere; resolved here.
// Error: as resolve_sources.
std::vector<Diagnostic> diagnose_scattered_once(const SourceSpecs& written, const Scene& scene,
                                                std::span<const std::unique_ptr<Sensor>> sensors);

inline constexpr double kLeastNotShown = 0.01;  // of the radiance

}  // namespace suite
