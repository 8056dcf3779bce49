// Numbers a user gives by name, held to the parameters of a row (registry.h).
#pragma once
#include <map>
#include <span>
#include <string>

#include "base/registry.h"

namespace suite {

// Fills in the defaults of what is not given. of: what messages call the owner, "convection law 'tarp'". Error located
// at `where`: a name no parameter has, one that is required and absent, a value out of range.
void check_numbers(const std::string& of, std::span<const Parameter> parameters, std::map<std::string, double>& numbers,
                   const Where& where = {});

}  // namespace suite
