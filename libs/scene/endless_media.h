// Scattering media that a single surface without end bounds: they fill half of all space, and what enters them may
// scatter for very long.
#pragma once
#include <span>
#include <string>
#include <vector>

#include "scene/draft.h"
#include "scene/scene.h"

namespace suite {

struct EndlessMedium {
  std::string medium, surface;  // their names; no surface: the ambient medium
  double scatterings = 0;       // of a path before it is absorbed, on average: 1 / (1 - albedo), at worst infinite
  double at_um = 0;             // wavelength at which it scatters most often; 0 = everywhere alike
};

// Media behind (or, with `outside`, in front of) planes without end, from 100 scatterings on, when nothing ends them:
// no other surface without end that does not lead into the same medium, and nothing finite; and an ambient medium of so
// many, whatever is in it. windows: the wavelengths
// that matter; empty = all of the medium's. The scene is checked; at most 64 are told.
std::vector<EndlessMedium> endless_media(const Scene& scene, std::span<const SpectralWindow> windows);

}  // namespace suite
