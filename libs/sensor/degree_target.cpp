#include "sensor/degree_target.h"

#include <algorithm>

namespace suite {

DegreeTarget read_degree_target(const Params& params, std::span<const Band> bands, Convergence& convergence,
                                std::vector<double>& band_targets) {
  const auto paths = params.find("paths");
  const auto degree = paths && paths->kind() == Params::Kind::map ? paths->find("dolp_error") : std::nullopt;
  if (!degree) return {};
  const DegreeTarget target{degree->as_number_in(1e-6, 1, "(degree of linear polarisation)"), degree->where()};
  const bool radiance = paths->has("relative_error") && convergence.relative_error > 0;
  if (!radiance && band_targets.empty()) {
    convergence.relative_error = target.error;
    band_targets.assign(bands.size(), 0.0);
  }
  return target;
}

void check_degree_target(const DegreeTarget& target, std::span<const std::string> channels, uint32_t bins) {
  if (!(target.error > 0)) return;
  const auto has = [&](const char* name) { return std::ranges::find(channels, name) != channels.end(); };
  if (!has("stokes_q") || !has("stokes_u"))
    throw Error(target.where, "the sensor does not see Q and U, whose degree `dolp_error` is a target for",
                "give it `stokes: linear`, or leave out dolp_error");
  if (bins > 1)
    throw Error(target.where, "`dolp_error` is a target for whole exposures, and these are in parts",
                "leave out time_bins");
}

double degree_target_of(const Sensor& sensor, const Capture& capture) {
  const auto* const has = dynamic_cast<const HasDegreeTarget*>(&sensor);
  return has ? has->degree_target(capture) : 0;
}

}  // namespace suite
