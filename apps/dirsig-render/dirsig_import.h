// Simulations of DIRSIG: translated into a simulation text, and read as one.
#pragma once
#include "formats/sim_text/sim_text.h"
#include "options.h"

namespace suite {

// By the name and the beginning of the file; false when there is none.
bool is_of_dirsig(const std::string& path);
// Runs the scene-prep that stands beside this program; its report of a scene that is refused goes to stderr. search:
// folders of --path. Error: it is refused.
void prepare_scene(const std::string& scene, const std::string& place, const std::vector<std::string>& search);
// UsageError when options of imports go with another text, or do not go together.
void check_import_usage(const RenderOptions& o);
// Prepares the scenes into the output folder by the scene-prep beside this program (unless they are up to date), tells
// what is lost, and reads the rest. alone: one process; of several, each reads scenes that must be prepared already.
Simulation import_simulation(const RenderOptions& o, const SimulationCallbacks& callbacks, bool alone);
// Writes the texts and the account; 1 when the import is to be strict and leaves something out.
int convert_simulation(const RenderOptions& o);

}  // namespace suite
