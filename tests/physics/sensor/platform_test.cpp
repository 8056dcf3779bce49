// Timing and geometry of the platform's instruments against closed forms, ray by ray over a level ground.
#include <gtest/gtest.h>

#include <cmath>

#include "math/stats.h"
#include "sensor/lens.h"
#include "support/message_of.h"
#include "support/platform_kit.h"

namespace suite::platform_test {
namespace {

using test::on_ground;
using test::PlatformKit;
using test::ray_of;

constexpr const char* kPan = "bands: [{name: pan, center_um: 0.6, fwhm_um: 0.1, shape: rectangular}]";

// A camera of f = 0.1 m at 1000 m over the origin flying north at `speed`: 10 um are 0.1 m on the ground.
std::string flying(double speed, const std::string& instrument, const std::string& extra = "", double stop = 1) {
  return strf(
             "kind: platform\nmotion: {kind: straight, position_m: [0, 0, 1000], heading_deg: 0, speed_m_s: "
             "%g}\ntasks: [{start: 0, stop: %g}]\n",
             speed, stop) +
         extra + "instruments:\n  - name: eye\n    focal_length_mm: 100\n" + instrument;
}

TEST(Platform, FrameLooksWhereThePinholeSaysAndRowsRunAgainstTheFlight) {
  PlatformKit kit;
  const auto sensor =
      kit.make(flying(0, std::string("    arrays: [{columns: 101, rows: 51, pitch_um: 10, ") + kPan + "}]\n", "", 0));
  const Capture& c = sensor->tasks()[0].captures[0];
  for (const auto& [column, row] : {std::pair{0u, 0u}, std::pair{50u, 25u}, std::pair{100u, 50u}, std::pair{7u, 33u}}) {
    const Vec3 p = on_ground(ray_of(*sensor, c, row * 101 + column).ray);
    EXPECT_NEAR(p.x, (column - 50.0) * 0.1, 1e-9);
    EXPECT_NEAR(p.y, (25.0 - row) * 0.1, 1e-9);
  }
}

TEST(Platform, PushBroomSamplesTheGroundByItsLineRate) {
  // 50 m/s at 500 lines/s: a line every 0.1 m, each smeared over 50 m/s x 1 ms = 0.05 m.
  PlatformKit kit;
  const auto sensor =
      kit.make(flying(50, std::string("    arrays: [{columns: 10, pitch_um: 10, integration_time_s: 0.001, readout: "
                                      "{kind: line, line_rate_hz: 500, lines_per_capture: 32}, ") +
                              kPan + "}]\n"));
  ASSERT_EQ(sensor->tasks()[0].captures.size(), 16u);  // 500 lines
  uint32_t line = 0;
  for (const Capture& c : sensor->tasks()[0].captures)
    for (uint32_t r = 0; r < c.rows; ++r, ++line)
      for (const double u : {0.0, 0.5, 0.999}) {
        const SensorRay ray = ray_of(*sensor, c, r * 10 + 4, {0.5, 0.5, u});
        EXPECT_NEAR(ray.ray.time, line / 500.0 + u * 0.001, 1e-12);
        EXPECT_NEAR(on_ground(ray.ray).y, 0.1 * line + 0.05 * u, 1e-8);
        EXPECT_GE(ray.ray.time, c.window.begin);
        EXPECT_LE(ray.ray.time, c.window.end);
      }
  EXPECT_EQ(line, 500u);
}

TEST(Platform, RollingShutterSkewsByTheTimeBetweenRows) {
  // Across the flight nothing; along it each row is seen 1 ms later, 50 mm further on.
  PlatformKit kit;
  const auto sensor = kit.make(flying(50,
                                      std::string("    rotate_deg: [0, 0, 90]\n    arrays: [{columns: 11, rows: 101, "
                                                  "pitch_um: 10, readout: {kind: rolling, row_time_s: 0.001}, ") +
                                          kPan + "}]\n",
                                      "", 0));
  const Capture& c = sensor->tasks()[0].captures[0];
  EXPECT_NEAR(c.window.end - c.window.begin, 0.1, 1e-12);
  const Vec3 first = on_ground(ray_of(*sensor, c, 5).ray), last = on_ground(ray_of(*sensor, c, 100 * 11 + 5).ray);
  // The camera is turned by 90 degrees: its rows run across the track, so the skew is pure shear.
  EXPECT_NEAR(last.y - first.y, 50 * 0.1, 1e-9);
  EXPECT_NEAR(std::fabs(last.x - first.x), 100 * 0.1, 1e-9);
}

TEST(Platform, TdiStagesStayOnTheSameGround) {
  // Matched line rate: the image moves one pitch per line. All stages see the same 0.1 m; with the wrong direction they
  // are spread over twice their number.
  PlatformKit kit;
  auto text = [&](const char* direction) {
    return flying(50, std::string("    arrays: [{columns: 4, pitch_um: 10, integration_time_s: 0.002, readout: {kind: "
                                  "line, line_rate_hz: 500}, tdi: {stages: 16, direction: ") +
                          direction + "}, " + kPan + "}]\n");
  };
  for (const bool right : {true, false}) {
    const auto sensor = kit.make(text(right ? "down" : "up"));
    const Capture& c = sensor->tasks()[0].captures[0];
    double low = INFINITY, high = -INFINITY;
    for (int i = 0; i < 1600; ++i) {
      const Vec3 p = on_ground(ray_of(*sensor, c, 10 * 4, {0.5, 0.5, (i + 0.5) / 1600}).ray);
      low = std::min(low, p.y), high = std::max(high, p.y);
    }
    // Within one stage the ground still moves by one pitch.
    if (right)
      EXPECT_NEAR(high - low, 0.1, 0.002);
    else
      EXPECT_NEAR(high - low, 0.1 * 31, 0.002);
  }
}

TEST(Platform, StaggeredChipsLookAheadByTheirOffset) {
  PlatformKit kit;
  const auto sensor = kit.make(flying(
      50,
      std::string() +
          "    arrays:\n      - pitch_um: 10\n        integration_time_s: 0\n        readout: {kind: line, "
          "line_rate_hz: 500}\n"
          "        chips: [{columns: 100, offset_mm: [-0.5, 1.5]}, {columns: 100, offset_mm: [0.5, -1.5]}]\n        " +
          kPan + "\n"));
  const Capture& c = sensor->tasks()[0].captures[0];
  EXPECT_EQ(c.columns, 200u);
  // Columns of a strip that is flown forward run from the right to the left.
  const Vec3 left = on_ground(ray_of(*sensor, c, 100).ray), right = on_ground(ray_of(*sensor, c, 99).ray);
  EXPECT_NEAR(right.x - left.x, 0.1, 1e-9);                // the chips meet
  EXPECT_NEAR(left.y - right.y, 3e-3 / 0.1 * 1000, 1e-9);  // 3 mm over f times the height: 30 m
  // The same ground is seen 30 m / 50 m/s = 0.6 s = 300 lines later.
  const Capture& later = sensor->tasks()[0].captures[4];
  const Vec3 again = on_ground(ray_of(*sensor, later, (300 - 256) * 200 + 99).ray);
  EXPECT_NEAR(again.y, left.y, 1e-8);
}

TEST(Platform, WhiskbroomSweepsAcross) {
  PlatformKit kit;
  const auto sensor = kit.make(
      flying(0,
             std::string("    mount: {kind: line_scan, axis: across, start_deg: -10, rate_deg_s: 200, period_s: 0.1}\n"
                         "    arrays: [{rows: 4, pitch_um: 10, readout: {kind: whisk, samples: 101, sample_rate_hz: "
                         "1000.0001, scan_rate_hz: 9.9}, ") +
                 kPan + "}]\n",
             "", 0.2));
  const Capture& c = sensor->tasks()[0].captures[0];
  EXPECT_EQ(c.columns, 101u);
  EXPECT_EQ(c.rows % 4, 0u);
  // Sample k is at -10 + 0.2 k degrees; turning about the forward axis by +angle looks to -x for a view along -z.
  for (const uint32_t k : {0u, 50u, 99u}) {
    const double angle = (-10 + 0.2 * k) * kDegree;
    EXPECT_NEAR(on_ground(ray_of(*sensor, c, k).ray).x, -1000 * std::tan(angle), 1e-2);
  }
}

TEST(Platform, DistortionIsBrownsAndItsInverseCloses) {
  Lens lens;
  lens.focal_length = 0.05;
  lens.distortion = {-0.12, 0.03, -0.004, 1e-3, -7e-4};
  for (double x = -0.5; x <= 0.5; x += 0.1)
    for (double y = -0.4; y <= 0.4; y += 0.1) {
      const double r2 = x * x + y * y, radial = 1 - 0.12 * r2 + 0.03 * r2 * r2 - 0.004 * r2 * r2 * r2;
      const Vec2 d = lens.distortion.distorted({x, y});
      EXPECT_NEAR(d.x, x * radial + 2e-3 * x * y - 7e-4 * (r2 + 2 * x * x), 1e-15);
      EXPECT_NEAR(d.y, y * radial + 1e-3 * (r2 + 2 * y * y) - 1.4e-3 * x * y, 1e-15);
      const Vec2 place{d.x * 0.05, d.y * 0.05};
      const Dir look = lens.look(place);
      EXPECT_NEAR(look.x / -look.z, x, 1e-13);
      EXPECT_NEAR(-look.y / -look.z, y, 1e-13);
      const Vec2 back = lens.image_of(look);
      EXPECT_NEAR(back.x, place.x, 1e-15);
      EXPECT_NEAR(back.y, place.y, 1e-15);
    }
  lens.distortion = {-3, 0, 0, 0, 0};
  EXPECT_FALSE(lens.distortion.ideal({0.5, 0.5}));  // beyond the fold
}

TEST(Platform, GroundToPixelToGroundFrom705Kilometres) {
  // A 705 km orbit's camera, 5 m pixels. A ground point goes through image_of to a pixel and a place in it; the
  // sensor's own ray from there comes back to the point within 1 cm.
  PlatformKit kit;
  kit.frame = SceneFrame({49, 8, 100});
  const std::string text =
      "kind: platform\nmotion: {kind: static, latitude_deg: 49.2, longitude_deg: 8.3, height_m: 705000, pointing: "
      "{look_at: {position_m: [300, -400, 250]}}}\ntasks: [{start: 0}]\n"
      "instruments:\n  - focal_length_mm: 1410\n    distortion: {k1: -0.02, p1: 1e-4}\n    arrays: [{columns: 2000, "
      "rows: 2000, pitch_um: 10, " +
      std::string(kPan) + "}]\n";
  const auto sensor = kit.make(text);
  const Capture& c = sensor->tasks()[0].captures[0];
  Lens lens;
  lens.focal_length = 1.41;
  lens.distortion = {-0.02, 0, 0, 1e-4, 0};
  // The pose, from three rays: where it is and the axes of the camera.
  MotionContext motion;
  motion.frame = kit.frame;
  const TrackPtr track =
      track_from(Params::parse_text("{kind: static, latitude_deg: 49.2, longitude_deg: 8.3, height_m: 705000, "
                                    "pointing: {look_at: {position_m: [300, -400, 250]}}}",
                                    "t"),
                 motion);
  const Pose pose = track->at(0);
  double worst = 0;
  for (const Vec3 ground : {Vec3{300, -400, 250}, Vec3{3300, 2500, 451}, Vec3{-2500, -3200, 78}, Vec3{10, 20, 100}}) {
    const Vec2 place = lens.image_of(normalized(pose.inverse().point(ground)));
    const double column = place.x / 10e-6 + 1000, row = place.y / 10e-6 + 1000;
    ASSERT_TRUE(column > 0 && column < 2000 && row > 0 && row < 2000);
    const size_t problem = static_cast<size_t>(row) * 2000 + static_cast<size_t>(column);
    const Ray ray = ray_of(*sensor, c, problem, {column - std::floor(column), row - std::floor(row)}).ray;
    worst = std::max(worst, length(on_ground(ray, ground.z) - ground));
  }
  std::printf("ground -> pixel -> ground from 705 km: %.3g m\n", worst);
  EXPECT_LT(worst, 0.01);
}

TEST(Platform, ThinLensFocusesAtItsDistance) {
  PlatformKit kit;
  const auto sensor = kit.make(flying(
      0,
      std::string(
          "    aperture_mm: 50\n    focus_distance_m: 1000\n    arrays: [{columns: 11, rows: 11, pitch_um: 10, ") +
          kPan + "}]\n",
      "", 0));
  const Capture& c = sensor->tasks()[0].captures[0];
  const Vec3 at = on_ground(ray_of(*sensor, c, 60, {0.5, 0.5, 0.5, 0.9, 0, 0, 0, 0.1}).ray),
             same = on_ground(ray_of(*sensor, c, 60, {0.5, 0.5, 0.5, 0.9, 0, 0, 0, 0.6}).ray);
  EXPECT_LT(length(at - same), 1e-9);
  const Vec3 half = on_ground(ray_of(*sensor, c, 60, {0.5, 0.5, 0.5, 0.999999, 0, 0, 0, 0.1}).ray, 500),
             other = on_ground(ray_of(*sensor, c, 60, {0.5, 0.5, 0.5, 0.999999, 0, 0, 0, 0.6}).ray, 500);
  EXPECT_NEAR(length(half - other), 0.025, 1e-6);  // half way, the bundle is half the aperture wide
}

TEST(Platform, JitterSplitsIntoBlurAndMotionAsItsSpectrumSays) {
  // Many exposures of 20 ms; the place seen along x is f times the rotation about y. PHYSICS: in-frame variance =
  // integral of S (1 - sinc^2 fT), frame-to-frame = integral of S sinc^2 fT.
  PlatformKit kit;
  const std::string psd =
      "jitter: {seed: 5, components: 1024, rotate_y: {psd: {frequency_hz: [0.5, 10, 200], density_rad2_hz: [1e-9, "
      "1e-9, 1e-13]}}}\n";
  const auto sensor = kit.make(flying(
      0,
      std::string(
          "    clock: {rate_hz: 1}\n    arrays: [{columns: 1, rows: 1, pitch_um: 10, integration_time_s: 0.02, ") +
          kPan + "}]\n",
      psd, 1999));
  const Psd spectrum{{0.5, 10, 200}, {1e-9, 1e-9, 1e-13}};
  RunningStats within, between;
  for (const Capture& c : sensor->tasks()[0].captures) {
    sensor->begin(c);
    RunningStats frame;
    double square = 0;
    for (int i = 0; i < 40; ++i) {
      const double x = on_ground(ray_of(*sensor, c, 0, {0.5, 0.5, (i + 0.5) / 40}).ray).x / 1000;
      frame.add(x);
      square += x * x / 40;
    }
    within.add(square - frame.mean() * frame.mean());
    between.add(frame.mean());
  }
  const double expected_within = in_frame_variance(spectrum, 0.02),
               expected_between = frame_to_frame_variance(spectrum, 0.02);
  const double mean_square = between.variance() + between.mean() * between.mean();
  std::printf("jitter: in-frame %.4g of %.4g rad2, frame-to-frame %.4g of %.4g rad2\n", within.mean(), expected_within,
              mean_square, expected_between);
  EXPECT_NEAR(within.mean() / expected_within, 1, 0.05);
  EXPECT_NEAR(mean_square / expected_between, 1, 0.05);
}

TEST(Platform, GimbalFollowsItsTarget) {
  PlatformKit kit;
  const std::string text =
      "kind: platform\nmotion: {kind: circle, position_m: [0, 0, 100], radius_m: 150, speed_m_s: 15}\ntasks: [{start: "
      "0, stop: 20}]\n"
      "attachments:\n  - name: gimbal\n    offset_m: [0.2, 1, -0.3]\n    mount: {kind: look_at, target: {position_m: "
      "[5, 6, 7]}}\n    instruments:\n"
      "      - {name: eye, focal_length_mm: 100, clock: {rate_hz: 1}, arrays: [{columns: 1, rows: 1, pitch_um: 10, " +
      std::string(kPan) + "}]}\n";
  const auto sensor = kit.make(text);
  EXPECT_EQ(sensor->tasks()[0].captures.size(), 21u);
  for (const Capture& c : sensor->tasks()[0].captures)
    EXPECT_LT(length(on_ground(ray_of(*sensor, c, 0).ray, 7) - Vec3{5, 6, 7}), 1e-9);
}

TEST(Platform, DistanceTriggersAreEquallyFarApart) {
  PlatformKit kit;
  const auto sensor = kit.make(flying(
      12.5,
      std::string("    trigger: {distance_m: 20}\n    arrays: [{columns: 1, rows: 1, pitch_um: 10, ") + kPan + "}]\n",
      "", 10));
  const auto& captures = sensor->tasks()[0].captures;
  ASSERT_EQ(captures.size(), 7u);  // 125 m
  for (size_t i = 0; i < captures.size(); ++i)
    EXPECT_NEAR(captures[i].window.begin, 1.6 * static_cast<double>(i), 1e-9);
}

}  // namespace
}  // namespace suite::platform_test
