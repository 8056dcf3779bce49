// Sensors that look through tables of air (light/tabled_air.h): where their rays begin, and whether the tables cover
// them, as far as that is known before anything is traced.
#pragma once
#include "scheduler/moments.h"

namespace suite {

// Tells the tables of `written`, if there are any, where the sensors stand; checks the corners and the middle of every
// capture, at its own time and under its own sun. Error, located: as check_tabled_air and check_sight.
void look_through_tables(SourceSpecs& written, const Scene& scene, Sensors sensors);

}  // namespace suite
