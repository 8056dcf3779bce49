// The temperatures of a scene's elements in a file: found once, used by many runs. See FORMAT.md.
#pragma once
#include <string>

#include "heat/day_sun.h"
#include "heat/heat_balance.h"

namespace suite {

// Whole or not at all. cut: what the elements were made with. made_by: the command line. Error: not writable.
void write_heat(const std::string& path, const HeatResult& result, const Elements& elements, const HeatFaces& faces,
                const std::vector<std::string>& materials, const HeatCut& cut, const std::string& made_by);

// fluxes: what faces absorb and receive, too; else these are left empty. Error: no such file, damaged, or of another
// scene, other materials or another number of elements.
HeatResult read_heat(const std::string& path, const Elements& elements, const HeatFaces& faces, bool fluxes = true);
// What the elements have to be made with.
HeatCut heat_cut(const std::string& path);

}  // namespace suite
