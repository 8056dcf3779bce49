// Damaged files of REPTRAN: a table that holds, or one Error.
#include "formats/reptran/reptran.h"

#include "base/files.h"
#include "support/fuzz.h"
#include "support/netcdf3_kit.h"
#include "support/temp_folder.h"

namespace suite::format_reptran_reptran_test {

TEST(FuzzReptran, Files) {
  const TempFolder folder;
  const std::string bands = folder / "r.cdf", gas = folder / "r.lookup.O3.cdf";
  std::vector<AirLevel> levels(2);
  levels[0] = {0, 100000, 270, {}}, levels[1] = {1000, 100, 240, {}};
  for (AirLevel& l : levels) l.share(Gas::o3) = 1e-6;
  for (const bool damage_gas : {false, true}) {
    write_file(bands, test::reptran_bands());
    write_file(gas, test::reptran_gas());
    test::fuzz(
        damage_gas ? test::reptran_gas() : test::reptran_bands(),
        [&](std::span<const std::byte> mutated) {
          test::put_file(damage_gas ? gas : bands, mutated);
          const auto provider = representative_gases(read_reptran(bands).table);
          for (const auto& band : provider->bands(1, 1e6)) provider->absorbers(band, levels);
        },
        31, test::kMutations);
  }
}

}  // namespace suite::format_reptran_reptran_test
