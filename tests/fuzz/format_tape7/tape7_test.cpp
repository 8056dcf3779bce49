// Seeded mutations of tape7 files: runs, or one Error with a place.
#include <gtest/gtest.h>

#include <array>

#include "base/files.h"
#include "formats/tape7/path_table.h"
#include "tests/support/fuzz.h"

namespace suite::format_tape7_tape7_test {
namespace {

TEST(Tape7Fuzz, Runs) {
  const std::string whole = read_text(SUITE_TEST_DATA "/modtran/tape7-03");
  // The cards, the header and a few rows, twice, the second time in the mode of two header lines.
  std::string text = whole.substr(0, whole.find(" 2054.00")) + " -9999.\n";
  text +=
      "T   6    2    0    0\n    FREQ COMBIN    H2O   UMIX\n    CM-1  TRANS  TRANS  TRANS\n   1000. 0.5000 0.6000 "
      "0.9000\n -9999.\n";
  test::fuzz(test::bytes_of(text),
             [](std::span<const std::byte> b) {
               for (const Tape7Block& run : parse_tape7({reinterpret_cast<const char*>(b.data()), b.size()}, "f.tp7")) {
                 ASSERT_FALSE(run.wavenumber.empty());
                 for (const Tape7Column& c : run.columns) ASSERT_EQ(c.values.size(), run.wavenumber.size());
                 run.transmittance();
                 if (run.mode != Tape7Mode::radiance) continue;
                 run.path_radiance();
                 run.two_way_transmittance();
               }
             },
             11, test::kMutations,
             {"FREQ", "COMBIN", "TOTAL", "SOLAR", "TOT TRANS", "-9999.", "********", "1.0-300", "1.0+300", "1e300",
              "          ", "\n", "-1", "nan"});
}

}  // namespace
}  // namespace suite::format_tape7_tape7_test
