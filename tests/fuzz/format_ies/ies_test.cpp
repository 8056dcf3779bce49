// Damaged photometric files.
#include "formats/ies/ies.h"
#include "support/fuzz.h"

namespace suite::format_ies_ies_test {
namespace {

TEST(FuzzIes, Text) {
  const std::string file =
      "IESNA:LM-63-2002\r\n[TEST] none\r\n[LUMINAIRE] a lamp\r\nTILT=NONE\r\n1 -1 4 3 2 1 2 0.1 0.1 0\r\n0.5 1 100\r\n"
      "0 45 90\r\n0 90\r\n10 20 30\r\n40 50 60\r\n";
  test::fuzz(
      test::bytes_of(file),
      [](std::span<const std::byte> bytes) {
        const IesLuminaire lamp = parse_ies({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, "fuzz.ies");
        double lost = 0;
        intensity_table(lamp, lost);
      },
      1, test::kMutations, {"TILT=INCLUDE", "-1", "0", "nan", "1e308", "4000000000", "360", "\n", "IESNA:LM-63-1986"});
}

}  // namespace
}  // namespace suite::format_ies_ies_test
