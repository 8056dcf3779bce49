// Whether temperatures that follow from weather matter to what is looked at.
#pragma once
#include "scene/scene.h"
#include "spectral/state.h"

namespace suite {

// Some material's temperature follows from weather ('model: heat').
bool waits_for_heat(const Scene& scene);
// What weather may warm (450 K) sends out more than 1e-3 W/(m2 sr um) within the state: less is nothing beside day.
bool sees_warmth(const SpectralState& state);

}  // namespace suite
