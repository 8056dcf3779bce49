// Damaged OpenVDB files: a grid or one located Error. The library itself asks for gigabytes and reads for minutes when
// a length in the file is wrong.
#include <openvdb/openvdb.h>

#include "base/files.h"
#include "formats/voxel/voxel.h"
#include "support/fuzz.h"
#include "support/temp_folder.h"

namespace suite::format_voxel_vdb_test {

namespace {

// A cloud of some hundred voxels, with a tile, stored in one of the ways there are.
std::vector<std::byte> cloud(uint32_t compression, bool half) {
  openvdb::initialize();
  const TempFolder folder;
  auto g = openvdb::FloatGrid::create(0);
  g->setName("density");
  g->setGridClass(openvdb::GRID_FOG_VOLUME);
  g->setSaveFloatAsHalf(half);
  auto at = g->getAccessor();
  for (int i = 0; i < 300; ++i) at.setValue({i % 17, i % 13 - 4, i % 7}, 0.01f * float(i) + 0.5f);
  g->tree().addTile(1, openvdb::Coord(16, 0, 0), 2.0f, true);
  openvdb::io::File file(folder / "g.vdb");
  file.setCompression(compression);
  file.write({g});
  return read_bytes(folder / "g.vdb");
}

void fuzz_vdb(uint32_t compression, bool half, uint64_t seed) {
  const TempFolder folder;
  const auto read = [&](std::span<const std::byte> bytes) {
    test::put_file(folder / "m.vdb", bytes);
    const VoxelData g = read_vdb(folder / "m.vdb", "density", "");
    if (g.density.size() != g.size()) throw std::runtime_error("the field does not fill the grid");
    for (const float d : g.density)
      if (!(d >= 0)) throw std::runtime_error("a negative density came out");
  };
  test::fuzz(cloud(compression, half), read, seed);
}

}  // namespace

TEST(FuzzVdb, Plain) { fuzz_vdb(openvdb::io::COMPRESS_NONE, false, 1); }
TEST(FuzzVdb, ActiveMask) { fuzz_vdb(openvdb::io::COMPRESS_ACTIVE_MASK, false, 2); }
TEST(FuzzVdb, Zip) { fuzz_vdb(openvdb::io::COMPRESS_ZIP | openvdb::io::COMPRESS_ACTIVE_MASK, false, 3); }
TEST(FuzzVdb, Blosc) { fuzz_vdb(openvdb::io::COMPRESS_BLOSC | openvdb::io::COMPRESS_ACTIVE_MASK, true, 4); }

}  // namespace suite::format_voxel_vdb_test
