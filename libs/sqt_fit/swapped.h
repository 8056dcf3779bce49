// A function whose two directions have changed places, for data that call the viewer's direction the incident one: what
// was measured is seldom quite reciprocal.
#pragma once
#include <memory>

#include "sqt/function.h"

namespace suite::sqt {

// Values of `function` with `in` and `out` exchanged. Error: it is no BRDF over the hemisphere.
std::shared_ptr<const Function> swapped(std::shared_ptr<const Function> function);

}  // namespace suite::sqt
