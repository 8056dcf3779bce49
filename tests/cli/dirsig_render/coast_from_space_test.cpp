// A satellite's view through real air, through both programs: what surfaces and air make of reflectances and
// temperatures, in the bounds of expect.md of the sample.
#include <cmath>
#include <cstdio>

#include "math/vec.h"
#include "spectral/curve.h"
#include "support/sample_kit.h"

namespace suite::coast_from_space_test {
namespace {

class CoastFromSpace : public SampleScene {
 protected:
  CoastFromSpace() : SampleScene("coast_from_space") {}
};

TEST_F(CoastFromSpace, IsSeenThroughItsAir) {
  render_small("even", "--paths 64 --set atmosphere.adjacency=false");
  struct Row {
    size_t band;
    double grass_low, grass_high, sea_low, sea_high;
  };
  for (const Row& r :
       {Row{0, 0.108, 0.132, 0.108, 0.132}, Row{2, 0.066, 0.082, 0.043, 0.054}, Row{3, 0.12, 0.18, 0.012, 0.021},
        Row{4, 0.38, 0.44, 0.022, 0.031}, Row{5, 0, 0.002, 0, 0.002}, Row{6, 0.22, 0.26, 0.009, 0.02}}) {
    const double grass = value("even/solar.img", 12, 9, r.band), sea = value("even/solar.img", 1, 1, r.band);
    EXPECT_GT(grass, r.grass_low) << r.band;
    EXPECT_LT(grass, r.grass_high) << r.band;
    EXPECT_GT(sea, r.sea_low) << r.band;
    EXPECT_LT(sea, r.sea_high) << r.band;
  }
  EXPECT_NEAR(value("even/thermal.img", 12, 9, 0), 294.3, 1.5);
  EXPECT_NEAR(value("even/thermal.img", 1, 1, 0), 290.8, 1.5);
  EXPECT_NEAR(value("even/thermal.img", 12, 9, 1), 270.4, 4);
}

// The island's own light in the air above it; traced air: 0.448 +- 0.010 and 0.256 +- 0.005.
TEST_F(CoastFromSpace, IslandsShineIntoTheirAir) {
  render_small("out", "--paths 256");
  EXPECT_NEAR(value("out/solar.img", 12, 9, 4), 0.460, 0.025);
  EXPECT_NEAR(value("out/solar.img", 12, 9, 6), 0.258, 0.009);
}

TEST_F(CoastFromSpace, IsTheGroundWithoutIt) {
  render_small("bare", "--paths 4 --set atmosphere=null");
  EXPECT_NEAR(value("bare/solar.img", 12, 9, 4), 0.488, 0.002);
}

// What `--air` prints of a band.
struct AirRow {
  double transmittance = 0, scattering = 0, direct = 0, diffuse = 0;
};
AirRow row_of(const std::string& air, const std::string& band) {
  AirRow row;
  const size_t at = air.find("  " + band + " ");
  const char* from = at == std::string::npos ? "" : air.c_str() + at + 2 + band.size();
  EXPECT_EQ(std::sscanf(from, "%*g um %lg %lg %lg %lg", &row.transmittance, &row.scattering, &row.direct, &row.diffuse),
            4)
      << band;
  return row;
}

struct BandOf {
  const char* name;
  size_t index;
  double low_um, high_um, bound;  // bound: relative, of the reflectance that is found
};
constexpr size_t kBands = 7;
// Under the oxygen band none: light there and back passes one set of lines, and means of a band do not multiply.
constexpr BandOf kBandsOf[] = {{"blue", 0, 0.45, 0.51, 0.02},          {"green", 1, 0.53, 0.59, 0.02},
                               {"red", 2, 0.635, 0.675, 0.02},         {"oxygen", 3, 0.759, 0.765, 0.55},
                               {"near infrared", 4, 0.85, 0.88, 0.02}, {"short wave", 6, 1.57, 1.65, 0.03}};
struct Patch {
  const char* name;
  size_t column, row;
  Curve reflectance;
};
// As scene.yaml has them.
std::vector<Patch> patches() {
  constexpr Outside none = Outside::error;
  const Curve sea({0.3, 0.45, 0.5, 0.56, 0.65, 0.72, 1, 8}, {0.05, 0.05, 0.045, 0.035, 0.015, 0.005, 0.002, 0.01},
                  none),
      sand({0.3, 0.45, 0.65, 0.9, 1.3, 1.7}, {0.08, 0.18, 0.32, 0.4, 0.46, 0.5}, none),
      grass({0.3, 0.45, 0.5, 0.56, 0.68, 0.75, 0.9, 1.3, 1.45, 1.65},
            {0.03, 0.04, 0.05, 0.1, 0.04, 0.45, 0.5, 0.45, 0.2, 0.3}, none);
  return {{"sea", 1, 1, sea}, {"sand", 18, 1, sand}, {"grass", 12, 1, grass}};
}

// Back from space to the surfaces, with what the program tells of its air: pi (L - path radiance - adjacency) / (T E).
TEST_F(CoastFromSpace, IsTakenBackToTheGround) {
  render("parts",  // three lines across the island
         "--paths 64 --set sensors.0.units=radiance --set 'sensors.0.channels=[path_radiance, adjacency]' --set "
         "sensors.0.columns=24 --set sensors.0.rows=3 --set sensors.0.pitch_um=40 --set sensors.1.columns=1 --set "
         "sensors.1.rows=1");
  const CommandResult told = run("dirsig-render sim.yaml --air");
  for (const BandOf& band : kBandsOf)
    for (const Patch& patch : patches()) {
      const AirRow air = row_of(told.out, band.name);
      const auto part = [&](size_t channel) {
        return value("parts/solar.img", patch.column, patch.row, channel * kBands + band.index);
      };
      const double there = patch.reflectance.integral(band.low_um, band.high_um) / (band.high_um - band.low_um),
                   per_radiance = kPi / (air.transmittance * (air.direct + air.diffuse)),
                   seen = per_radiance * (part(0) - part(1)), found = seen - per_radiance * part(2);
      std::printf("%s, %s: %.4f, found %.4f (%+.2f %%), with its surroundings %.4f\n", patch.name, band.name, there,
                  found, 100 * (found / there - 1), seen);
      EXPECT_NEAR(found, there, band.bound * there) << patch.name << " " << band.name;
      if (band.bound > 0.5) {
        EXPECT_GT(found, 1.3 * there) << patch.name;
      }
      if (band.index == 4 && patch.column == 12) {
        EXPECT_GT(std::fabs(seen / there - 1), 0.08) << patch.name << ": control";
      }
    }
}

// In numbers: the direct and the diffuse light of a summer's forenoon.
TEST_F(CoastFromSpace, HasAirThatIsTold) {
  const CommandResult told = run("dirsig-render sim.yaml --air");
  ASSERT_EQ(told.code, 0) << told.err;
  const AirRow green = row_of(told.out, "green");
  // Depths: molecules 0.09, ozone 0.03, maritime aerosol of this visibility 0.2 to 0.28.
  EXPECT_NEAR(green.transmittance, 0.69, 0.03);
  EXPECT_NEAR(green.scattering, 0.33, 0.04);
  EXPECT_GT(green.direct, 1000);
  EXPECT_LT(green.direct, 1400);
  EXPECT_GT(green.diffuse, 200);
  EXPECT_LT(green.diffuse, 500);
  EXPECT_EQ(run("dirsig-render sim.yaml --air --set atmosphere=null").code, 1);
}

}  // namespace
}  // namespace suite::coast_from_space_test
