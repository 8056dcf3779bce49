#include "heat/target_paths.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"

namespace suite {

namespace {

constexpr uint32_t kStep = 4;  // from pilot to pilot

}  // namespace

double mean_path_error(const HeatResult& result, const Elements& elements, const HeatFaces& faces) {
  double sum = 0, area = 0;
  for (size_t f = 0; f < faces.size(); ++f) {
    const double a = elements[faces.element(f)].area;
    area += a;
    for (size_t p = 0; p < kHeatParts; ++p)
      sum += a * std::pow(double{result.path_error[f * kHeatParts + p]}, 2) / kHeatParts;
  }
  return std::sqrt(sum / area);
}

TargetPaths paths_for(double target, const Tracer& tracer, const Elements& elements, const HeatFaces& faces,
                      const HeatOptics& optics, const WeatherLoads& loads, const HeatSpec& spec,
                      const HeatProgress& progress) {
  if (!(target > 0)) throw Error(strf("temperatures are to be known within %g K", target), "above 0");
  HeatSpec pilot = spec;
  pilot.seed = mix64(spec.seed ^ 0x70696c6f74);
  TargetPaths out;
  double wanted = 0;
  for (pilot.paths = kPilotPaths;; pilot.paths *= kStep) {
    out.pilot_paths = pilot.paths;
    out.pilot_error =
        mean_path_error(solve_heat(tracer, elements, faces, optics, loads, pilot, progress), elements, faces);
    wanted = pilot.paths * std::pow(out.pilot_error / target, 2);
    if (wanted <= kStep * pilot.paths || pilot.paths >= kMostPaths / kStep) break;
  }
  // The pilot before asked for more than this one has, which is known to do.
  if (pilot.paths > kPilotPaths) wanted = std::max(wanted, 1.0 * pilot.paths);
  out.enough = wanted <= kMostPaths;
  const double least = std::ceil(std::clamp(wanted, 1.0, double{kMostPaths}) / HeatSpec::kLeastPaths);
  out.paths = static_cast<uint32_t>(least) * HeatSpec::kLeastPaths;
  return out;
}

}  // namespace suite
