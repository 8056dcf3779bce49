#include "formats/air_table/air_table.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/message_of.h"
#include "support/temp_folder.h"

namespace suite::format_air_table_air_table_test {
namespace {

using testing::HasSubstr;

GasTable small_table() {
  GasTable t;
  t.source = "made by a test";
  t.edges_cm = {1000, 1010, 1030};
  t.pressure = {100, 10000, 100000};
  t.temperature = {200, 300};
  t.weight = {0.75, 0.25};
  t.gases = {Gas::h2o, Gas::co2};
  for (size_t i = 0; i < 2 * 2 * 3 * 2 * 2; ++i) t.cross_section.push_back(1e-25f * static_cast<float>(i + 1));
  t.water_self = {1e-29f, 2e-29f, 3e-29f, 4e-29f};
  return t;
}

TEST(AirTable, ComesBackAsItWas) {
  const TempFolder folder;
  const GasTable t = small_table();
  write_air_table(folder / "t.h5", t);
  const GasTable r = read_air_table(folder / "t.h5");
  EXPECT_EQ(r.source, t.source);
  EXPECT_EQ(r.edges_cm, t.edges_cm);
  EXPECT_EQ(r.pressure, t.pressure);
  EXPECT_EQ(r.temperature, t.temperature);
  EXPECT_EQ(r.weight, t.weight);
  EXPECT_EQ(r.gases, t.gases);
  EXPECT_EQ(r.cross_section, t.cross_section);
  EXPECT_EQ(r.water_self, t.water_self);
}

TEST(AirTable, RefusesWhatDoesNotFit) {
  const TempFolder folder;
  const auto message = [&](auto change) {
    GasTable t = small_table();
    change(t);
    return message_of([&] { write_air_table(folder / "t.h5", t); });
  };
  EXPECT_EQ(message([](GasTable&) {}), "no error");
  EXPECT_THAT(message([](GasTable& t) { t.edges_cm[1] = 1040; }), HasSubstr("edges of bands number 3 is 1030"));
  EXPECT_THAT(message([](GasTable& t) { t.weight[0] = 0.5; }), HasSubstr("weights of g-points sum to 0.75"));
  EXPECT_THAT(message([](GasTable& t) { t.gases[1] = Gas::h2o; }), HasSubstr("h2o twice"));
  EXPECT_THAT(message([](GasTable& t) { t.cross_section.pop_back(); }), HasSubstr("47 cross sections"));
  EXPECT_THAT(message([](GasTable& t) { t.cross_section[5] = -1; }), HasSubstr("a cross section of -1 m2"));
  EXPECT_THAT(message([](GasTable& t) { t.water_self.pop_back(); }), HasSubstr("3 values of water's self continuum"));
}

}  // namespace
}  // namespace suite::format_air_table_air_table_test
