// What paths find for the balance of heat: anew, from a file, or from where a search was ended.
#pragma once
#include <string>

#include "heat_report.h"
#include "options.h"

namespace suite {

// The file of paths that the command or, of one that was kept, the folder has; empty: none.
std::string operator_file(const Simulation& simulation, const RenderOptions& options, const std::string& folder);

// Also told (notes): where it is from. Keeps FOLDER/heat_operator.h5 where the simulation asks for it and a folder is
// given, and in FOLDER/heat_operator.pieces what is found until it is there. Error: a file (--heat-operator, or that in
// the folder) or pieces of another search.
HeatOperator operator_of(const PreparedHeat& prepared, const SunCourse& course, const Simulation& simulation,
                         const RenderOptions& options, const std::string& folder, const HeatProgress& progress);

}  // namespace suite
