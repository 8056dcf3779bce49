// Tables of gas absorption from line lists (--gases).
#pragma once
#include "options.h"

namespace suite {

// Reads the recipe and all that it names, tells what they hold, and bakes and writes the table; without an output only
// the former. Error: as their readers and bake_lines.
int bake_gases(const ScenePrepOptions& options);

}  // namespace suite
