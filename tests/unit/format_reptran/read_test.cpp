#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/files.h"
#include "formats/reptran/reptran.h"
#include "support/message_of.h"
#include "support/netcdf3_kit.h"
#include "support/temp_folder.h"

namespace suite::format_reptran_read_test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

TEST(Reptran, BandsAndGas) {
  const TempFolder folder;
  write_file(folder / "r.cdf", test::reptran_bands());
  EXPECT_THAT(message_of([&] { read_reptran(folder / "r.cdf"); }), HasSubstr("has no table of a gas beside it"));
  write_file(folder / "r.lookup.O3.cdf", test::reptran_gas());
  const ReadReptran r = read_reptran(folder / "r.cdf");
  EXPECT_THAT(r.notes, ElementsAre("without co2, whose table is not there"));
  const auto gases = representative_gases(r.table);
  EXPECT_NEAR(gases->low_um(), 9, 1e-12);
  EXPECT_NEAR(gases->high_um(), 11, 1e-12);
  // At the tabulated pressure 1000 hPa, 260 K is the lower offset from 280 K; 270 K lies a quarter up.
  std::vector<AirLevel> levels(2);
  levels[0] = {0, 100000, 270, {}}, levels[1] = {1000, 100, 240, {}};
  for (AirLevel& l : levels) l.share(Gas::o3) = 1e-6;
  const auto bands = gases->bands(1e4 / 11, 1e4 / 9);
  ASSERT_EQ(bands.size(), 2u);
  const auto one = gases->absorbers(bands[0], levels), two = gases->absorbers(bands[1], levels);
  ASSERT_EQ(one.size(), 1u);
  ASSERT_EQ(one[0].count(), 1u);  // 10 to 11 um: wavelength 3
  const double n0 = levels[0].density() * 1e-6, n1 = levels[1].density() * 1e-6;
  EXPECT_NEAR(one[0].absorption[0] / (n0 * 1e-20 * 3.5e-5), 1, 1e-5);
  EXPECT_NEAR(one[0].absorption[1] / (n1 * 1e-20 * 5e-5), 1, 1e-5);
  ASSERT_EQ(two[0].count(), 2u);  // 9 to 10 um: wavelengths 1, where nothing absorbs, and 2
  EXPECT_EQ(two[0].weight[0], 0.25);
  EXPECT_EQ(two[0].absorption[0], 0);
  EXPECT_NEAR(two[0].absorption[1] / (n0 * 1e-20 * 1.5e-5), 1, 1e-5);
}

}  // namespace
}  // namespace suite::format_reptran_read_test
