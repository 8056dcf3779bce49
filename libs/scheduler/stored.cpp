#include "scheduler/stored.h"

#include <algorithm>
#include <cmath>

#include "light/environment.h"
#include "scheduler/planner.h"
#include "transport/truth/truth.h"

namespace suite {

size_t TruthSlots::of(const Sensor& sensor, size_t state) {
  const auto [slots, fresh] = known_.try_emplace({&sensor, state}, 0);
  if (!fresh) return slots->second;
  const SpectralState& spectral = sensor.states()[state];
  const BandProjection projection(spectral, sensor.bands(state));
  const Environment none;
  slots->second = TruthPlan(sensor.truth(), {tracer_, spectral, state, sensor.bands(state), projection, none}).slots();
  return slots->second;
}

CaptureShape shape_of(const Sensor& sensor, const Capture& capture, const Goals& goals, TruthSlots& slots) {
  return {capture.columns, capture.rows, sensor.bands(capture.state).size() * sensor.channels().size() * capture.bins,
          scrambles_for(goals.all.max_paths), slots.of(sensor, capture.state)};
}

void add_stored(StateStore& store, size_t id, const Capture& capture, const Goals& goals, bool capped,
                StoredWork& work) {
  const bool piloted = goals.all.relative_error > 0 || capped;
  std::vector<uint32_t> paths;
  std::vector<double> needs;
  store.load_paths(id, paths, needs);
  for (const uint32_t p : paths) work.paths += p;
  ++work.captures;
  if (piloted && (needs.empty() || std::any_of(needs.begin(), needs.end(), [](double x) { return std::isnan(x); })))
    return;
  const std::vector<uint32_t> plan = plan_of(capture, goals, piloted ? needs : std::vector<double>{});
  work.finished += std::equal(paths.begin(), paths.end(), plan.begin(), [](uint32_t a, uint32_t b) { return a >= b; });
}

}  // namespace suite
