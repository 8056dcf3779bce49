// Surveys of HELIOS++: translated into a simulation text, and read as one.
#pragma once
#include "formats/sim_text/sim_text.h"
#include "options.h"

namespace suite {

// By the name and the beginning of the file; false when there is none.
bool is_of_helios(const std::string& path);
// Prepares the scene into the output folder by the scene-prep beside this program, tells what is lost, reads the rest.
Simulation import_survey(const RenderOptions& o, const SimulationCallbacks& callbacks);
// Writes the text into the folder of --convert; 1 when the import is to be strict and leaves something out.
int convert_survey(const RenderOptions& o);

}  // namespace suite
