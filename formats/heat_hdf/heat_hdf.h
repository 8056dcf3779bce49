// The temperatures of a scene's elements in a file: found once, used by many runs. See FORMAT.md.
#pragma once
#include <string>

#include "heat/heat_balance.h"

namespace suite {

// Whole or not at all. by_sun: how the elements were cut. made_by: the command line. kept: of all elements, where some
// were left out. Error: not writable.
void write_heat(const std::string& path, const HeatResult& result, const Elements& elements, const HeatFaces& faces,
                const std::vector<std::string>& materials, bool by_sun, const std::string& made_by,
                const std::vector<uint32_t>& kept = {});

// Error: no such file, damaged, or of another scene, other materials or another number of elements.
HeatResult read_heat(const std::string& path, const Elements& elements, const HeatFaces& faces);
// What the elements have to be made with.
struct HeatCut {
  size_t elements = 0;
  bool by_sun = false;
  TimeSpan span;                    // s
  std::vector<uint32_t> kept = {};  // of these, where some were left out
};
HeatCut heat_cut(const std::string& path);

}  // namespace suite
