// Cells of materials as exact cubes: the faces between cells that have a material and cells that have none.
#pragma once
#include <array>
#include <cstdint>
#include <set>
#include <vector>

#include "scene/draft.h"

namespace suite {

// material: per cell, x fastest; solid: the values that are a material, all others are empty. One run a value, its
// number as the run's material name. Triangles face outwards; corners are shared. Faces between two cells that both
// have a material are inside and left out. Error when there are more than 2^32 corners or triangles.
SourceMesh voxel_faces(const std::array<uint32_t, 3>& cells, const Affine3& to_local,
                       std::span<const uint16_t> material, const std::set<uint16_t>& solid);

}  // namespace suite
