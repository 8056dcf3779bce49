#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "formats/reptran/netcdf3.h"
#include "support/message_of.h"
#include "support/netcdf3_kit.h"

namespace suite::format_reptran_netcdf3_test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

TEST(NetCdf3, VariablesOfEveryKind) {
  const NetCdf3 file(test::netcdf3({2, 3}, {{"a", {0, 1}, 6, {1, 2.5, -3, 4, 5, 6e100}},
                                            {"b", {1}, 5, {0.5, -2, 3}},
                                            {"c", {0}, 4, {-7, 100000}},
                                            {"t", {0, 1}, 2, test::characters("O3 CO2")}}),
                     "f.nc");
  EXPECT_THAT(file.shape("a"), ElementsAre(2, 3));
  EXPECT_THAT(file.numbers("a", {2, 3}), ElementsAre(1, 2.5, -3, 4, 5, 6e100));
  EXPECT_THAT(file.numbers("b", {3}), ElementsAre(0.5, -2, 3));
  EXPECT_THAT(file.numbers("c", {2}), ElementsAre(-7, 100000));
  EXPECT_THAT(file.strings("t"), ElementsAre("O3", "CO2"));
  EXPECT_TRUE(file.has("c"));
  EXPECT_THAT(message_of([&] { file.numbers("x", {1}); }), HasSubstr("f.nc: error: has no variable 'x'"));
  EXPECT_THAT(message_of([&] { file.numbers("b", {2}); }), HasSubstr("of another shape"));
  EXPECT_THAT(message_of([&] { file.numbers("t", {2, 3}); }), HasSubstr("has text as 't'"));
}

TEST(NetCdf3, RefusesWhatIsNone) {
  const auto message = [](std::vector<std::byte> bytes) { return message_of([&] { NetCdf3(bytes, "f.nc"); }); };
  std::vector<std::byte> good = test::netcdf3({2}, {{"c", {0}, 4, {1, 2}}});
  EXPECT_EQ(message(good), "no error");
  EXPECT_THAT(message({}), HasSubstr("is no classic netCDF file"));
  std::vector<std::byte> bad = good;
  bad[3] = std::byte{5};
  EXPECT_THAT(message(bad), HasSubstr("is of version 5"));
  bad = good;
  bad.resize(good.size() - 4);
  EXPECT_THAT(message(bad), HasSubstr("'c' that reaches beyond its end"));
  bad.resize(40);
  EXPECT_THAT(message(bad), HasSubstr("ends within its header"));
}

}  // namespace
}  // namespace suite::format_reptran_netcdf3_test
