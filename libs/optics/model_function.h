// A scattering model of the table as a function that can be fitted.
#pragma once
#include <memory>
#include <string>

#include "sqt/function.h"

namespace suite {

// "name:param=value,param=value": a row of models() or of phases() with numbers (curve parameters take constants), or
// "tabulated:table=0 3.1, 10 1.2, ... 180 0.2" (the row's text parameter). One
// channel at 0.55 um. A Dirac lobe of the model is dirac() of the function; Error when there is more than
// one or it points neither to the mirror direction, nor back, nor straight on. Errors as check_model; malformed text.
std::shared_ptr<const sqt::Function> model_function(const std::string& specification);

}  // namespace suite
