// Seeded mutations of decks: runs with finite numbers, or one Error with a place.
#include <gtest/gtest.h>

#include <cmath>

#include "base/files.h"
#include "formats/tape5/tape5.h"
#include "tests/support/fuzz.h"

namespace suite::format_tape5_tape5_test {
namespace {

TEST(Tape5Fuzz, Decks) {
  const std::string one = read_text(SUITE_TEST_DATA "/modtran/path1000.tape5");
  const std::string deck =
      one.substr(0, one.rfind("    0")) + "    4\n     8.000    12.000     0.100     0.200          M\n    0\n";
  test::fuzz(test::bytes_of(deck),
             [](std::span<const std::byte> b) {
               for (const Tape5Run& r : parse_tape5({reinterpret_cast<const char*>(b.data()), b.size()}, "f.tp5")) {
                 ASSERT_TRUE(std::isfinite(r.first) && r.last >= r.first && r.step > 0);
                 ASSERT_TRUE(r.model >= 1 && r.model <= 6 && r.zenith);
               }
             },
             15, test::kMutations, {"    1", "    3", "    4", "          ", "1e300", "nan", "-1", "\n", "TMF", "N"});
}

}  // namespace
}  // namespace suite::format_tape5_tape5_test
