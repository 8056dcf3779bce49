// Texts of simulations and the scenes that they name, as the borders read them.
#pragma once
#include <memory>

#include "formats/sim_text/sim_text.h"
#include "scene/scene.h"

namespace suite {

// As dirsig-render reads it; sensors deliver nothing. What detectors of laser radars say is left unread. Located
// Errors.
Simulation simulation_of(const char* path);

// The scenes of a simulation as one, whole, with the epoch set.
std::shared_ptr<Scene> scenes_of(const Simulation& simulation);

}  // namespace suite
