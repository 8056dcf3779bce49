// Bad platform files: each is refused before anything is rendered, with one located sentence.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/message_of.h"
#include "support/platform_kit.h"
#include "support/platform_text.h"

namespace suite::input_test {
namespace {

using testing::AllOf;
using testing::HasSubstr;

const std::string& kGood = test::kGoodPlatform;

// The good text with one piece replaced.
std::string message(const std::string& what, const std::string& by) {
  std::string text = kGood;
  const size_t at = text.find(what);
  EXPECT_NE(at, std::string::npos) << what;
  text.replace(at, what.size(), by);
  test::PlatformKit kit;
  return message_of([&] { kit.make(text); });
}

TEST(PlatformText, TheGoodOneIsTaken) {
  test::PlatformKit kit;
  EXPECT_EQ(message_of([&] { kit.make(kGood); }), "no error");
}

TEST(PlatformText, MisspeltKeysHaveTheirPlaceAndTheNearestName) {
  EXPECT_THAT(message("focal_length_mm", "focal_lenght_mm"),
              AllOf(HasSubstr("sensor.yaml:"), HasSubstr("focal_length_mm")));
  for (const auto& [good, bad] : {std::pair{"amplitude_deg", "amplitude_degs"},
                                  {"rate_hz: 2", "rate_hz: 2, ofset_s: 0"},
                                  {"row_time_s", "row_times_s"},
                                  {"sigma_um", "sigma_mu"},
                                  {"quantum_efficiency: 0.5", "quantum_efficiency: 0.5, read_nois_e: 4"},
                                  {"distortion: {k1", "distortion: {k4"},
                                  {"attachments", "atachments"}})
    EXPECT_THAT(message(good, bad), AllOf(HasSubstr("sensor.yaml:"), HasSubstr("error:"))) << bad;
  EXPECT_THAT(message("rate_hz: 2", "rate_hz: 2, ofset_s: 0"), HasSubstr("did you mean 'offset_s'?"));
  EXPECT_THAT(message("kind: rolling", "kind: roling"), HasSubstr("rolling"));
  EXPECT_THAT(message("kind: whisk", "kind: wisk"), HasSubstr("whisk"));
  EXPECT_THAT(message("kind: straight", "kind: strait"), HasSubstr("straight"));
}

TEST(PlatformText, ASpectralErrorIsAFractionOrNone) {
  const auto with = [](const std::string& value) {
    return message("columns: 10", "spectral_error: " + value + "\n            columns: 10");
  };
  EXPECT_EQ(with("0.01"), "no error");
  EXPECT_EQ(with("0"), "no error");
  EXPECT_THAT(with("-0.1"), AllOf(HasSubstr("sensor.yaml:19:"), HasSubstr("spectral_error")));
  EXPECT_THAT(with("1e-9"), AllOf(HasSubstr("sensor.yaml:19:"), HasSubstr("at least 1e-05, or 0 for even bins")));
}

TEST(PlatformText, ImpossibleGeometryIsRefused) {
  EXPECT_THAT(message("focal_length_mm: 50", "focal_length_mm: 0"),
              AllOf(HasSubstr("sensor.yaml:12:"), HasSubstr("mm")));
  EXPECT_THAT(message("pitch_um: 5", "pitch_um: -5"),
              AllOf(HasSubstr("sensor.yaml:21:"), HasSubstr("pitch of a detector")));
  EXPECT_THAT(message("k1: -0.01", "k1: -500000"), HasSubstr("folds over"));
  EXPECT_THAT(message("columns: 10", "columns: 0"), HasSubstr("sensor.yaml:19:"));
  EXPECT_THAT(message("        f_number: 4\n", ""), HasSubstr("aperture_mm or f_number"));
  EXPECT_THAT(message("integration_time_s: 0.01", "integration_time_s: 0"), HasSubstr("integration time"));
  EXPECT_THAT(message("quantum_efficiency: 0.5", "quantum_efficiency: 1.5"), HasSubstr("leaves 0..1"));
  EXPECT_THAT(message("rate_hz: 2", "rate_hz: 1.0e9"), HasSubstr("frames in one task"));
  EXPECT_THAT(message("f_number: 4", "f_number: 4\n        aperture_mm: 3"), HasSubstr("given twice"));
}

TEST(PlatformText, MotionMustCoverTheTasks) {
  const std::string motion = "{kind: straight, position_m: [0, 0, 100], heading_deg: 0, speed_m_s: 10}";
  EXPECT_THAT(
      message(
          motion,
          "{kind: keyframes, keys: [{time_s: 0, position_m: [0, 0, 100]}, {time_s: 0.9, position_m: [0, 9, 100]}]}"),
      AllOf(HasSubstr("sensor.yaml:5:"),
            HasSubstr("the vehicle's motion from 0 to 1.017 s, and knows it from 0 to 0.9 s")));
  EXPECT_THAT(message("mount: {kind: whisk, axis: across, amplitude_deg: 5, rate_hz: 1}",
                      "mount: {kind: tabulated, times_s: [0, 0.5], rotate_deg: [[0, 0, 0], [1, 0, 0]]}"),
              HasSubstr("a mount's motion"));
  EXPECT_THAT(message("mount: {kind: whisk, axis: across, amplitude_deg: 5, rate_hz: 1}",
                      "mount: {kind: look_at, target: {position_m: [0, 0, 100]}}"),
              HasSubstr("no pose at 0 s: a mount's target is in the mount's own place"));
  EXPECT_THAT(message("start: 0, stop: 1", "start: 1, stop: 0"), HasSubstr("stops before it starts"));
}

TEST(PlatformText, ADecayedOrbitIsRefusedByName) {
  // A low, draggy orbit, asked a year after its epoch.
  const Params params = Params::parse_text(
      "kind: platform\nmotion: orbit\ntasks: [{start: 0}]\ninstruments: [{focal_length_mm: 50, arrays: [{columns: 1, "
      "rows: 1, pitch_um: 5, bands: [{name: a, center_um: 0.6, fwhm_um: 0.1}]}]}]\n",
      "sensor.yaml");
  OrbitElements elements;
  elements.satellite = "88888";
  elements.epoch = {2025, 6, 21, 0, 0, 0};
  elements.inclination = 1.2, elements.eccentricity = 0.008, elements.mean_motion = 16.2 * 2 * kPi / 1440,
  elements.drag = 1e-3;
  SensorContext context;
  context.curve = [](const Params& p) { return Curve::constant(p.as_number()); };
  context.track = [&](const Params&) {
    return orbit_track(std::make_shared<Sgp4>(elements), SceneFrame({49, 8, 0}), Clock({2026, 6, 21, 10, 30, 0}), 0);
  };
  context.jitter = [](const Params&, uint64_t) -> Jitter { throw Bug("not asked"); };
  context.time = [](const Params& p) { return p.as_number(); };
  EXPECT_THAT(message_of([&] { make_sensor(params, context); }),
              AllOf(HasSubstr("sensor.yaml:3:"), HasSubstr("88888")));
}

}  // namespace
}  // namespace suite::input_test
