// In place of vdb.cpp where OpenVDB was not found when this was built.
#include "formats/voxel/voxel.h"

namespace suite {

bool reads_vdb() { return false; }

VoxelData read_vdb(const std::string& path, const std::string&, const std::string&) {
  throw Error(Where{path, 0, 0, {}, -1}, "is an OpenVDB file, and this program was built without OpenVDB",
              "build it with libopenvdb-dev, or convert the grid to .vox");
}

}  // namespace suite
