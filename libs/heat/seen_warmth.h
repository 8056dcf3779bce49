// Whether temperatures that follow from weather matter to what is looked at.
#pragma once
#include "scene/scene.h"
#include "spectral/state.h"

namespace suite {

// Some material's temperature follows from weather ('model: heat').
bool waits_for_heat(const Scene& scene);
// What sun, sky and air may warm. K.
inline constexpr double kWeatherBelow = 450;
// The highest temperature that the scene's text holds: of materials, tables, maps, layers behind surfaces, and of
// surfaces that the power of their own sources heats if they lose it by radiation alone. Neighbours may be heated to
// it by these. K; 0 = there is none.
double hottest_given(const Scene& scene);
// What is as warm as kWeatherBelow sends out more than 1e-3 W/(m2 sr um) within the state: less is nothing beside day.
bool sees_warmth(const SpectralState& state);
// The same of what is as warm as `kelvin`.
bool sees_warmth(const SpectralState& state, double kelvin);

}  // namespace suite
