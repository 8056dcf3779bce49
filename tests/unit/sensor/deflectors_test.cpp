// Directions of scanners against closed forms.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "sensor/deflectors/deflector.h"
#include "support/message_of.h"

namespace suite::deflectors_test {
namespace {

using testing::HasSubstr;

std::unique_ptr<Deflector> of(const std::string& text) {
  const Params p = Params::parse_text(text, "s.yaml");
  auto made = make_deflector(p);
  p.reject_unread();
  return made;
}
double across_deg(const Deflector& d, double t) {
  const auto dir = d.direction(t);
  return dir ? std::atan2(dir->x, -dir->z) / kDegree : std::nan("");
}

TEST(Deflectors, GalvoAndTriangle) {
  const auto galvo = of("{kind: galvo, half_angle_deg: 30, rate_hz: 50}"),
             triangle = of("{kind: triangle, half_angle_deg: 30, rate_hz: 50, turn_share: 0.2}");
  int galvo_lines = 0, triangle_lines = 0;
  double fastest = 0, last = 0;
  for (int k = 0; k <= 100000; ++k) {  // a second
    const double t = (k + 0.5) * 1e-5, a = across_deg(*galvo, t), b = across_deg(*triangle, t);
    EXPECT_NEAR(a, 30 * std::sin(2 * kPi * 50 * t), 1e-9);
    EXPECT_LE(std::fabs(b), 30 + 1e-9);
    if (k) {
      galvo_lines += across_deg(*galvo, t - 1e-5) * a < 0;
      triangle_lines += last * b < 0;
      fastest = std::max(fastest, std::fabs(b - last) / 1e-5);
    }
    last = b;
  }
  EXPECT_EQ(galvo_lines, 100);  // 2 f lines a second
  EXPECT_EQ(triangle_lines, 100);
  // Speed of the even part: the half angle in a quarter of a period, 1 / (1 - turn / 2) as fast.
  EXPECT_NEAR(fastest, 30 * 4 * 50 / 0.9, 1e-3);
  EXPECT_NEAR(across_deg(*triangle, 0.005), 30, 1e-9);
  EXPECT_NEAR(across_deg(*triangle, 0.015), -30, 1e-9);
  // Without turns it is a triangle.
  EXPECT_NEAR(across_deg(*of("{kind: triangle, half_angle_deg: 30, rate_hz: 50, turn_share: 0}"), 0.0025), 15, 1e-9);
}

TEST(Deflectors, Polygon) {
  const auto polygon = of("{kind: polygon, facets: 6, rotation_hz: 20, duty: 0.5}");
  double low = 1e9, high = -1e9;
  int starts = 0, dark = 0;
  bool lit = false;
  double last = 0;
  for (int k = 0; k < 120000; ++k) {
    const double t = (k + 0.5) / 120000, a = across_deg(*polygon, t);
    if (std::isnan(a)) {
      ++dark, lit = false;
      continue;
    }
    starts += !lit;
    if (lit) {
      EXPECT_GT(a, last);  // always one way
    }
    lit = true, last = a, low = std::min(low, a), high = std::max(high, a);
  }
  EXPECT_EQ(starts, 120);                       // facets x turns
  EXPECT_NEAR(high - low, 2 * 60 * 0.5, 0.15);  // 2 (360 / m) duty
  EXPECT_NEAR(dark / 120000.0, 0.5, 0.01);
}

// Normal incidence: a cone of half-angle 2 alpha. Slanted: with the normal tilted across, x = sin(2 alpha)
// cos(incidence); tilted along the flight, 2 alpha: an oval, somewhat egg-shaped.
TEST(Deflectors, Palmer) {
  const double alpha = 5 * kDegree;
  const auto cone = of("{kind: palmer, mirror_tilt_deg: 5, rotation_hz: 30}"),
             oval = of("{kind: palmer, mirror_tilt_deg: 5, rotation_hz: 30, incidence_deg: 45}");
  double farthest = 0;
  for (int k = 0; k < 3600; ++k) {
    const double t = k / (30.0 * 3600);
    EXPECT_NEAR(angle_between(*cone->direction(t), {0, 0, -1}), 2 * alpha, 1e-12);
    const Dir d = *oval->direction(t);
    farthest = std::max(farthest, std::atan2(std::fabs(d.y), -d.z));
  }
  EXPECT_NEAR(oval->direction(0)->x, std::sin(2 * alpha) * std::cos(kPi / 4), 1e-12);
  EXPECT_NEAR(farthest, 2 * alpha, 1e-6);
}

// One prism turns the axis by asin(n sin a) - a; thin ones add as vectors of (n - 1) a.
TEST(Deflectors, Risley) {
  const auto one = of("{kind: risley, prisms: [{wedge_deg: 10, index: 1.5, rotation_hz: 7}]}");
  const double a = 10 * kDegree;
  for (const double t : {0.0, 0.013, 0.4}) {
    const Dir d = *one->direction(t);
    EXPECT_NEAR(angle_between(d, {0, 0, -1}), std::asin(1.5 * std::sin(a)) - a, 1e-12);
    const double turn = std::remainder(std::atan2(d.y, d.x) - 2 * kPi * 7 * t, 2 * kPi);
    EXPECT_NEAR(turn, 0, 1e-9);
  }
  const auto thin =
      of("{kind: risley, prisms: [{wedge_deg: 0.1, index: 1.5, rotation_hz: 7}, {wedge_deg: 0.1, index: 1.6, "
         "rotation_hz: -11, phase_deg: 40}]}");
  const double w = 0.1 * kDegree;
  for (const double t : {0.0, 0.02, 0.3, 1.7}) {
    const double p = 2 * kPi * 7 * t, q = -2 * kPi * 11 * t + 40 * kDegree;
    const Dir d = *thin->direction(t);
    EXPECT_NEAR(d.x, w * (0.5 * std::cos(p) + 0.6 * std::cos(q)), 2e-8);
    EXPECT_NEAR(d.y, w * (0.5 * std::sin(p) + 0.6 * std::sin(q)), 2e-8);
  }
  // Two alike that turn against each other draw a line.
  const auto line =
      of("{kind: risley, prisms: [{wedge_deg: 2, index: 1.5, rotation_hz: 10}, {wedge_deg: 2, index: 1.5, rotation_hz: "
         "-10}]}");
  for (int k = 0; k < 50; ++k) EXPECT_NEAR(line->direction(k * 0.0037)->y, 0, 2e-5);
  // The Mid-70 by its published numbers: two wedges of index 1.5095 at -77.733 and 121.567 Hz.
  const auto mid =
      of("{kind: risley, prisms: [{wedge_deg: 18, index: 1.5095, rotation_hz: -77.733}, {wedge_deg: 18, index: 1.5095, "
         "rotation_hz: 121.567}]}");
  for (int k = 0; k < 1000; ++k) EXPECT_NEAR(length(*mid->direction(k * 1e-5)), 1, 1e-12);
}

TEST(Deflectors, Channels) {
  const auto fibre = of("{kind: fibre, fibres: 5, spacing_deg: 2, rate_hz: 1000}");
  for (int k = 0; k < 12; ++k) EXPECT_NEAR(across_deg(*fibre, k * 1e-3), (k % 5 - 2) * 2.0, 1e-9);
  const auto lasers = of("{kind: line_array, lasers: 4, spacing_deg: 1, interval_ns: 500}");
  EXPECT_EQ(lasers->channels(), size_t{4});
  EXPECT_NEAR(std::asin(lasers->direction(0, 3)->x) / kDegree, 1.5, 1e-12);
  EXPECT_NEAR(lasers->delay(3), 1.5e-6, 1e-18);
  const auto flash = of("{kind: flash, columns: 3, rows: 2, pitch_um: 50, focal_length_mm: 100}");
  EXPECT_EQ(flash->channels(), size_t{6});
  const Dir corner = *flash->direction(0, 5);  // last column of the lower row
  EXPECT_NEAR(corner.x / -corner.z, 5e-4, 1e-15);
  EXPECT_NEAR(corner.y / -corner.z, -2.5e-4, 1e-15);
  const auto head =
      of("{kind: rotating_head, rotation_hz: 10, elevations_deg: [-15, 1], firing_us: [0, 2.3], azimuths_deg: [0, 4]}");
  EXPECT_NEAR(std::asin(head->direction(0.2, 0)->z) / kDegree, -15, 1e-9);
  EXPECT_NEAR(head->direction(0.025, 0)->x, std::cos(15 * kDegree), 1e-12);  // a quarter: to the right
  EXPECT_NEAR(std::atan2(head->direction(0, 1)->x, head->direction(0, 1)->y) / kDegree, 4, 1e-9);
  EXPECT_NEAR(head->delay(1), 2.3e-6, 1e-18);
}

TEST(Deflectors, EveryRowGivesUnitVectorsAndFaultsAreLocated) {
  EXPECT_EQ(*of("{kind: fixed}")->direction(3), (Dir{0, 0, -1}));
  const auto message = [](const std::string& text) { return message_of([&] { of(text); }); };
  EXPECT_THAT(message("{kind: poligon}"),
              HasSubstr("s.yaml:1:8: error: unknown kind of deflector 'poligon'; did you mean 'polygon'?"));
  EXPECT_THAT(message("{kind: galvo, half_angle_deg: 100, rate_hz: 1}"), HasSubstr("s.yaml:1:"));
  EXPECT_THAT(message("{kind: risley, prisms: [{wedge_deg: 50, index: 1.5, rotation_hz: 1}]}"),
              HasSubstr("reflects the beam totally"));
  EXPECT_THAT(message("{kind: rotating_head, rotation_hz: 1, elevations_deg: [1, 2], firing_us: [1]}"),
              HasSubstr("1 values for 2 elevations"));
  EXPECT_THAT(message("{kind: flash, columns: 65536, rows: 65536, pitch_um: 5, focal_length_mm: 10}"),
              HasSubstr("at most 16777216"));
  EXPECT_FALSE(refract({0, std::sin(1.0), -std::cos(1.0)}, {0, 0, 1}, 1.5));  // totally reflected
}

// One way from -20 to 20 degrees 10 times a second, lit from -5 to 15; a triangle that starts at its end.
TEST(Deflectors, SweepAndPhase) {
  const auto sweep = of("{kind: sweep, half_angle_deg: 20, rate_hz: 10, from_deg: -5, to_deg: 15}");
  for (int k = 0; k < 1000; ++k) {
    const double t = (k + 0.37) * 1e-3, x = 10 * t + 0.5, angle = -20 + 40 * (x - std::floor(x));
    if (angle < -5 || angle > 15)
      EXPECT_FALSE(sweep->direction(t)) << t;
    else
      EXPECT_NEAR(across_deg(*sweep, t), angle, 1e-9) << t;
  }
  EXPECT_NEAR(across_deg(*of("{kind: sweep, half_angle_deg: 20, rate_hz: 10, start_deg: -20}"), 0), -20, 1e-9);
  EXPECT_NEAR(across_deg(*of("{kind: triangle, half_angle_deg: 20, rate_hz: 10, turn_share: 0, phase_deg: -90}"), 0),
              -20, 1e-9);
  EXPECT_THAT(message_of([&] { of("{kind: sweep, half_angle_deg: 20, rate_hz: 10, start_deg: 30}"); }),
              HasSubstr("does not reach its start"));
  EXPECT_THAT(message_of([&] { of("{kind: sweep, half_angle_deg: 20, rate_hz: 10, from_deg: 3, to_deg: 2}"); }),
              HasSubstr("no beam leaves"));
}

// A prism turned round bends the beam by the same least angle; a beam along a face's normal only at the other one.
TEST(Deflectors, PrismsEitherWay) {
  const double w = 10 * kDegree, n = 1.5;
  const auto second = of("{kind: risley, prisms: [{wedge_deg: 10, index: 1.5, rotation_hz: 0}]}");
  EXPECT_NEAR(std::acos(-second->direction(0)->z), std::asin(n * std::sin(w)) - w, 1e-12);
  const auto first = of("{kind: risley, prisms: [{wedge_deg: 10, index: 1.5, rotation_hz: 0, tilted: first}]}");
  EXPECT_NEAR(std::acos(-first->direction(0)->z), std::asin(n * std::sin(w - std::asin(std::sin(w) / n))), 1e-12);
  EXPECT_GT(first->direction(0)->x, 0);  // to the thick side, too
  const auto plate = of("{kind: risley, incident: [0.1, 0, -1], prisms: [{wedge_deg: 0, index: 1.5, rotation_hz: 0}]}");
  EXPECT_NEAR(plate->direction(0)->x, 0.1 / std::sqrt(1.01), 1e-12);
  EXPECT_THAT(message_of([&] {
                of("{kind: risley, incident: [0, 0, 1], prisms: [{wedge_deg: 1, index: 1.5, rotation_hz: 0}]}");
              }),
              HasSubstr("does not go into the prisms"));
}

}  // namespace
}  // namespace suite::deflectors_test
