// Photons for guiding to caustics of glossy surfaces: those a small light has sent and surfaces have turned within
// narrow lobes, where they land, and where they come from. They say where paths should look for such light
// (gloss_guide.h) and count nothing themselves, so what they neglect (media, the air, colours but one) is noise at
// most.
//
// Assumes: rays are aimed at the balls around objects that have a material that is more than matte; what has no bounds
// is none of them, and among more than 32,768 of them none is aimed at: too few photons would come from each.
// Transmission through smooth interfaces is left to those who ask through them (refracted/sight.h).
// Based on: H. W. Jensen, "Importance driven path tracing using the photon map", Rendering Techniques 1995.
#pragma once
#include <vector>

#include "light/environment.h"
#include "surface/surface.h"

namespace suite {

struct GlossPhoton {
  Vec3 place;            // where it lands, m, ENU
  Vec3 from;             // on the surface that turned it last, as `place` sees it (in a periodic cell as if unfolded)
  Dir normal;            // of the surface there
  float flux = 0;        // at the reference bin, W/um, over the number of photons sent
  float irradiance = 0;  // of its light where it was aimed at, W/(m2 um)
};

// most: photons that are sent; more, up to a whole wave of 2048, for less. Empty where nothing throws such light.
// Deterministic: the same on every thread, rank and in every run.
std::vector<GlossPhoton> gloss_photons(const Surface& surface, const Optics& optics, const Environment& environment,
                                       size_t most);

}  // namespace suite
