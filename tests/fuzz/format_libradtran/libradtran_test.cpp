// Seeded mutations of inputs and outputs of uvspec: a run, or one Error.
#include <gtest/gtest.h>

#include "formats/libradtran/libradtran.h"
#include "tests/support/fuzz.h"

namespace suite::format_libradtran_libradtran_test {
namespace {

std::string_view text_of(std::span<const std::byte> b) { return {reinterpret_cast<const char*>(b.data()), b.size()}; }

const std::string kInput = "sza 30\numu -1 -0.5\nphi 0 180\nzout 0 1\nsource solar f per_nm\n";
const std::string kOutput =
    "400 1 1 1 1 1 1\n 0 180\n -1 1 2 2\n -0.5 3 4 5\n400 1 1 1 1 1 1\n 0 180\n -1 1 2 2\n -0.5 3 4 5\n"
    "401 1 1 1 1 1 1\n 0 180\n -1 1 2 2\n -0.5 3 4 5\n401 1 1 1 1 1 1\n 0 180\n -1 1 2 2\n -0.5 3 4 5\n";

void read(std::string_view input, std::string_view output) {
  const LibradtranRun run = parse_libradtran(input, "f.inp", output, "f.out");
  for (const LibradtranColumn& c : run.columns) ASSERT_EQ(c.values.size(), run.levels * run.wavelength_um.size());
  libradtran_sky(run, 0, true);
}

TEST(LibradtranFuzz, Inputs) {
  test::fuzz(test::bytes_of(kInput), [](std::span<const std::byte> b) { read(text_of(b), kOutput); }, 12,
             test::kMutations,
             {"output_user", "lambda", "uu", "edir", "thermal", "per_cm-1", "output_quantity brightness\n", "1e300",
              "-1", "\n", "zout", "umu", "phi", "#"});
}

TEST(LibradtranFuzz, Outputs) {
  test::fuzz(test::bytes_of(kOutput), [](std::span<const std::byte> b) { read(kInput, text_of(b)); }, 13,
             test::kMutations, {"400", "1e300", "nan", "-1", "\n", " 0 180\n", "0"});
}

}  // namespace
}  // namespace suite::format_libradtran_libradtran_test
