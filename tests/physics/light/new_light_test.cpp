// What a light that is one file and one row gets without anything else being told of it: its key in the simulation
// text, a place among the features, its spectrum for the choice of bins, doubts, and a picture with the right answer.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "formats/sim_text/sources.h"
#include "scheduler/bins.h"
#include "scheduler/features.h"
#include "scheduler/sensor_diagnostics.h"
#include "tests/support/message_of.h"
#include "tests/support/radiometry_kit.h"
#include "tests/support/ring_light.h"

namespace suite::test::new_light_test {
namespace {

const bool kRingAdded = (light_rows().add(ring_row()), true);

SourceSpecs read(const std::string& text) {
  const Params root = Params::parse_text(text, "x.yaml");
  std::vector<AskedCurve> asked;
  SourceSpecs s = read_sources(root, asked);
  root.reject_unread();
  return s;
}

std::unique_ptr<RaySensor> look(uint32_t paths) {
  return std::make_unique<RaySensor>(std::vector<Ray>{{{0, 0, 1}, {0, 0, -1}, 0}, {{0, 0, 1}, {0, 0, 1}, 0}},
                                     one_band(), paths);
}

TEST(NewLight, Renders) {
  // Around the zenith: irradiance pi L (sin^2 outer - sin^2 inner) of level ground. The second ray leaves the scene
  // straight up, inside the ring, where it is dark.
  const auto scene = scene_of({quad(50, 0, 0)}, {material("floor", lambert(0.5))});
  const SourceSpecs ring = read("ring: {direction: [0, 0, 1], inner_deg: 20, outer_deg: 50, radiance: 4}");
  const double expected = 0.5 * 4 * (std::pow(std::sin(50 * kDegree), 2) - std::pow(std::sin(20 * kDegree), 2));
  PipelineOptions chance, paper;
  chance.explicit_sources = false, paper.method = Method::paper;
  for (const PipelineOptions& options : {PipelineOptions{}, chance, paper}) {
    const Rendered run = render(scene, ring, look(1 << 13), options);
    EXPECT_NEAR(run.result.radiance[0], expected, 4 * run.result.standard_error[0]);
    EXPECT_LT(run.result.standard_error[0], 0.01 * expected);
    EXPECT_EQ(run.result.radiance[1], 0);
  }
}

TEST(NewLight, ShinesBesideOthers) {
  const auto scene = scene_of({quad(50, 0, 0)}, {material("floor", lambert(0.5))});
  const Rendered run = render(scene,
                              read("ring: {direction: [0, 0, 1], inner_deg: 0, outer_deg: 90, radiance: 4}\n"
                                   "sun: {direction: {zenith_deg: 60, azimuth_deg: 0}, irradiance: 7}\n"
                                   "sky: {radiance: 2}"),
                              look(1 << 13));
  EXPECT_NEAR(run.result.radiance[0], 0.5 * (4 + 2 + 3.5 / kPi), 4 * run.result.standard_error[0]);
  EXPECT_NEAR(run.result.radiance[1], 4 + 2, 1e-5);
}

TEST(NewLight, IsAmongTheFeatures) {
  const auto scene = scene_of({quad(1, 0, 0)}, {material("grey", lambert(0.5))});
  const SourceSpecs ring = read(ring_row().example);
  const auto uses = [&](const SourceSpecs& sources) { return text_of(features_of(*scene, sources, {})); };
  EXPECT_THAT(uses(ring), testing::HasSubstr("ring                 used      given by the simulation"));
  EXPECT_THAT(uses({}), testing::HasSubstr("ring                 left out  not in the simulation"));
  EXPECT_THAT(explain_use("ring").value_or(""), testing::HasSubstr("A sample of the ring"));
  EXPECT_THAT(light_rows().list(), testing::HasSubstr("a far ring of even radiance [W/(m2 sr um)]"));
}

TEST(NewLight, IsReadLikeOthers) {
  EXPECT_THAT(message_of([] { read("ring: {direction: [0, 0, 1], inner_deg: 3, outer_deg: 2, radiance: 1}"); }),
              testing::HasSubstr("x.yaml:1:"));
  EXPECT_THAT(message_of([] { read("ring: {direction: [0, 0, 1], inner_deg: 3, outer_deg: 9, radiance: -1}"); }),
              testing::HasSubstr("the radiance is negative"));
  EXPECT_THAT(message_of([] { light_rows().add(ring_row()); }), testing::HasSubstr("already"));
}

TEST(NewLight, ItsSpectrumChoosesBinsAndTellsDarkBands) {
  const auto scene = scene_of({quad(1, 0, 0)}, {material("grey", lambert(0.5))});
  const auto lit_between = [](double low, double high) {
    return read(
        strf("ring: {direction: [0, 0, 1], inner_deg: 3, outer_deg: 9, radiance: {wavelength_um: [%g, %g], "
             "value: [1, 1], outside: zero}}",
             low, high));
  };
  std::vector<std::unique_ptr<Sensor>> sensors;
  sensors.push_back(look(4));
  EXPECT_TRUE(diagnose_lights(lit_between(0.4, 0.7), *scene, sensors).empty());
  const std::vector<SensorDiagnostic> dark = diagnose_lights(lit_between(0.6, 0.7), *scene, sensors);
  ASSERT_EQ(dark.size(), 1u);
  EXPECT_THAT(dark[0].diagnostic().text, testing::HasSubstr("no source sends light in band"));
  std::vector<LightSpectra> sent;
  const SourceSpecs ring = lit_between(0.4, 0.7);
  ring.lights[0]->add_spectra(sent);
  ASSERT_EQ(sent.size(), 1u);
  EXPECT_EQ(sent[0].names, std::vector<std::string>{"the ring"});
}

}  // namespace
}  // namespace suite::test::new_light_test
