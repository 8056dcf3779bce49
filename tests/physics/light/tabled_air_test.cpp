// Rendered through tables of air: sun, ground and air together are what the tables' own columns say.
#include "light/tabled_air.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "scheduler/bins.h"
#include "scheduler/through_tables.h"
#include "support/message_of.h"
#include "support/radiometry_kit.h"

namespace suite::test::tabled_air_test {
namespace {

using testing::HasSubstr;

constexpr double kSunZenith = 40 * kDegree, kAlbedo = 0.3, kIrradiance = 1700;
const std::vector<double> kWavelengths = [] {
  std::vector<double> w;
  for (int i = 0; i <= 200; ++i) w.push_back(0.5 + 0.0005 * i);
  return w;
}();
// Lines that both ways share: half of all wavelengths are nearly opaque.
double depth(size_t i) { return i / 25 % 2 ? 1.2 : 0.02; }

SightTable downward(bool two_way) {
  std::vector<PathRun> runs;
  for (const double zenith : {140.0, 180.0}) {
    PathRun run{{zenith * kDegree}, {}, {}};
    const double mass = -1 / std::cos(zenith * kDegree);
    for (size_t i = 0; i < kWavelengths.size(); ++i) {
      run.spectra.transmittance.push_back(std::exp(-depth(i) * mass));
      run.spectra.radiance.push_back(12 * (1 - std::exp(-depth(i) * mass)));
      if (two_way) run.spectra.two_way.push_back(std::exp(-depth(i) * (mass + 1 / std::cos(kSunZenith))));
    }
    runs.push_back(std::move(run));
  }
  SightTable table{PathTable({{"view zenith angle", "rad", 1 / kDegree, "degrees", false}}, kWavelengths, runs),
                   {SightAxis::view_zenith},
                   {},
                   0,
                   false};
  table.alike[SightAxis::observer_height] = 3000;
  table.alike[SightAxis::end_height] = 0;
  return table;
}

SightTable sunlight() {
  PathRun run{{}, {}, {}};
  for (size_t i = 0; i < kWavelengths.size(); ++i)
    run.spectra.irradiance.push_back(kIrradiance * std::exp(-depth(i) / std::cos(kSunZenith)));
  return {PathTable({}, kWavelengths, {run}), {}, {}, 0, false};
}

SourceSpecs sources_of(TabledAirSpec spec) {
  SourceSpecs sources;
  spec.where = {"sim.yaml", 4, 13, {}, -1};
  sources.tabled = std::make_shared<const TabledAirSpec>(std::move(spec));
  sources.add(SunSpec{{dir_from_angles(kSunZenith, 1), 0, Curve::constant(kIrradiance)}});
  return sources;
}

const std::vector<Band> kBands{Band::rectangular("a", 0.525, 0.04), Band::rectangular("b", 0.575, 0.04)};

// The mean over a band of what a function of the wavelength's number says: of the curve through these values.
double mean_over(const Band& band, const std::function<double(size_t)>& of) {
  std::vector<double> values;
  for (size_t i = 0; i < kWavelengths.size(); ++i) values.push_back(of(i));
  return Curve(kWavelengths, values, Outside::error).mean(band.low_um(), band.high_um());
}

CaptureResult seen(const SourceSpecs& written, double step_um) {
  const auto scene = scene_of({quad(2e4, 0, 0)}, {material("ground", lambert(kAlbedo))});
  std::vector<Ray> rays{{{0, 0, 3000}, {0, 0, -1}, 0}};
  SourceSpecs sources = written;
  std::vector<std::unique_ptr<Sensor>> sensors;
  sensors.push_back(std::make_unique<RaySensor>(rays, kBands, 4, step_um));
  look_through_tables(sources, *scene, sensors);
  return render(scene, sources, std::make_unique<RaySensor>(rays, kBands, 4, step_um)).result;
}

TEST(TabledAir, SunlightGoesBothWaysByTheRunsOwnColumn) {
  TabledAirSpec spec;
  spec.sights = downward(true);
  spec.sun = sunlight();  // not used beside a column of both ways
  for (const double step : {0.04, 0.005}) {
    const CaptureResult r = seen(sources_of(spec), step);
    for (size_t b = 0; b < 2; ++b) {
      const double air = mean_over(kBands[b], [](size_t i) { return 12 * (1 - std::exp(-depth(i))); });
      const double both =
          mean_over(kBands[b], [](size_t i) { return std::exp(-depth(i) * (1 + 1 / std::cos(kSunZenith))); });
      const double expected = air + kAlbedo / kPi * kIrradiance * std::cos(kSunZenith) * both;
      EXPECT_NEAR(r.radiance[b] / expected, 1, 2e-4) << step;
    }
  }
}

// Control: averages over wide bins, multiplied, are another number; the finer the bins the nearer.
TEST(TabledAir, WithoutTheColumnItIsAProductOfMeans) {
  TabledAirSpec spec, both = spec;
  spec.sights = downward(false);
  spec.sun = sunlight();
  both.sights = downward(true);
  const double wide = seen(sources_of(spec), 0.04).radiance[0], fine = seen(sources_of(spec), 0.0001).radiance[0],
               right = seen(sources_of(both), 0.04).radiance[0];
  EXPECT_GT(std::fabs(wide / right - 1), 0.05);
  // Where the tables' values jump, a straight line for the column is not the product of two.
  EXPECT_LT(std::fabs(fine / right - 1), 0.01);
}

TEST(TabledAir, SensorsThatTheRunsDoNotCoverAreRefusedBeforeRendering) {
  const auto scene = scene_of({quad(2e4, 0, 0)}, {material("ground", lambert(kAlbedo))});
  TabledAirSpec spec;
  spec.sights = downward(true);
  const auto told = [&](Vec3 from, Dir d) {
    SourceSpecs sources = sources_of(spec);
    std::vector<std::unique_ptr<Sensor>> sensors;
    sensors.push_back(std::make_unique<RaySensor>(std::vector<Ray>{{from, d, 0}}, kBands, 4));
    return message_of([&] { look_through_tables(sources, *scene, sensors); });
  };
  EXPECT_EQ(told({0, 0, 3000}, {0, 0, -1}), "no error");
  EXPECT_THAT(
      told({0, 0, 3000}, dir_from_angles(120 * kDegree, 0)),
      HasSubstr("sim.yaml:4:13: error: the tables have no run for a line of sight from (0, 0, 3000) m: its view "
                "zenith angle is 120 degrees, and the runs have 140 to 180 degrees"));
  EXPECT_THAT(told({0, 0, 5000}, {0, 0, -1}), HasSubstr("observer's height is 5000 m"));
}

// Two sensors over each other: what begins between them is no line of sight of either.
TEST(TabledAir, LiesBeforeEachSensorAlone) {
  TabledAirSpec spec;
  spec.sights = downward(true);
  SourceSpecs sources = sources_of(spec);
  const auto scene = scene_of({quad(2e4, 0, 0)}, {material("ground", lambert(kAlbedo))});
  std::vector<std::unique_ptr<Sensor>> sensors;
  for (const double height : {3000.0, 3020.0})
    sensors.push_back(std::make_unique<RaySensor>(std::vector<Ray>{{{0, 0, height}, {0, 0, -1}, 0}}, kBands, 4));
  look_through_tables(sources, *scene, sensors);
  ASSERT_TRUE(sources.tabled->from);
  ASSERT_EQ(sources.tabled->from->boxes.size(), 2u);
  EXPECT_EQ(sources.tabled->from->middle.z, 3010);
  const SpectralState state = make_state(kBands, 0.02);
  const auto air = make_tabled_air(*sources.tabled, state, std::nullopt);
  std::vector<float> T(state.size());
  air->transmittance({0, 0, 3010}, {0, 0, -1}, 3010, T);
  EXPECT_EQ(T[0], 1);
  air->transmittance({0, 0, 3020}, {0, 0, -1}, 3020, T);
  EXPECT_LT(T[0], 1);
}

TEST(TabledAir, BinsAreChosenForItsSpectra) {
  const auto scene = scene_of({quad(2e4, 0, 0)}, {material("ground", lambert(kAlbedo))});
  TabledAirSpec spec;
  spec.sights = downward(true);
  const SourceSpecs sources = sources_of(spec);
  std::vector<SeenSpectra> all = spectra_of(*scene, {&sources, 1}, kBands);
  size_t rows = 0;
  for (const SeenSpectra& s : all)
    for (const std::string& name : s.names) rows += name.find("tables") != std::string::npos;
  EXPECT_EQ(rows, 4u);  // radiance and transmittance at two ends
  const SpectralState state = make_state(kBands, 0.01);
  for (const SeenSpectra& s : all) EXPECT_EQ(s.over(state).size(), s.names.size());
}

}  // namespace
}  // namespace suite::test::tabled_air_test
