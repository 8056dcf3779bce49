// What a user should know of temperatures that were found: what is assumed or left out, with its size.
#pragma once
#include <string>
#include <vector>

#include "heat/heat_operator.h"
#include "heat/surfaces.h"

namespace suite {

// A sentence each. dry_air: the weather says nothing of humidity.
std::vector<std::string> heat_notes(const HeatScene& scene, const HeatOperator& found, bool dry_air);
// What of the exchange is spread over the span though it has its times: of things at rest that come and go; empty when
// there are none.
std::string visitors_note(const HeatScene& scene, const ExchangePaths& exchange, const SurfaceHistory& history);
// Of intervals of rest: which they are, how many faces see what changes, what moves when; empty without such.
std::string rests_note(const HeatScene& scene, const HeatOperator& found);
// Whether any element stands in several places, which an audit does not go with.
bool stands_in_several_places(const HeatScene& scene);

}  // namespace suite
