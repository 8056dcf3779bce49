// What sqt-fit does with its options.
#pragma once
#include "options.h"

namespace suite {

int run_sqt_fit(const SqtFitOptions& options);

}  // namespace suite
