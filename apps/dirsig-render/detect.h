// `--detect`: detectors over stored responses of laser pulses, without tracing anything.
#pragma once
#include "options.h"

namespace suite {

// Reads the response and the text of the detectors, writes what the text's `output` asks for into the folder. Errors
// are located; UsageError: options of renders.
int run_detect(const Cli& cli, const RenderOptions& options);

}  // namespace suite
