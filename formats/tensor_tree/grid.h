// The unit hypercube of a tensor tree and the pairs of directions that its points stand for (FORMAT.md).
#pragma once
#include <array>
#include <utility>

#include "math/vec.h"

namespace suite::tensor {

using Point = std::array<double, 4>;  // the first three of rank 3

// (out, in). Rank 3: `in` at azimuth pi; no direction has a first coordinate above 0.5, where `in` stays on the normal.
std::pair<Dir, Dir> directions(const Point& at, size_t rank);

// Of directions above the horizon.
Point point_of(Dir out, Dir in, size_t rank);

}  // namespace suite::tensor
