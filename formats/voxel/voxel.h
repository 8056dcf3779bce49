// Voxel grids as a text that describes them and raw files that hold the values. See FORMAT.md.
#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "math/vec.h"

namespace suite {

struct VoxelData {
  std::array<uint32_t, 3> cells{0, 0, 0};
  Affine3 to_local;                // index space -> m
  std::vector<float> density;      // per cell, x fastest; empty = not given
  std::vector<float> temperature;  // K, 0 = none
  std::vector<uint16_t> medium, material;
  std::vector<std::string> raw_files;  // as written
  size_t size() const { return size_t{cells[0]} * cells[1] * cells[2]; }
};

// Error located in the text: unknown keys, sizes that do not match the files, negative or infinite values, whole
// numbers that are none. Files are compared with the declared size before anything is allocated.
VoxelData read_voxels(const std::string& path);

}  // namespace suite
