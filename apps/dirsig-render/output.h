// Files that a finished capture becomes.
#pragma once
#include <string>
#include <vector>

#include "formats/sim_text/sim_text.h"

namespace suite {

// Writes NAME.img, NAME_error.img, NAME_truth.img and NAME.png into the folder; returns their paths.
std::vector<std::string> write_capture(const std::string& folder, const Sensor& sensor, const CaptureResult& result, const OutputSpec& output,
                                       const std::vector<std::string>& material_names);

}  // namespace suite
