// Damaged files of what paths found: read, or one Error.
#include "base/files.h"
#include "support/fuzz.h"
#include "support/searched_scene.h"
#include "support/temp_folder.h"

namespace suite::format_heat_hdf_operator_test {

namespace {

void fuzz_operator(bool moving) {
  const TempFolder folder;
  const std::string path = folder / "heat_operator.h5";
  const test::SearchedScene s(6, moving);
  write_operator(path, s.found(), s.identity(), "a test");
  const std::vector<std::byte> bytes = read_bytes(path);
  test::fuzz(bytes, [&](std::span<const std::byte> mutated) {
    test::put_file(path, mutated);
    operator_cut(path);
    StoredOperator(path, s.identity()).sun_path();
    const HeatOperator found = s.stored(path, s.identity());
    for (size_t k = 0; k < found.exchange.rows.intervals; ++k)
      found.exchange.in_interval(k).matrix(s.kit.faces->outsides());
  });
}

}  // namespace

TEST(FuzzHeatOperator, File) { fuzz_operator(false); }
TEST(FuzzHeatOperator, FileOfWhatMoves) { fuzz_operator(true); }

}  // namespace suite::format_heat_hdf_operator_test
