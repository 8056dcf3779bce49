// A thermal image at night through humid air, through both programs: the numbers of expect.md of the sample, and what
// the air takes from a difference of temperature on the ground.
#include <cstdio>

#include "spectral/planck.h"
#include "support/sample_kit.h"

namespace suite::night_window_test {
namespace {

constexpr size_t kBands = 4;
struct BandOf {
  const char* name;
  double low_um, high_um;
};
constexpr BandOf kBandsOf[kBands] = {
    {"short window", 8.4, 8.8}, {"ozone", 9.4, 9.9}, {"window", 10.3, 11.3}, {"long window", 11.5, 12.5}};

class NightWindow : public SampleScene {
 protected:
  NightWindow() : SampleScene("night_window") {}
};

struct Place {
  const char* name;
  size_t column, row;
};
constexpr Place kLake{"lake", 2, 9}, kPond{"pond", 17, 13}, kGrass{"grass", 11, 10}, kRoof{"roof", 15, 5};

double radiance(const BandOf& band, double kelvin) { return planck_band_radiance(band.low_um, band.high_um, kelvin); }

// Lake and pond differ in nothing but 8 K: of the difference of their radiances the zenith transmittance comes through,
// whatever else the air adds.
TEST_F(NightWindow, DifferencesShrinkByTheTransmittance) {
  render_small("out", "--paths 256");
  const CommandResult told = run("dirsig-render sim.yaml --air");
  ASSERT_EQ(told.code, 0) << told.err;
  const size_t sensor = told.out.find("sensor 'space'");
  ASSERT_NE(sensor, std::string::npos);
  for (size_t b = 0; b < kBands; ++b) {
    const BandOf& band = kBandsOf[b];
    double transmittance = 0;
    const size_t row = told.out.find(std::string("  ") + band.name, sensor);
    ASSERT_NE(row, std::string::npos) << told.out;
    ASSERT_EQ(std::sscanf(told.out.c_str() + row + 2 + std::string(band.name).size(), "%*g um %lg", &transmittance), 1);
    const double seen = radiance(band, value("out/space.img", kPond.column, kPond.row, b)) -
                        radiance(band, value("out/space.img", kLake.column, kLake.row, b));
    const double sent = 0.985 * (radiance(band, 309) - radiance(band, 301));
    EXPECT_NEAR(seen / sent, transmittance, 0.02 * transmittance) << band.name;
  }
}

// The table of expect.md, from 2 km and from space.
TEST_F(NightWindow, ShowsWhatIsExpected) {
  render_small("out", "--paths 256");
  struct Row {
    Place place;
    double low[kBands], space[kBands];
  };
  for (const Row& r : {Row{kLake, {297.6, 298.1, 298.0, 296.8}, {293.2, 277.3, 295.8, 293.8}},
                       Row{kPond, {302.4, 303.2, 302.8, 300.4}, {297.8, 281.1, 300.3, 296.9}},
                       Row{kGrass, {294.0, 294.3, 294.4, 294.1}, {289.9, 274.4, 292.6, 291.6}},
                       Row{kRoof, {280.7, 281.1, 280.7, 287.3}, {277.5, 263.9, 280.3, 285.6}}})
    for (size_t b = 0; b < kBands; ++b) {
      EXPECT_NEAR(value("out/low.img", r.place.column, r.place.row, b), r.low[b], 0.6) << r.place.name << b;
      EXPECT_NEAR(value("out/space.img", r.place.column, r.place.row, b), r.space[b], 0.6) << r.place.name << b;
    }
  // Without air the lake is its own.
  render_small("bare", "--paths 16 --set atmosphere=null");
  EXPECT_NEAR(value("bare/space.img", kLake.column, kLake.row, 2), 300, 0.3);
}

}  // namespace
}  // namespace suite::night_window_test
