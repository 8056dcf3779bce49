#include "dry_checks.h"

#include <algorithm>

#include "surface/material_lookup.h"
#include "surface/optics.h"

namespace suite {

void check_optics(const std::shared_ptr<const Scene>& scene, const Simulation& sim) {
  const Tracer tracer(scene);
  const std::vector<bool> used = used_materials(tracer);
  if (std::find(used.begin(), used.end(), true) == used.end()) return;
  for (size_t s = 0; s < sim.sensors.size(); ++s) {
    const Sensor& sensor = *sim.sensors[s];
    for (size_t k = 0; k < sensor.states().size(); ++k) {
      const SpectralState& state = sensor.states()[k];
      try {
        const Optics optics(*scene, state, used, {.pending = true});
      } catch (const Error& e) {
        std::string bands;
        for (const Band& b : sensor.bands(k))
          if (bands.size() < 80) bands += (bands.empty() ? "'" : ", '") + b.name + "'";
        throw Error(e.where().file.empty() ? sim.sensor_where[s] : e.where(),
                    strf("sensor '%s', %.4g to %.4g um (%s): ", sensor.name().c_str(), state.low_um, state.high_um,
                         bands.c_str()) +
                        e.message(),
                    e.hint());
      }
    }
  }
}

}  // namespace suite
