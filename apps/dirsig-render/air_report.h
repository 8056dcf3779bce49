// The real air of a simulation in numbers, without rendering (--air), and what may be asked of it.
#pragma once
#include <memory>
#include <string>

#include "formats/sim_text/sim_text.h"

namespace suite {

// The layers' profile and, for each sensor and band at second 0, depths, transmittance and light at the ground.
// Sensors have their bins. Error: a simulation without real air.
std::string air_text(const Simulation& sim, const std::shared_ptr<const Scene>& scene);
// Error, located: a sensor asks for parts of air that is not there, or not known apart.
void check_air_asked(const Simulation& sim, const Scene& scene, const Sensor& sensor);

}  // namespace suite
