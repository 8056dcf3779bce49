// Damaged files of AMAPVox: voxels or one Error, never anything else.
#include "formats/voxel/voxel.h"
#include "scene/issues.h"
#include "support/fuzz.h"

namespace suite::format_voxel_amapvox_test {
namespace {

void read_and_check(std::span<const std::byte> bytes) {
  Report report(scene_issues());
  const VoxelData v =
      parse_amapvox({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, "fuzz.vox", "", report);
  if (v.density.size() != v.size()) throw std::runtime_error("a cell is missing");
  for (const float d : v.density)
    if (!(d >= 0)) throw std::runtime_error("a density that is none came out");
}

const std::string kFile =
    "VOXEL SPACE\n#min_corner: (0.0, 0.0, 0.0)\n#max_corner: 2 1 3\n#split: 2 1 3\n#type: TLS #res: 1.0 #MAX_PAD: 5.0\n"
    "i j k PAD n\n0 0 0 0.5 30\n1 0 0 NaN 0\n0 0 1 0 20\n1 0 2 2.25 20\n";

const std::vector<std::string> kWords{"\n", " -1", " 99999999999", " NA", " 1e999", "#split: 9999 9999 9\n", "#", ":"};

TEST(FuzzAmapVox, Text) { test::fuzz(test::bytes_of(kFile), read_and_check, 1, test::kMutations, kWords); }

}  // namespace
}  // namespace suite::format_voxel_amapvox_test
