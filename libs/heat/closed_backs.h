// Whether closed backs are seen, and by whom: light that ends there warms nothing, which is to be told.
#pragma once
#include <string>

#include "heat/heat_operator.h"

namespace suite {

// A sentence, or nothing. Ground under an open-bottomed body (a house of walls and a roof) sees its backs and nothing
// else, and nobody sees that ground: what it sends there does not count.
std::string back_note(const HeatScene& scene, const ExchangePaths& exchange);

}  // namespace suite
