// Tables of many placements of one object: CSV or raw binary. See FORMAT.md.
#pragma once
#include <string>
#include <vector>

#include "math/vec.h"

namespace suite {

// The transform of every row (scale, then rotate, then translate), in the order of the file.
// Error with file and line, or byte, otherwise; at most 100 million rows.
std::vector<Affine3> read_instances(const std::string& path);

}  // namespace suite
