// A scattering model of the table as a function that can be fitted.
#pragma once
#include <memory>
#include <string>

#include "sqt/function.h"

namespace suite {

// "name:param=value,param=value": a row of models() or of phases() with numbers (curve parameters take constants). One
// channel at 0.55 um. The model's Dirac lobes are not part of the function. Errors as check_model; malformed text.
std::shared_ptr<const sqt::Function> model_function(const std::string& specification);

}  // namespace suite
