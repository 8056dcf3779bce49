// The table of functions between the readers of voxels and the part `vdb`, which holds OpenVDB: a program that reads no
// such file does not load it.
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace suite {

struct VdbFault {
  std::string what, hint;
};

// Grids over one box of cells. index_to_local: rows of a 3 x 4 matrix, from whole indices of cells' corners to m.
struct VdbGrids {
  std::array<uint32_t, 3> cells{0, 0, 0};
  std::array<std::array<double, 4>, 3> index_to_local{};
  std::vector<float> density, temperature;  // per cell, x fastest; temperature: empty when not asked for
};

// Throws nothing; faults: what read_vdb() says of grids, but for the values' range.
struct VdbCalls {
  std::optional<VdbFault> (*read)(const std::string& path, const std::string& density, const std::string& temperature,
                                  VdbGrids& grids);
};

}  // namespace suite
