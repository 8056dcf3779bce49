#pragma once
#include "options.h"

namespace suite {

// Returns the exit code.
int inspect(const Cli& cli, const InspectOptions& options);

}  // namespace suite
