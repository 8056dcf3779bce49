// Damaged states of runs: continued, or one Error.
#include "base/files.h"
#include "formats/render_state/render_state.h"
#include "support/fuzz.h"
#include "support/temp_folder.h"

namespace suite::format_render_state_state_test {

TEST(FuzzState, File) {
  const TempFolder folder;
  const std::string path = folder / "result.state.h5";
  const StateIdentity identity{{"scene", "abc"}, {"seed", "1"}};
  const std::vector<CaptureShape> shapes{{10, 20, 3, 4, 2}, {5, 1, 3, 8, 2}};
  {
    const auto store = make_state(path, identity, {StateUse::start, {}, StatePart{{1, 3}}});
    store->begin(shapes);
    Accumulators sums({200, 3, 4, 2});
    for (size_t i = 0; i < 200; ++i) sums.set_paths(i, 8);
    const std::vector<size_t> blocks{0, 1, 4, 5}, piloted{0, 1, 2};
    store->save(0, blocks, sums, BlockCounts(10, 20, 4));
    store->save_needs(0, piloted, std::vector<double>(200, 5.0), BlockCounts(10, 20, 4));
  }
  const std::vector<std::byte> bytes = read_bytes(path);
  test::fuzz(bytes, [&](std::span<const std::byte> mutated) {
    test::put_file(path, mutated);
    read_state_head(path, identity);
    const auto store = make_state(path, identity, {StateUse::resume});
    store->begin(shapes);
    for (size_t c = 0; c < shapes.size(); ++c) {
      Accumulators sums({shapes[c].problems(), 3, shapes[c].scrambles, 2});
      std::vector<double> needs;
      BlockCounts counts(shapes[c].columns, shapes[c].rows, shapes[c].scrambles);
      store->load(c, sums, needs, counts);
      store->save(c, std::vector<size_t>{0}, sums, counts);
    }
  });
}

}  // namespace suite::format_render_state_state_test
