// Damaged temperatures of elements: read, or one Error.
#include "base/files.h"
#include "support/fuzz.h"
#include "support/heated_file_kit.h"
#include "support/temp_folder.h"

namespace suite::format_heat_hdf_heat_test {

TEST(FuzzHeat, File) {
  const TempFolder folder;
  const std::string path = folder / "heat.h5";
  const test::HeatedFile file;
  file.write(path);
  const std::vector<std::byte> bytes = read_bytes(path);
  test::fuzz(bytes, [&](std::span<const std::byte> mutated) {
    test::put_file(path, mutated);
    heat_cut(path);
    const HeatResult r = read_heat(path, *file.kit.elements, *file.kit.faces);
    for (size_t f = 0; f < file.kit.faces->size(); ++f) r.kelvin_at(f, 40000);
  });
}

}  // namespace suite::format_heat_hdf_heat_test
