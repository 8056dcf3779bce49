// OpenVDB volumes as dense voxel grids, by the part `vdb`.
#include "base/late_part.h"
#include "formats/voxel/vdb_check.h"
#include "formats/voxel/vdb_grids.h"
#include "formats/voxel/voxel.h"

namespace suite {

namespace {

void check_values(const std::vector<float>& values, double high, const std::string& name, const Where& where) {
  for (const float v : values)
    if (!(v >= 0 && v <= high))
      throw Error(where, strf("grid '%s' has a value of %g", name.c_str(), v), strf("0 to %g", high));
}

const VdbCalls& vdb_calls() {
  static const auto* const calls = static_cast<const VdbCalls*>(late_symbol("vdb", "suite_vdb_calls"));
  return *calls;
}

}  // namespace

bool reads_vdb() { return true; }

VoxelData read_vdb(const std::string& path, const std::string& density, const std::string& temperature) {
  const Where where{path, 0, 0, {}, -1};
  check_vdb(path, {density, temperature});
  VdbGrids grids;
  if (const auto fault = vdb_calls().read(path, density, temperature, grids))
    throw Error(where, fault->what, fault->hint);
  check_values(grids.density, 3e38, density, where);
  check_values(grids.temperature, 1e5, temperature, where);
  VoxelData data;
  data.cells = grids.cells;
  for (size_t r = 0; r < 3; ++r) {
    for (size_t c = 0; c < 3; ++c) data.to_local.a[3 * r + c] = grids.index_to_local[r][c];
    data.to_local.b[static_cast<int>(r)] = grids.index_to_local[r][3];
  }
  data.density = std::move(grids.density);
  data.temperature = std::move(grids.temperature);
  return data;
}

}  // namespace suite
