// What scattered measurements say about their own symmetry.
#pragma once
#include "sqt_fit/samples.h"

namespace suite::sqt {

// Sets info.isotropic, info.bilateral and info.domain from the directions and values.
// isotropic: every azimuth of `reference` (out or in, the direction the instrument kept still) is the same, so nothing
// is known about turning the sample. bilateral (isotropic data): all samples lie on one side of the plane of incidence,
// or each has a mirror image with the same value (to 1e-3). domain: sphere when any `in` lies below the surface.
enum class Still { out, in };
void infer_symmetry(Samples& samples, Still reference);

}  // namespace suite::sqt
