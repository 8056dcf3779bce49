// Sunlight that mirrors and smooth glass send on, followed from the sun: what paths from the faces cannot find, as they
// would have to leave the last mirror exactly towards the sun.
//
// Method: from points of everything that has Dirac lobes, stratified by area, through the whole day: where the sun
// stands on one, its light goes on by a Dirac lobe, is absorbed by faces on its way and scattered until nothing is left
// or it leaves the scene. Sunlight whose first surface scatters it belongs to the paths from the faces (sunlight.h), so
// nothing counts twice. Adjoint of the paths of radiance: weights of reflections are reciprocal; across interfaces
// radiance is scaled by the squared index ratio (E. Veach, thesis, Stanford 1997, section 5.2), which a Dirac lobe's
// weights there and back undo, and a scattering surface's other way round does.
//
// Assumes: mirrors at rest (those that move are counted and left out). Of mirrors without end what is looked at is what
// sends light in one go to the scene's bounds and its faces, as even ones; light from one such to the next and on is
// left out.
#pragma once
#include "heat/sunlight.h"

namespace suite {

// Adds what faces absorb to beam and beam_of_block of `out`, whose sizes are set, and fills its `mirrored`; adds its
// rays. Points for each moment and block: as many for the area of a mean element as the beam has, one at least of each
// mirroring surface. In parallel, the same on any number of threads.
void add_mirrored_sunlight(const Tracer& tracer, const Elements& elements, const HeatFaces& faces,
                           const HeatOptics& optics, const SunCourse& course, const PathOptions& options,
                           Sunlight& out);

}  // namespace suite
