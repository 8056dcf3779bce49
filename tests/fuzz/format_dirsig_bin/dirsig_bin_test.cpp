// Damaged lidar photons: read, or one Error.
#include "formats/dirsig_bin/dirsig_bin.h"

#include "base/files.h"
#include "support/fuzz.h"

namespace suite::format_dirsig_bin_dirsig_bin_test {

TEST(FuzzDirsigBin, Revision2) {
  for (const char* order : {"le", "be"})
    test::fuzz(read_bytes(std::string(SUITE_TEST_DATA) + "/lidar/synthetic_rev2_" + order + ".bin"),
               [](std::span<const std::byte> bytes) { parse_lidar_bin(bytes, "fuzz.bin"); });
}

}  // namespace suite::format_dirsig_bin_dirsig_bin_test
