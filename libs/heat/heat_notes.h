// What a user should know of temperatures that were found: what is assumed or left out, with its size.
#pragma once
#include <string>
#include <vector>

#include "heat/heat_operator.h"

namespace suite {

// A sentence each. dry_air: the weather says nothing of humidity.
std::vector<std::string> heat_notes(const HeatScene& scene, const HeatOperator& found, bool dry_air);

}  // namespace suite
