// The examples of the rows of the tables of models and phase functions, ready to be baked: those that need fitted data
// get bundles, fitted once.
#pragma once
#include <vector>

#include "optics/phase_function.h"

namespace suite::test {

std::vector<ModelSpec> examples_of(const ModelRow& row);
std::vector<ModelSpec> examples_of(const PhaseRow& row);

}  // namespace suite::test
