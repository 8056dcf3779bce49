// Frames of less than an electron a pixel: what planning by the detector's noise saves and does not change, lamps that
// flicker in a rolling shutter, frames without light. Seeds are fixed; chance is judged at p = 1e-3.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "math/stats.h"
#include "support/lamps_kit.h"
#include "support/message_of.h"
#include "support/platform_kit.h"

namespace suite::low_light_test {
namespace {

using test::PlatformKit;
using testing::HasSubstr;

// A floor beside a wall under an even sky: half of the light of every pixel is found by chance.
std::shared_ptr<Scene> corner(double reflectance = 0.2) {
  return test::scene_of({test::quad(40, 0, 0), test::box({-20, 1, 0}, {20, 2, 30}, 0, true)},
                        {test::material("grey", test::lambert(reflectance))});
}
SourceSpecs sky(double radiance) {
  SourceSpecs s;
  s.add(test::uniform_sky(radiance, false));
  return s;
}
std::string camera(const std::string& paths, const std::string& detector,
                   const std::string& array = "columns: 48, rows: 32") {
  return "kind: platform\nmotion: {kind: static, position_m: [0, 0, 10]}\ntasks: [{start: 0}]\ntruth: "
         "[]\ninstruments:\n"
         "  - focal_length_mm: 50\n    f_number: 1.4\n    arrays:\n      - {pitch_um: 10, integration_time_s: "
         "0.0333, " +
         array + ", paths: " + paths +
         ", bands: [{name: pan, center_um: 0.7, fwhm_um: 0.4, shape: rectangular}], detector: {quantum_efficiency: "
         "0.6, " +
         detector + "}}\n";
}
double sum_of_paths(const test::Shot& shot) {
  double sum = 0;
  for (const uint32_t n : shot.result.paths) sum += n;
  return sum;
}
// Largest difference of two distribution functions over its deviation (Kolmogorov and Smirnov); 1.95 = p of 1e-3.
double smirnov(std::vector<double> a, std::vector<double> b) {
  std::sort(a.begin(), a.end()), std::sort(b.begin(), b.end());
  double most = 0;
  for (const double x : a) {
    const auto below = [x](const std::vector<double>& v) {
      return static_cast<double>(std::upper_bound(v.begin(), v.end(), x) - v.begin()) / static_cast<double>(v.size());
    };
    most = std::max(most, std::fabs(below(a) - below(b)));
  }
  return most * std::sqrt(static_cast<double>(a.size()) / 2);
}

TEST(LowLight, PlannedByTheDetectorsNoiseAStarlitFrameCostsATwentieth) {
  const std::string emccd = "kind: emccd, em_gain: 300, read_noise_e: 50, gain_e_per_dn: 10, seed: ";
  const double night = 5.2e-6;  // W/(m2 sr um)
  PlatformKit kit;
  const JobReport report =
      kit.render(corner(), sky(night), camera("{min: 16, max: 65536, detector_noise: 0.3}", emccd + "1"));
  kit.render(corner(), sky(night), camera("{min: 16, max: 65536, relative_error: 0.01}", emccd + "2"));
  kit.render(corner(), sky(1.3 * night), camera("16", emccd + "3"));
  const test::Shot &noise = kit.shots.at(0), &target = kit.shots.at(1);
  double signal = 0;
  for (const double n : noise.products[0].values) signal += n / static_cast<double>(noise.products[0].values.size());
  const double saved = sum_of_paths(target) / sum_of_paths(noise);
  std::printf("%.3f electrons a pixel, %.1f paths a pixel by noise, %.1f times as many at 1 %%\n", signal,
              sum_of_paths(noise) / 1536, saved);
  EXPECT_NEAR(signal, 0.6, 0.1);
  EXPECT_GT(saved, 20);
  EXPECT_THAT(report.stopped_by, HasSubstr("30 % of the detectors' noise"));
  EXPECT_THAT(report.stopped_by, HasSubstr("times as many"));
  EXPECT_LT(smirnov(noise.products[1].values, target.products[1].values), 1.95);
  EXPECT_GT(smirnov(kit.shots.at(2).products[1].values, target.products[1].values), 1.95) << "negative control";
}

// The errors that are left are below the share that was asked for, whatever the light.
TEST(LowLight, ErrorsAreBelowTheShareOfTheNoise) {
  // The chip of a gain of 4 has four times the electrons.
  const std::string plain = "columns: 16, rows: 12",
                    amplified = "rows: 12, chips: [{columns: 16, offset_mm: [0, 0], gain: 4}]";
  for (const auto& [radiance, array] : {std::pair{2e-6, plain}, {2e-4, plain}, {2e-3, plain}, {5e-5, amplified}}) {
    PlatformKit kit;
    const double share = 0.1;
    const JobReport report =
        kit.render(corner(), sky(radiance),
                   camera("{min: 16, max: 1048576, detector_noise: 0.1}", "gain_e_per_dn: 1, read_noise_e: 1", array));
    const test::Shot& s = kit.shots.at(0);
    double square = 0;
    for (size_t i = 0; i < s.result.problems(); ++i) {
      const double n = s.products[0].values[i], error = s.result.standard_error[i] / s.result.radiance[i] * n;
      square += error * error / (n + 1 + 1.0 / 12) / 192;
    }
    EXPECT_LT(std::sqrt(square), 1.3 * share) << radiance << " " << array;
    EXPECT_GT(report.share_at_target, 0.5) << radiance;
  }
}

TEST(LowLight, ABudgetWithATargetReplacesTheNoise) {
  std::vector<std::unique_ptr<Sensor>> sensors;
  PlatformKit kit;
  sensors.push_back(kit.make(camera("{min: 16, max: 65536, detector_noise: 0.3}", "gain_e_per_dn: 1")));
  JobOptions job;
  job.progress = false;
  job.budget.relative_error = 0.05;
  const JobReport report = run_job(corner(), sky(1e-6), sensors, job);
  EXPECT_THAT(report.stopped_by, testing::Not(HasSubstr("noise")));
  EXPECT_LT(report.median_relative_error, 0.06);
}

// Frames without light: no error is claimed that is not there, the pilot is all that is run, counts are dark ones.
TEST(LowLight, AFrameWithoutLight) {
  PlatformKit kit;
  kit.render(corner(0), sky(1e-6),
             camera("{min: 16, max: 65536, detector_noise: 0.3}",
                    "kind: scmos, gain_e_per_dn: 0.1, read_noise_e: 1.5, dark_current_e_s: 30"));
  const test::Shot& s = kit.shots.at(0);
  RunningStats dark;
  for (const double c : s.products[1].values) dark.add((c - 100) * 0.1);
  EXPECT_EQ(sum_of_paths(s), 16 * 1536);
  for (size_t i = 0; i < 1536; ++i) {
    EXPECT_EQ(s.products[0].values[i], 0);
    EXPECT_EQ(s.result.standard_error[i], 0);
  }
  const double variance = 0.999 + 2.25 + 0.01 / 12;
  EXPECT_NEAR(dark.mean(), 0.999, 4.5 * std::sqrt(variance / 1536));
  EXPECT_NEAR(dark.variance() / variance, 1, 4.5 * std::sqrt(2.4 / 1536));
}

// A lamp on 50 Hz mains is dim and bright 100 times a second: rows of a rolling shutter see its phases as bands, whole
// periods of exposure do not.
TEST(LowLight, LampsFlickerInARollingShutter) {
  LampSpec lamp = test::point_lamp({{0, 0, 9}}, 100);
  auto flicker = std::make_shared<LampSchedule>();
  flicker->when.times = {0, 0.005};
  flicker->when.period = 0.01;
  flicker->scale = {1, 0.25};
  lamp.schedule = flicker;
  SourceSpecs lit;
  lit.add(std::move(lamp));
  const auto rows = [&](const std::string& array) {
    PlatformKit kit;
    std::string text = camera("2048", "gain_e_per_dn: 1.0e+6", array);
    text.replace(text.find("0.0333"), 6, array.find("whole") == std::string::npos ? "0.0001" : "0.02");
    if (const size_t at = text.find(", name: whole"); at != std::string::npos) text.erase(at, 13);
    kit.render(test::scene_of({test::quad(40, 0, 0)}, {test::material("grey", test::lambert(0.5))}), lit, text);
    std::vector<double> of;
    for (size_t r = 0; r < 100; ++r) of.push_back(kit.shots.at(0).products[0].values[r]);
    return of;
  };
  const std::vector<double> rolling = rows("columns: 1, rows: 100, readout: {kind: rolling, row_time_s: 0.0002}");
  for (size_t r = 0; r < 100; ++r) EXPECT_NEAR(rolling[r] / rolling[0], r % 50 < 25 ? 1 : 0.25, 0.02) << r;
  const std::vector<double> whole =
      rows("columns: 1, rows: 100, readout: {kind: rolling, row_time_s: 0.0002}, name: whole");
  for (size_t r = 0; r < 100; ++r) EXPECT_NEAR(whole[r] / (200 * 0.625 * rolling[0]), 1, 0.03) << r;
}

TEST(LowLight, MessagesOfArrays) {
  const auto told = [](const std::string& paths, const std::string& detector,
                       const std::string& array = "columns: 4, rows: 4") {
    return message_of([&] { PlatformKit().make(camera(paths, detector, array)); });
  };
  const std::string tube = "kind: intensifier, gain_e: 100, gain_e_per_dn: 1";
  EXPECT_THAT(told("16", tube, "columns: 4, readout: {kind: line, line_rate_hz: 10}"), HasSubstr("whole frames"));
  EXPECT_THAT(told("16", tube, "rows: 4, chips: [{columns: 2, offset_mm: [-1, 0]}, {columns: 2, offset_mm: [1, 0]}]"),
              HasSubstr("whole frames"));
  EXPECT_EQ(told("16", tube), "no error");
  EXPECT_THAT(told("16", tube + ", phosphor: {blur_um: 101}"), HasSubstr("spots of 10.1 pixels"));
  EXPECT_THAT(told("{detector_noise: 0.3, relative_error: 0.01}", "gain_e_per_dn: 1"),
              HasSubstr("beside the detector's noise"));
  EXPECT_THAT(told("{detector_noise: 0.3}", "fill_factor: 1"), HasSubstr("no detector whose noise"));
  EXPECT_THAT(told("{detector_noise: 0}", "gain_e_per_dn: 1"), HasSubstr("sensor.yaml:9:97"));
  EXPECT_THAT(told("{detector_noise: 0.3}", "gain_e_per_dn: 1", "columns: 4, rows: 4, time_bins: 2"),
              HasSubstr("time_bins"));
  EXPECT_THAT(told("{detector_noise: 0.3}", "gain_e_per_dn: 1",
                   "rows: 4, chips: [{columns: 2, offset_mm: [-1, 0]}, {columns: 2, offset_mm: [1, 0], paths: 8}]"),
              HasSubstr("of its own"));
}

}  // namespace
}  // namespace suite::low_light_test
