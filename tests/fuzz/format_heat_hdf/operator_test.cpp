// Damaged files of what paths found: read, or one Error.
#include "base/files.h"
#include "support/fuzz.h"
#include "support/searched_scene.h"
#include "support/temp_folder.h"

namespace suite {

TEST(FuzzHeatOperator, File) {
  const TempFolder folder;
  const std::string path = folder / "heat_operator.h5";
  const test::SearchedScene s(6);
  write_operator(path, s.found(), s.identity(), "a test");
  const std::vector<std::byte> bytes = read_bytes(path);
  test::fuzz(bytes, [&](std::span<const std::byte> mutated) {
    test::put_file(path, mutated);
    operator_cut(path);
    StoredOperator(path, s.identity()).sun_path();
    const HeatOperator found = s.stored(path, s.identity());
    found.exchange.matrix(s.kit.faces->outsides());
  });
}

}  // namespace suite
