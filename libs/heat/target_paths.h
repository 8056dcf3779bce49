// How many paths temperatures need to be known as well as is asked.
#pragma once
#include "heat/heat_balance.h"

namespace suite {

struct TargetPaths {
  uint32_t paths = 0;  // of a face, a multiple of HeatSpec::kLeastPaths
  uint32_t pilot_paths = 0;
  double pilot_error = 0;  // K, of so many
  bool enough = true;      // kMostPaths would do
};
inline constexpr uint32_t kPilotPaths = 16, kMostPaths = 4096;

// The whole balance is solved with few paths, other ones than those of spec.seed, so that what the run itself finds is
// not chosen by; errors fall with the root of the number of paths, and faster where few points told of edges. So a
// pilot that asks for more than four times its paths is followed by one of four times as many. target: K, standard
// error by the paths, root of the mean square over area and span. Error: as solve_heat; a target that is not positive.
TargetPaths paths_for(double target, const Tracer& tracer, const Elements& elements, const HeatFaces& faces,
                      const HeatOptics& optics, const WeatherLoads& loads, const HeatSpec& spec,
                      const HeatProgress& progress = {});

// K, of a result.
double mean_path_error(const HeatResult& result, const Elements& elements, const HeatFaces& faces);

}  // namespace suite
