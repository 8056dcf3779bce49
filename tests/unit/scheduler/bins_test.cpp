// Bins that are chosen from what a sensor looks at.
#include "scheduler/bins.h"

#include <gtest/gtest.h>

#include "support/bins_kit.h"

namespace suite::bins_test {
namespace {

using test::BinSensor;
using test::sun_of;

const std::vector<Band> kBands{Band::gaussian("narrow", 0.7, 0.012), Band::gaussian("wide", 0.85, 0.06)};
// An absorption line inside the narrow band.
const Curve kLine({0.5, 0.694, 0.696, 0.698, 1.2}, {1000, 1000, 100, 1000, 1000}, Outside::hold);
const auto kScene = test::scene_of({test::quad(1, 0, 0)}, {test::material("grey", test::lambert(0.5))});

BinReport chosen(BinSensor& sensor, const Scene& scene, const SourceSpecs& sources) {
  return choose_bins(scene, {&sources, 1}, sensor).at(0);
}
Material coloured(const std::string& id, const Curve& reflectance) {
  ModelSpec spec;
  spec.model = "lambert";
  spec.curves["reflectance"] = reflectance;
  return test::material(id, spec);
}

TEST(Bins, FollowALineThatEvenBinsMiss) {
  BinSensor even({Ray{}}, kBands, 1, 0), sensor({Ray{}}, kBands, 1, 1e-3);
  const BinReport before = chosen(even, *kScene, sun_of(kLine)), after = chosen(sensor, *kScene, sun_of(kLine));
  EXPECT_FALSE(before.met());
  EXPECT_EQ(before.band, "narrow");
  EXPECT_EQ(before.under, "the sun");
  EXPECT_GT(test::error_of(even.state(), kBands, {kLine}), 5e-3);  // negative control
  EXPECT_TRUE(after.met()) << after.text();
  EXPECT_LE(test::error_of(sensor.state(), kBands, {kLine}), 1e-3);
  EXPECT_LT(sensor.state().size(), even.state().size());
}

TEST(Bins, AreOneAStretchWhereNothingChanges) {
  for (const SourceSpecs& sources : {sun_of(Curve::constant(1000)), SourceSpecs{}}) {
    BinSensor sensor({Ray{}}, kBands, 1, 1e-3);
    const BinReport r = chosen(sensor, *kScene, sources);
    EXPECT_TRUE(r.met());
    EXPECT_LT(r.reached, 1e-6);
    EXPECT_EQ(sensor.state().size(), 2u);
    EXPECT_TRUE(sensor.state().shares.empty());
  }
}

TEST(Bins, OfOneABandStayToTheBit) {
  const std::vector<Band> bands{Band::rectangular("a", 0.55, 0.01), Band::rectangular("b", 0.65, 0.01)};
  BinSensor sensor({Ray{}}, bands, 1, 1e-3);
  const SpectralState before = sensor.state();
  chosen(sensor, *kScene, sun_of(Curve({0.5, 1.2}, {1000, 1001}, Outside::hold)));
  ASSERT_EQ(sensor.state().size(), before.size());
  for (size_t k = 0; k < before.size(); ++k) {
    EXPECT_EQ(sensor.state().bins[k].low_um, before.bins[k].low_um);
    EXPECT_EQ(sensor.state().bins[k].high_um, before.bins[k].high_um);
  }
  EXPECT_EQ(sensor.state().knots, before.knots);
  EXPECT_TRUE(BandProjection(sensor.state(), bands).identity());
}

TEST(Bins, FollowProductsOfLightAndMaterials) {
  // All change in opposite senses from step to step: only their products tell.
  std::vector<double> um, rho, light, other;
  for (int i = 0; i <= 200; ++i)
    um.push_back(0.6 + 0.002 * i), rho.push_back(i % 2 ? 0.9 : 0.1), light.push_back(i % 2 ? 900 : 100),
        other.push_back(i % 3 ? 0.6 : 0.2);
  const Curve a(um, rho, Outside::hold), b(um, other, Outside::hold), sun(um, light, Outside::hold);
  const auto scene = test::scene_of({test::quad(1, 0, 0)}, {coloured("a", a), coloured("b", b)});
  BinSensor sensor({Ray{}}, kBands, 1, 1e-3);
  const BinReport r = chosen(sensor, *scene, sun_of(sun));
  EXPECT_TRUE(r.met()) << r.text();
  for (const std::vector<Curve>& product :
       std::vector<std::vector<Curve>>{{sun}, {sun, a}, {sun, b}, {sun, a, b}, {sun, a, a}, {sun, a, b, b}})
    EXPECT_LE(test::error_of(sensor.state(), kBands, product, 1e-5), 1e-3);  // the combs are steep for 0.1 nm
}

TEST(Bins, FollowWarmMaterials) {
  auto scene = test::scene_of({test::quad(1, 0, 0)}, {test::material("warm", test::lambert(0.1))});
  scene->materials[0].temperature_k = 300;  // at 0.85 um it grows 40-fold over the band
  BinSensor even({Ray{}}, kBands, 1, 0, 0.03), sensor({Ray{}}, kBands, 1, 1e-3);
  EXPECT_EQ(chosen(even, *scene, {}).under, "a blackbody of 300 K");
  EXPECT_TRUE(chosen(sensor, *scene, {}).met());
}

TEST(Bins, TellWhatRemainsWhereLinesAreTooFine) {
  // 50 000 lines in a band: the cells that are carried do not follow them, and at first halving them changes nothing.
  // Light and material have the same ones: the mean of the product is 1/3, the product of the means 1/4.
  std::vector<double> um, comb;
  for (int i = 0; i <= 100000; ++i) um.push_back(0.8 + 1e-6 * i), comb.push_back(i % 2);
  const Curve lines(um, comb, Outside::hold);
  const auto scene = test::scene_of({test::quad(1, 0, 0)}, {coloured("lines", lines)});
  const std::vector<Band> bands{Band::rectangular("b", 0.85, 0.1)};
  BinSensor sensor({Ray{}}, bands, 1, 1e-3);
  const BinReport r = chosen(sensor, *scene, sun_of(lines));
  EXPECT_FALSE(r.met());
  EXPECT_GT(r.reached, 0.2);
  EXPECT_LE(sensor.state().size(), 512u);
}

AirSpec summer() {
  AirSpec air;
  air.profile = standard_profile("midlatitude_summer");
  air.gases = shared_builtin_gases();
  return air;
}

bool alike(const SpectralState& a, const SpectralState& b) {
  return a.bins == b.bins && a.knots == b.knots && a.shares == b.shares;
}

// Sensors of a simulation get what each would get by itself; those that are alike are not looked at again.
struct Asked {
  BinSensor sensor;
  bool anew;
};
void expect_as_alone(const SourceSpecs& sources, std::vector<Asked> asked) {
  BinChooser chooser(*kScene, {&sources, 1});
  size_t found = 0;
  for (Asked& a : asked) {
    BinSensor alone = a.sensor;
    const std::string by_itself = chosen(alone, *kScene, sources).text();
    EXPECT_EQ(chooser.choose(a.sensor).at(0).text(), by_itself);
    EXPECT_TRUE(alike(a.sensor.state(), alone.state())) << by_itself;
    EXPECT_EQ(chooser.found(), found += a.anew) << by_itself;
  }
}
const std::vector<Ray> kLow{{{0, 0, 500}, {0, 0, -1}, 0}}, kHigh{{{0, 0, 3000}, {0, 0, -1}, 0}};

TEST(Bins, OfSensorsThatAreAlikeAreFoundOnce) {
  const std::vector<Band> other{kBands[0], Band::gaussian("wide", 0.86, 0.06)},
      renamed{kBands[0], Band::gaussian("broad", 0.85, 0.06)};
  expect_as_alone(sun_of(kLine), {{{kLow, kBands, 1, 1e-2}, true},
                                  {{kLow, kBands, 1, 1e-2}, false},
                                  {{kHigh, kBands, 1, 1e-2}, false},
                                  {{kLow, other, 1, 1e-2}, true},
                                  {{kLow, kBands, 1, 2e-2}, true},
                                  {{kLow, renamed, 1, 1e-2}, true},
                                  {{kLow, other, 1, 1e-2}, false}});
}

// Through air it matters from where and along which way a sensor looks.
TEST(Bins, OfSensorsThatAreAlikeInAirAreFoundOnce) {
  SourceSpecs sources = sun_of(kLine);
  sources.air = std::make_shared<AirSpec>(summer());
  const std::vector<Band> narrow{Band::gaussian("narrow", 0.7, 0.004)};
  const std::vector<Ray> slanted{{{0, 0, 500}, dir_from_angles(130 * kDegree, 0), 0}};
  expect_as_alone(sources, {{{kLow, narrow, 1, 1e-2}, true},
                            {{kLow, narrow, 1, 1e-2}, false},
                            {{kHigh, narrow, 1, 1e-2}, true},
                            {{slanted, narrow, 1, 1e-2}, true}});
}

TEST(Bins, LeaveNoStretchOfTheWidestStepAlone) {
  const std::vector<Band> bands{Band::rectangular("b", 0.7, 0.1)};
  const Curve sun({0.5, 0.7, 1}, {1000, 1200, 900}, Outside::hold);
  BinSensor sensor({Ray{}}, bands, 1, 1e-3, 0.02);
  chosen(sensor, *kScene, sun_of(sun));
  for (int i = 0; i < 5; ++i) {
    double share = 0;
    for (size_t k = 0; k < sensor.state().size(); ++k)
      if (std::fabs(sensor.state().bins[k].center_um() - (0.66 + 0.02 * i)) < 0.01)
        share += BandProjection(sensor.state(), bands).weight(0, k);
    EXPECT_NEAR(share, 0.2, 0.02) << i;
  }
}

}  // namespace
}  // namespace suite::bins_test
