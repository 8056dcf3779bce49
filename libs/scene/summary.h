// What a scene holds, in words.
#pragma once
#include <string>

#include "scene/draft.h"
#include "scene/scene.h"

namespace suite {

// Counts, sizes, extents, materials with the coverage of their curves, and the features the scene uses. Ends with a
// newline.
std::string summary_text(const Scene& scene);

// How many times each mesh is placed, all hierarchies flattened (saturates at 2^53).
std::vector<double> flattened_counts(const Scene& scene);

}  // namespace suite
