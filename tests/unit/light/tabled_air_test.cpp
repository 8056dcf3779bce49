// Air from tables: it is what the table says, both ways together are the runs' own column, nothing is extrapolated.
#include "light/tabled_air.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "light/environment.h"
#include "light/kinds/sun.h"
#include "tests/support/message_of.h"

namespace suite::tabled_air_test {
namespace {

using testing::HasSubstr;

const std::vector<double> kWavelengths = {0.49, 0.50, 0.51, 0.52, 0.53, 0.54, 0.55, 0.56, 0.57, 0.58, 0.59};
const Where kWhere{"sim.yaml", 7, 3, {}, -1};
constexpr double kSunZenith = 40 * kDegree;
const Dir kSun = dir_from_angles(kSunZenith, 0.7);
const PathAxis kZenith{"view zenith angle", "rad", 1 / kDegree, "degrees", false};
const PathAxis kRange{"range", "m", 1, "", true};

// Lines in every second wavelength: averages of their powers are no powers of averages.
double depth(size_t i) { return i % 2 ? 1.5 : 0.05 * static_cast<double>(i); }

PathSpectra path_of(double mass) {
  PathSpectra s;
  for (size_t i = 0; i < kWavelengths.size(); ++i) {
    s.transmittance.push_back(std::exp(-depth(i) * mass));
    s.radiance.push_back(10 * (1 - std::exp(-depth(i) * mass)));
    s.two_way.push_back(std::exp(-depth(i) * (mass + 1 / std::cos(kSunZenith))));
  }
  return s;
}

// From 3000 m to the ground, at 120 to 180 degrees from the zenith.
SightTable downward() {
  std::vector<PathRun> runs;
  for (const double zenith : {120.0, 150.0, 180.0})
    runs.push_back({{zenith * kDegree}, path_of(-1 / std::cos(zenith * kDegree)), {}});
  SightTable table{PathTable({kZenith}, kWavelengths, runs), {SightAxis::view_zenith}, {}, 0, false};
  table.alike[SightAxis::observer_height] = 3000;
  table.alike[SightAxis::end_height] = 0;
  table.alike[SightAxis::solar_zenith] = kSunZenith;
  return table;
}

TabledAirSpec spec_of(SightTable sights) {
  TabledAirSpec spec;
  spec.sights = std::move(sights);
  spec.where = kWhere;
  return spec;
}

SpectralState four_bins() {
  const std::vector<Band> bands{Band::rectangular("b", 0.54, 0.08)};
  return make_state(bands, 0.02);
}
std::vector<std::pair<double, double>> intervals(const SpectralState& state) {
  std::vector<std::pair<double, double>> all;
  for (const Bin& b : state.bins) all.emplace_back(b.low_um, b.high_um);
  return all;
}

struct Both {
  std::vector<float> T, S;
};
Both along(const Atmosphere& air, Vec3 from, Dir d, double distance) {
  Both b{std::vector<float>(4), std::vector<float>(4)};
  air.path(from, d, distance, b.T, b.S);
  return b;
}
std::vector<float> through(const Atmosphere& air, Vec3 from, Dir d, double distance) {
  std::vector<float> T(4);
  air.transmittance(from, d, distance, T);
  return T;
}
Dir down(double zenith_deg) { return dir_from_angles(zenith_deg * kDegree, 2.1); }
constexpr Vec3 kEye{0, 0, 3000};
// To the ground of a round Earth, about.
double to_ground(double zenith_deg) { return -3000 / std::cos(zenith_deg * kDegree); }

const std::vector<float> kAbove(4, 1800.0f);
const TabledSun kTabledSun{{kSun, kAbove.data()}, 0};

TEST(TabledAir, PathsAreThoseOfTheTableOverBins) {
  const SpectralState state = four_bins();
  ASSERT_EQ(state.size(), 4u);
  const auto air = make_tabled_air(spec_of(downward()), state, kTabledSun);
  const PathTable means = downward().table.averaged(intervals(state));
  for (const double zenith : {120.0, 135.0, 163.0, 180.0}) {
    PathSpectra expected;
    means.at(std::array{zenith * kDegree}, expected);
    const Both seen = along(*air, kEye, down(zenith), to_ground(zenith));
    for (size_t i = 0; i < 4; ++i) {
      EXPECT_NEAR(seen.T[i], expected.transmittance[i], 1e-6) << zenith;
      EXPECT_NEAR(seen.S[i], expected.radiance[i], 1e-5) << zenith;
    }
    EXPECT_EQ(through(*air, kEye, down(zenith), to_ground(zenith)), seen.T);
    // A ray that meets nothing ends where the runs do.
    EXPECT_EQ(along(*air, kEye, down(zenith), INFINITY).S, seen.S);
  }
}

TEST(TabledAir, NothingIsExtrapolated) {
  TabledAirSpec spec = spec_of(downward());
  const auto told = [&](Vec3 from, double zenith, double distance) {
    return message_of([&] { along(*make_tabled_air(spec, four_bins(), kTabledSun), from, down(zenith), distance); });
  };
  EXPECT_EQ(told(kEye, 150, to_ground(150)), "no error");
  EXPECT_THAT(
      told(kEye, 110, to_ground(110)),
      AllOf(HasSubstr("sim.yaml:7:3: error: the tables have no run for a line of sight from (0, 0, 3000) m: its "
                      "view zenith angle is 110 degrees, and the runs have 120 to 180 degrees"),
            HasSubstr("angle_tolerance_deg: 10.1")));
  EXPECT_THAT(told({0, 0, 2000}, 180, 2000), HasSubstr("observer's height is 2000 m, and the runs have 3000 m"));
  EXPECT_THAT(told(kEye, 180, 2000), HasSubstr("height of the end is 1000 m, and the runs have 0 m"));
  spec.within_angle = 10.1 * kDegree;
  EXPECT_EQ(told(kEye, 110, to_ground(110)), "no error");
  spec.within_height = 1100;
  EXPECT_EQ(told(kEye, 180, 2000), "no error");
  // Another Sun than that of the runs.
  spec.within_angle = kDegree;
  const TabledSun low{{dir_from_angles(60 * kDegree, 0), kAbove.data()}, 0};
  const auto air = make_tabled_air(spec, four_bins(), low);
  EXPECT_THAT(message_of([&] {
                along(*air, kEye, {0, 0, -1}, 3000);
              }),
              HasSubstr("solar zenith angle is 60 degrees, and the runs have 40 degrees"));
  // A band that ends where the runs end, to a rounding; and one that they do not have.
  const std::vector<Band> all{Band::rectangular("b", 0.54, 0.1 + 1e-15)};
  EXPECT_EQ(message_of([&] { make_tabled_air(spec, make_state(all, 0.02), kTabledSun); }), "no error");
  const std::vector<Band> far{Band::rectangular("b", 0.6, 0.02)};
  EXPECT_THAT(message_of([&] { make_tabled_air(spec, make_state(far, 0.01), kTabledSun); }),
              HasSubstr("sim.yaml:7:3: error: the path table does not cover 0.59"));
}

TEST(TabledAir, RangesEndWhereTheRunsEnd) {
  std::vector<PathRun> runs;
  for (const double range : {500.0, 2000.0}) runs.push_back({{range}, path_of(range / 1000), {}});
  SightTable level{PathTable({kRange}, kWavelengths, runs), {SightAxis::range}, {}, 500, false};
  level.alike[SightAxis::view_zenith] = kPi / 2;
  const auto air = make_tabled_air(spec_of(level), four_bins(), std::nullopt);
  EXPECT_EQ(along(*air, {}, {1, 0, 0}, 0).T, std::vector<float>(4, 1.0f));
  EXPECT_LT(along(*air, {}, {1, 0, 0}, 1500).T[3], 1);
  EXPECT_THAT(message_of([&] {
                along(*air, {}, {1, 0, 0}, 2500);
              }),
              HasSubstr("range is 2500 m, and the runs have 0 to 2000 m; runs that go so far"));
  EXPECT_THAT(message_of([&] {
                along(*air, {}, normalized(Vec3{1, 0, -1e-3}), INFINITY);
              }),
              HasSubstr("it meets nothing, and the runs have a range of 0 to 2000 m"));
}

TEST(TabledAir, BothWaysTogetherAreTheRunsOwnColumn) {
  const SpectralState state = four_bins();
  TabledAirSpec spec = spec_of(downward());
  ASSERT_TRUE(spec.two_way());
  spec.from = TabledAirSpec::Places{{Box3{{-1, -1, 2999}, {1, 1, 3001}}}, kEye};
  const auto air = make_tabled_air(spec, state, kTabledSun);
  const PathTable means = downward().table.averaged(intervals(state));
  double product_off = 0;
  for (const double zenith : {125.0, 150.0, 172.0}) {
    const Dir d = down(zenith);
    const Vec3 ground = kEye + d * to_ground(zenith);
    PathSpectra expected;
    means.at(std::array{zenith * kDegree}, expected);
    const std::vector<float> view = along(*air, kEye, d, to_ground(zenith)).T,
                             sun = through(*air, ground, kSun, INFINITY);
    for (size_t i = 0; i < 4; ++i) {
      EXPECT_NEAR(view[i] * sun[i], expected.two_way[i], 2e-6) << zenith;
      // Control: the average of the Sun's way alone is another number.
      const Curve alone(
          kWavelengths,
          [] {
            std::vector<double> t;
            for (size_t k = 0; k < kWavelengths.size(); ++k) t.push_back(std::exp(-depth(k) / std::cos(kSunZenith)));
            return t;
          }(),
          Outside::error);
      product_off = std::max(product_off, std::fabs(view[i] * alone.mean(state.bins[i].low_um, state.bins[i].high_um) -
                                                    expected.two_way[i]));
    }
  }
  EXPECT_GT(product_off, 0.05);
  // Other lights from outside are as they are at the ground.
  EXPECT_EQ(through(*air, {}, {0, 0, 1}, INFINITY), std::vector<float>(4, 1.0f));
}

TEST(TabledAir, LiesBeforeSensorsOnly) {
  TabledAirSpec spec = spec_of(downward());
  spec.from = TabledAirSpec::Places{{Box3{{-1, -1, 2999}, {1, 1, 3001}}}, kEye};
  const auto air = make_tabled_air(spec, four_bins(), kTabledSun);
  const Both between = along(*air, {10, 0, 5}, {0, 1, 0}, 40);
  EXPECT_EQ(between.T, std::vector<float>(4, 1.0f));
  EXPECT_EQ(between.S, std::vector<float>(4, 0.0f));
  EXPECT_LT(along(*air, kEye, {0, 0, -1}, 3000).T[0], 1);
  // The same everywhere: between all places.
  std::vector<PathRun> runs{{{2000.0}, path_of(2), {}}};
  spec.sights = SightTable{PathTable({kRange}, kWavelengths, runs), {SightAxis::range}, {}, 2000, true};
  EXPECT_LT(along(*make_tabled_air(spec, four_bins(), kTabledSun), {10, 0, 5}, {0, 1, 0}, 40).T[1], 1);
}

// From a satellite a line of sight enters the air of the runs at another angle: (R + h) sin(angle) is the same.
TEST(TabledAir, SightsFromSpaceBeginWhereTheRunsDo) {
  SightTable table = downward();
  table.alike[SightAxis::observer_height] = 100e3;
  table.alike[SightAxis::solar_zenith].reset();
  SightWorld world;
  world.within_height = 100;
  const double zenith = 160 * kDegree;
  const Sight sight = sight_of(table, world, {0, 0, 705e3}, dir_from_angles(zenith, 1), INFINITY);
  EXPECT_NEAR(*sight[SightAxis::observer_height], 100e3, 1e-6);
  EXPECT_NEAR(*sight[SightAxis::end_height], 0, 1e-6);
  EXPECT_NEAR(std::sin(*sight[SightAxis::view_zenith]) / (std::sin(zenith) * (6371e3 + 705e3) / (6371e3 + 100e3)), 1,
              1e-12);
  EXPECT_FALSE(uncovered(table, world, sight));
  // From below the top of the air it is the height that counts.
  EXPECT_TRUE(uncovered(table, world, sight_of(table, world, {0, 0, 20e3}, {0, 0, -1}, INFINITY)));
}

SightTable whole_sky(double last_zenith_deg) {
  std::vector<PathRun> runs;
  for (const double zenith : {0.0, 45.0, last_zenith_deg})
    for (const double turn : {0.0, 180.0}) {
      PathRun run{{zenith * kDegree, turn * kDegree}, {}, {}};
      run.spectra.radiance.assign(kWavelengths.size(), zenith == 0 ? 50 : 20 + zenith + 0.1 * turn);
      run.spectra.irradiance.assign(kWavelengths.size(), 900);
      runs.push_back(run);
    }
  const PathAxis turn{"relative azimuth", "rad", 1 / kDegree, "degrees", false};
  SightTable sky{PathTable({kZenith, turn}, kWavelengths, runs),
                 {SightAxis::view_zenith, SightAxis::relative_azimuth},
                 {},
                 0,
                 false};
  sky.alike[SightAxis::solar_zenith] = kSunZenith;
  return sky;
}

TEST(TabledAir, SkyAndSunAtTheGround) {
  TabledAirSpec spec;
  spec.where = kWhere;
  spec.sky = spec.sun = whole_sky(90);
  const auto air = make_tabled_air(spec, four_bins(), kTabledSun);
  for (const double turn : {0.0, 60.0, 180.0}) {
    std::vector<float> T(4), S(4);
    const Dir d = dir_from_angles(45 * kDegree, azimuth(kSun) + turn * kDegree);
    air->skylight({0, 0, 10}, d, T, S);
    EXPECT_NEAR(S[0], 65 + 0.1 * turn, 1e-3) << turn;
    EXPECT_GT(air->sky_density(d), 0);
  }
  EXPECT_EQ(air->sky_density({0, 0, -1}), 0);
  for (const float t : through(*air, {}, kSun, INFINITY)) EXPECT_NEAR(t, 0.5, 1e-6);  // 900 of 1800
}

TEST(TabledAir, WhatCannotBeBesideIt) {
  const Scene plain;
  SourceSpecs sources;
  sources.add(SunSpec{{kSun, 0, Curve::constant(1800)}});
  const auto told = [&](const TabledAirSpec& spec, const SourceSpecs& beside, const Scene& scene) {
    return message_of([&] { check_tabled_air(spec, beside, scene); });
  };
  TabledAirSpec spec = spec_of(downward());
  EXPECT_EQ(told(spec, sources, plain), "no error");
  Scene foggy;
  foggy.ambient = 0;
  EXPECT_THAT(told(spec, sources, foggy), HasSubstr("sim.yaml:7:3: error: the scene has media"));
  SourceSpecs two = sources;
  two.add(SunSpec{{kSun, 0, Curve::constant(1)}});
  EXPECT_THAT(told(spec, two, plain), HasSubstr("a further sun"));
  spec.sky = whole_sky(80);
  EXPECT_THAT(told(spec, sources, plain),
              HasSubstr("do not have the whole sky over the scene: its view zenith angle is 90 degrees, and the runs "
                        "have 0 to 80 degrees"));
  spec.within_angle = 10.5 * kDegree;
  EXPECT_EQ(told(spec, sources, plain), "no error");
  EXPECT_THAT(told(spec, {}, plain), HasSubstr("there is no sun in the simulation; give `sun`"));
  // Without a two-way column and a run of sunlight.
  std::vector<PathRun> runs{{{}, {{0.5, 0.5}, {1, 1}, {}, {}}, {}}};
  spec.sky.reset();
  spec.sights = SightTable{PathTable({}, {0.5, 0.6}, runs), {}, {}, 0, false};
  EXPECT_THAT(told(spec, sources, plain), HasSubstr("no run of the tables has sunlight at the ground"));
  EXPECT_EQ(told(spec, {}, plain), "no error");
}

}  // namespace
}  // namespace suite::tabled_air_test
