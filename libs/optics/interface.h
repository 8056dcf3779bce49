// Which scattering models are interfaces: what lies behind them is transparent matter.
#pragma once
#include "optics/model_spec.h"

namespace suite {

// Whether it parts transparent matter, behind, from what is in front: the models with an `index` of the back side
// relative to the front side.
inline bool is_interface(const ModelSpec& spec) { return spec.model == "dielectric" || spec.model == "ggx_dielectric"; }

}  // namespace suite
