// Voxel grids as a text that describes them and raw files that hold the values. See FORMAT.md.
#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "base/report.h"
#include "math/vec.h"

namespace suite {

struct VoxelData {
  std::array<uint32_t, 3> cells{0, 0, 0};
  Affine3 to_local;                // index space -> m
  std::vector<float> density;      // per cell, x fastest; empty = not given
  std::vector<float> temperature;  // K, 0 = none
  std::vector<uint16_t> medium, material;
  std::vector<std::vector<float>> shares;  // of each medium, per cell: what they add to density with; or empty
  std::vector<std::string> raw_files;      // as written
  size_t size() const { return size_t{cells[0]} * cells[1] * cells[2]; }
};

// Error located in the text: unknown keys, sizes that do not match the files, negative or infinite values, whole
// numbers that are none. Files are compared with the declared size before anything is allocated.
VoxelData read_voxels(const std::string& path);

// Voxels of AMAPVox (`VOXEL SPACE`): a column of area densities, m2 of leaves (or plants) in a m3, over the whole grid;
// column: its name, else PadBVTotal or PAD. Cells that have no value were not seen; they count as empty and are told
// (SP705). Error, located: no such file or column, cells outside the grid or told twice, negative densities.
VoxelData read_amapvox(const std::string& path, const std::string& column, Report& report);
VoxelData parse_amapvox(std::string_view text, const std::string& file, const std::string& column, Report& report);
// By the file's first line. Error: no such file.
bool is_amapvox(const std::string& path);

// Fog volumes of an OpenVDB file: the float grid `density` over the box of its active voxels, and `temperature` (K;
// empty = none) over the same cells. Error: not built with OpenVDB, no such grid, another type, a level set, different
// cells, more than 2^28 cells, values out of range.
VoxelData read_vdb(const std::string& path, const std::string& density, const std::string& temperature);
bool reads_vdb();  // was this built with OpenVDB?

}  // namespace suite
