// Damaged voxel texts and raw files: a grid or one located Error.
#include "formats/voxel/voxel.h"
#include "base/files.h"
#include "support/fuzz.h"
#include "support/temp_folder.h"

namespace suite::format_voxel_voxel_test {

TEST(FuzzVoxel, Text) {
  TempFolder folder;
  write_file(folder / "d.u8", std::string(24, '\3'));
  const auto read = [&](std::span<const std::byte> bytes) {
    test::put_file(folder / "g.vox", bytes);
    const VoxelData g = read_voxels(folder / "g.vox");
    for (const auto size : {g.density.size(), g.temperature.size(), g.medium.size(), g.material.size()})
      if (size && size != g.size()) throw std::runtime_error("a field does not fill the grid");
    for (const float d : g.density)
      if (!(d >= 0)) throw std::runtime_error("a negative density came out");
  };
  test::fuzz(
      test::bytes_of(
          "voxels: 1\ncells: [2, 3, 4]\ncell_m: [0.5, 1, 2]\norigin_m: [1, 2, 3]\nfields:\n  density: {file: d.u8, "
          "type: uint8, scale: 0.5}\n  temperature_k: 300\n  medium: {values: [0, 1, 0, 1, 0, 1, 0, 1, 0, 1, 0, 1, 0, "
          "1, "
          "0, 1, 0, 1, 0, 1, 0, 1, 0, 1]}\n"),
      read, 1, test::kMutations,
      {"{", "}", "[", "]", ": ", "nan", "1e999", "-1", "0", "1e6", "999999", "float64", "material", "\n", "  "});
}

}  // namespace suite::format_voxel_voxel_test
