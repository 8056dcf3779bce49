// Tracks: frames, screw motion, closed forms, pointing, and the number of linear steps.
#include "motion/track.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/error.h"
#include "formats/tle/tle.h"
#include "math/sampling.h"

namespace suite::track_test {
namespace {

Quat random_rotation(Pcg32& rng) {
  Quat q{rng.uniform() - 0.5, rng.uniform() - 0.5, rng.uniform() - 0.5, rng.uniform() - 0.5};
  return normalized(q);
}
Vec3 random_place(Pcg32& rng, double size) {
  return Vec3{rng.uniform() - 0.5, rng.uniform() - 0.5, rng.uniform() - 0.5} * size;
}
double difference(const Pose& a, const Pose& b, double arm) {
  double worst = 0;
  for (const Vec3 p : {Vec3{0, 0, 0}, Vec3{arm, 0, 0}, Vec3{0, arm, 0}, Vec3{0, 0, arm}})
    worst = std::fmax(worst, length(a.point(p) - b.point(p)));
  return worst;
}
Vec3 numeric_velocity(const Track& track, double t) {
  const double h = 1e-4;
  return (track.at(t + h).translation - track.at(t - h).translation) / (2 * h);
}

// One screw motion, whatever frame it is written in: ENU, Earth-centred, and a camera's.
TEST(Track, ScrewInterpolationDoesNotDependOnTheFrame) {
  Pcg32 rng(11);
  const SceneFrame frame({47.3, 8.5, 400});
  double worst = 0;
  for (int i = 0; i < 300; ++i) {
    const Pose a{random_rotation(rng), random_place(rng, 2000)}, b{random_rotation(rng), random_place(rng, 2000)};
    const Pose camera = Pose{random_rotation(rng), random_place(rng, 2000)}.inverse();
    const Pose earth = frame.to_ecef();
    for (const double s : {0.0, 0.1, 0.5, 0.77, 1.0}) {
      const Pose enu = sclerp(a, b, s);
      worst = std::fmax(worst, difference(enu, earth.inverse() * sclerp(earth * a, earth * b, s), 1));
      worst = std::fmax(worst, difference(enu, camera.inverse() * sclerp(camera * a, camera * b, s), 1));
    }
  }
  std::printf("largest difference between frames: %.3g m\n", worst);
  EXPECT_LT(worst, 1e-8);
}

TEST(Track, KeyframesWrittenInAnyFrameGiveOnePose) {
  const SceneFrame frame({47.3, 8.5, 400});
  const Vec3 p{500, -300, 120};
  const Quat q = platform_rotation(0.3, 0.1, -0.2);
  const Pose enu{q, p};
  const Geodetic g = frame.geodetic_from_enu(p);
  const Pose ecef = frame.to_ecef() * enu;
  EXPECT_LT(difference(enu, pose_from_ecef(frame, ecef.translation, ecef.rotation), 1), 1e-8);
  // The local axes at the place are turned against the scene's by place.
  const Quat local = SceneFrame(g).to_ecef().rotation;
  const Quat relative = normalized(local.conjugate() * frame.to_ecef().rotation * q);
  EXPECT_LT(difference(enu, pose_from_geodetic(frame, g, relative), 1), 1e-8);
  // In UTM the heading counts from grid north: the convergence there is dlon sin(lat) to first order.
  const UtmZone zone = standard_utm_zone(g);
  const Pose grid = pose_from_utm(frame, utm_from_geodetic(g, zone), {});
  const Vec3 forward = grid.vector({0, 1, 0});
  const double convergence = (g.longitude_deg - 9) * kDegree * std::sin(g.latitude_deg * kDegree);
  EXPECT_NEAR(std::atan2(forward.x, forward.y), convergence, 2e-4);
  EXPECT_LT(length(grid.translation - p), 1e-8);
}

TEST(Track, KeyframesMeetTheirKeysAndScrewBetween) {
  const Pose a{{}, {10, 0, 0}}, b{quat_about({0, 0, 1}, kPi / 2), {0, 10, 4}};
  const TrackPtr track = keyframe_track({{1, a}, {3, b}, {4, b}});
  EXPECT_LT(difference(track->at(1), a, 1), 1e-12);
  EXPECT_LT(difference(track->at(3), b, 1), 1e-12);
  EXPECT_LT(difference(track->at(4), b, 1), 1e-12);
  // A quarter turn about the z axis through the origin with 4 m of rise: half way at 45 degrees on the circle.
  const Pose half = track->at(2);
  EXPECT_LT(length(half.translation - Vec3{10 * std::sqrt(0.5), 10 * std::sqrt(0.5), 2}), 1e-12);
  EXPECT_LT(length(half.vector({1, 0, 0}) - Vec3{std::sqrt(0.5), std::sqrt(0.5), 0}), 1e-12);
  EXPECT_THAT(track->kinks({0, 10}), testing::ElementsAre(1, 3, 4));
  EXPECT_NEAR(length(track->velocity(2)), std::hypot(10 * kPi / 4, 2.0), 1e-9);
}

TEST(Track, RotationsOfNearlyNothingAndOfHalfATurn) {
  for (const double angle : {1e-9, 1e-6, kPi - 1e-9, kPi}) {
    const Pose a{{}, {100, 5, 0}}, b = Pose{quat_about({0, 0, 1}, angle), {}} * a;
    const Pose half = sclerp(a, b, 0.5), one_way = Pose{quat_about({0, 0, 1}, angle / 2), {}} * a;
    const Pose other_way = Pose{quat_about({0, 0, -1}, angle / 2), {}} * a;
    double off = difference(half, one_way, 1);
    if (angle == kPi) off = std::fmin(off, difference(half, other_way, 1));  // both ways round are equally short
    EXPECT_LT(off, 1e-12) << angle;
  }
  // A full turn is no turn.
  const Pose a{{}, {1, 2, 3}}, b{quat_about({0, 0, 1}, 2 * kPi), {5, 2, 3}};
  EXPECT_LT(length(sclerp(a, b, 0.25).translation - Vec3{2, 2, 3}), 1e-9);
}

TEST(Track, RefusesBadKeysAndTimesOutside) {
  EXPECT_THROW(keyframe_track({}), Error);
  EXPECT_THROW(keyframe_track({{0, {}}, {0, {}}}), Error);
  EXPECT_THROW(keyframe_track({{1, {}}, {0, {}}}), Error);
  EXPECT_THROW(keyframe_track({{NAN, {}}}), Error);
  EXPECT_THROW(keyframe_track({{0, {{}, {NAN, 0, 0}}}}), Error);
  EXPECT_THROW(keyframe_track({{0, {{2, 0, 0, 0}, {}}}}), Error);
  const TrackPtr track = keyframe_track({{0, {}}, {1, {}}});
  EXPECT_THROW(track->at(-1e-9), Error);
  EXPECT_THROW(track->at(1.0000001), Error);
  EXPECT_THROW(track->at(NAN), Error);
  EXPECT_THROW(track->velocity(2), Error);
}

TEST(Track, PlatformAxes) {
  const Quat level = platform_rotation(azimuth_from_compass_deg(90), 0, 0);  // heading east
  EXPECT_LT(length(rotate(level, {0, 1, 0}) - Vec3{1, 0, 0}), 1e-15);
  EXPECT_LT(length(rotate(level, {1, 0, 0}) - Vec3{0, -1, 0}), 1e-15);
  EXPECT_GT(rotate(platform_rotation(0, 0.1, 0), {0, 1, 0}).z, 0.09);   // nose up
  EXPECT_LT(rotate(platform_rotation(0, 0, 0.1), {1, 0, 0}).z, -0.09);  // right side down
}

TEST(Track, StraightFlight) {
  const TrackPtr t = straight_track({{1, 2, 100}, kPi / 2, std::asin(0.6), 10, 5, nullptr});
  EXPECT_LT(length(t->at(7).translation - Vec3{1, 18, 112}), 1e-12);
  EXPECT_LT(length(t->velocity(0) - Vec3{0, 8, 6}), 1e-12);
  EXPECT_LT(length(t->at(0).vector({0, 1, 0}) - Vec3{0, 0.8, 0.6}), 1e-15);
  EXPECT_THROW(straight_track({{}, 0, 0, -1, 0, nullptr}), Error);
  EXPECT_THROW(straight_track({{}, 0, 2, 1, 0, nullptr}), Error);
}

TEST(Track, CurvedFlightKeepsItsHeightAndSpeed) {
  const SceneFrame frame({45, 10, 200});
  const StraightMotion m{{3000, -2000, 5000}, 0.4, 0, 200, 0, &frame};
  const TrackPtr t = straight_track(m);
  const double height = frame.geodetic_from_enu(m.start).height_m;
  EXPECT_LT(length(t->at(0).translation - m.start), 1e-8);
  for (const double time : {-500.0, 100.0, 1000.0}) {
    const Pose p = t->at(time);
    EXPECT_NEAR(frame.geodetic_from_enu(p.translation).height_m, height, 1e-6);
    EXPECT_LT(angle_between(p.vector({0, 0, 1}), frame.local_axes(p.translation).z), 1e-8);
    EXPECT_NEAR(length(t->velocity(time)), 200, 0.02);
    EXPECT_LT(angle_between(normalized(t->velocity(time)), p.vector({0, 1, 0})), 1e-4);
  }
}

TEST(Track, CirclingFlight) {
  for (const bool clockwise : {false, true}) {
    const CircleMotion m{{100, 200, 300}, 50, 20, 0.7, 0.3, 1, clockwise};
    const TrackPtr t = circle_track(m);
    for (const double time : {1.0, 4.0, 20.0}) {
      const Pose p = t->at(time);
      EXPECT_NEAR(length(p.translation - m.center), 50, 1e-10);
      EXPECT_LT(length(t->velocity(time) - numeric_velocity(*t, time)), 1e-5);
      EXPECT_LT(angle_between(p.vector({0, 1, 0}), t->velocity(time) / 20.0), 1e-12);
      // Banked into the turn: the body's up leans towards the centre.
      EXPECT_NEAR(dot(p.vector({0, 0, 1}), (m.center - p.translation) / 50.0), std::sin(0.3), 1e-12);
    }
    EXPECT_GT((clockwise ? -1 : 1) * cross(t->at(1).translation - m.center, t->velocity(1)).z, 0);
  }
  EXPECT_THROW(circle_track({{}, 0, 1, 0, 0, 0, false}), Error);
  EXPECT_THROW(circle_track({{}, 1, 0, 0, 0, 0, false}), Error);
}

TEST(Track, SpinAndComposition) {
  const SpinMotion rotor{{{}, {0, 0, 2}}, {0, 0, 2}, {1, 0, 0}, 3, 0};
  const TrackPtr spin = spin_track(rotor);
  EXPECT_LT(length(spin->at(0.4).point({1, 0, 0}) - Vec3{1, 0, 2}), 1e-15);  // the hub stays
  EXPECT_LT(length(spin->velocity(0.4) - numeric_velocity(*spin, 0.4)), 1e-7);
  EXPECT_LT(difference(spin->at(2 * kPi / 3 * 1000), spin->at(0), 1), 1e-10);
  const TrackPtr craft = straight_track({{}, 0, 0, 7, 0, nullptr});
  const TrackPtr both = composed_track(craft, spin);
  const Vec3 expected = craft->at(2).point(spin->at(2).point({0.5, 0.5, 0.5}));
  EXPECT_LT(length(both->at(2).point({0.5, 0.5, 0.5}) - expected), 1e-13);
  EXPECT_LT(length(both->velocity(2) - numeric_velocity(*both, 2)), 1e-6);
  EXPECT_THROW(spin_track({{}, {0, 0, 0}, {}, 1, 0}), Error);
  const TrackPtr part = composed_track(keyframe_track({{0, {}}, {2, {}}}), keyframe_track({{1, {}}, {5, {}}}));
  EXPECT_EQ(part->covered().begin, 1);
  EXPECT_EQ(part->covered().end, 2);
}

TEST(Track, PointingRules) {
  const TrackPtr craft = straight_track({{0, 0, 1000}, kPi / 2, 0.1, 50, 0, nullptr});
  const TrackPtr target = static_track({{}, {300, 400, 10}});
  const Pose look = pointed_track(craft, {Pointing::look_at, target, nullptr})->at(3);
  EXPECT_LT(angle_between(look.vector({0, 0, -1}), normalized(Vec3{300, 400, 10} - look.translation)), 1e-15);
  EXPECT_NEAR(look.vector({1, 0, 0}).z, 0, 1e-15);  // the picture is level
  EXPECT_GT(look.vector({0, 1, 0}).z, 0);
  const Pose down = pointed_track(craft, {Pointing::nadir, nullptr, nullptr})->at(3);
  EXPECT_LT(length(down.vector({0, 0, -1}) - Vec3{0, 0, -1}), 1e-15);
  EXPECT_LT(length(down.vector({0, 1, 0}) - Vec3{0, 1, 0}), 1e-15);
  const Pose along = pointed_track(craft, {Pointing::velocity, nullptr, nullptr})->at(3);
  EXPECT_LT(angle_between(along.vector({0, 1, 0}), craft->velocity(3) / 50.0), 1e-12);
  // Straight down and at rest have their own rules; no direction at all is refused.
  const TrackPtr still = static_track({{}, {0, 0, 100}});
  const Pose vertical = pointed_track(still, {Pointing::look_at, static_track({}), nullptr})->at(0);
  EXPECT_LT(length(vertical.vector({0, 1, 0}) - Vec3{0, 1, 0}), 1e-12);
  EXPECT_LT(length(pointed_track(still, {Pointing::nadir, nullptr, nullptr})->at(0).vector({0, 1, 0}) - Vec3{0, 1, 0}),
            1e-15);
  EXPECT_THROW(pointed_track(still, {Pointing::velocity, nullptr, nullptr})->at(0), Error);
  EXPECT_THROW(pointed_track(still, {Pointing::look_at, still, nullptr})->at(0), Error);
  EXPECT_THROW(pointed_track(still, {Pointing::look_at, nullptr, nullptr}), Error);
}

// UT1 knows no leap seconds: over the one at the end of 2005 the ground track neither stands still nor jumps. A step of
// a second changes from one to the next by what gravity and the turning Earth bend the path, 10 m.
TEST(Track, OrbitThroughALeapSecond) {
  const auto orbit =
      std::make_shared<const Sgp4>(read_tle_of(SUITE_TEST_DATA "/motion/SGP4-VER.TLE", "28057").elements);
  const SceneFrame frame({40, -100, 300});
  for (const char* epoch : {"2005-12-31T23:59:50Z", "2005-12-31T23:20:00Z", "2005-12-31T22:50:00Z"}) {
    const Clock clock(parse_iso8601(epoch));
    const TrackPtr track = orbit_track(orbit, frame, clock, 0.1);
    const double leap = clock.seconds(parse_iso8601("2006-01-01T00:00:00Z"));
    for (double t = leap - 5; t <= leap + 5; ++t) {
      const Vec3 before = track->at(t - 1).translation, here = track->at(t).translation,
                 next = track->at(t + 1).translation;
      EXPECT_LT(length((next - here) - (here - before)), 15) << epoch << " " << t - leap;
    }
  }
}

TEST(Track, OrbitAboveTheScene) {
  const auto orbit =
      std::make_shared<const Sgp4>(read_tle_of(SUITE_TEST_DATA "/motion/SGP4-VER.TLE", "28057").elements);
  const SceneFrame frame({40, -100, 300});
  const Clock clock(orbit->elements().epoch);
  const TrackPtr track = orbit_track(orbit, frame, clock, 0.1);
  for (const double t : {0.0, 1234.5, 86400.0}) {
    const Pose p = track->at(t);
    const Geodetic g = frame.geodetic_from_enu(p.translation);
    EXPECT_GT(g.height_m, 7e5);
    EXPECT_LT(g.height_m, 8.2e5);
    EXPECT_LT(length(track->velocity(t) - numeric_velocity(*track, t)), 0.02);
    EXPECT_LT(angle_between(p.vector({0, 0, 1}), frame.local_axes(p.translation).z), 1e-9);
    EXPECT_GT(dot(p.vector({0, 1, 0}), normalized(track->velocity(t))), 0.999);
    EXPECT_NEAR(dot(p.vector({1, 0, 0}), track->velocity(t)), 0, 1e-6);
  }
  // Looking down the normal from orbit meets the ellipsoid at the sub-satellite point.
  const Pose nadir = pointed_track(track, {Pointing::nadir, nullptr, &frame})->at(60);
  const Geodetic above = frame.geodetic_from_enu(nadir.translation);
  const Geodetic below = frame.geodetic_from_enu(nadir.point({0, 0, -above.height_m}));
  EXPECT_NEAR(below.latitude_deg, above.latitude_deg, 1e-9);
  EXPECT_NEAR(below.height_m, 0, 1e-6);
}

// A rotor: the chord of an arc of angle a lies r (1 - cos(a/2)) inside it.
TEST(TimeSteps, RotorKeepsItsBoundWithNoMoreStepsThanNeeded) {
  const double rate = 40, radius = 5, window = 0.1, bound = 1e-3;
  const TrackPtr rotor = spin_track({{}, {0, 0, 1}, {}, rate, 0});
  const size_t steps = time_steps_for(*rotor, {0, window}, radius, bound);
  const double largest_angle = 2 * std::acos(1 - bound / radius);
  EXPECT_EQ(steps, static_cast<size_t>(std::ceil(rate * window / largest_angle)) + 1);
  // What the ray tracer would do with the keys, against the truth, densely.
  auto error_with = [&](size_t n) {
    const auto keys = time_keys(*rotor, {0, window}, n);
    double worst = 0;
    for (int i = 0; i <= 5000; ++i) {
      const double x = i / 5000.0 * static_cast<double>(n - 1);
      const size_t k = std::min(static_cast<size_t>(x), n - 2);
      const Vec3 p{radius, 0, 0}, a = keys[k].point(p), b = keys[k + 1].point(p);
      const double s = x - static_cast<double>(k);
      worst = std::fmax(worst, length(a * (1 - s) + b * s - rotor->at(window * i / 5000.0).point(p)));
    }
    return worst;
  };
  EXPECT_LE(error_with(steps), bound * 1.0000001);
  EXPECT_GT(error_with(steps - 1), bound);
}

TEST(TimeSteps, WholeTurnsDoNotHide) {
  // 64 whole turns in the window: with 2, 9, 17, 33 or 65 keys every key is the same matrix.
  const TrackPtr rotor = spin_track({{}, {0, 0, 1}, {}, 2 * kPi * 64, 0});
  const size_t steps = time_steps_for(*rotor, {0, 1}, 1, 0.01);
  EXPECT_GE(steps, static_cast<size_t>(64 * 2 * kPi / (2 * std::acos(0.99))));
}

TEST(TimeSteps, StillStraightAndKinkedMotion) {
  EXPECT_EQ(time_steps_for(*static_track({}), {0, 10}, 100, 1e-6), 1u);
  EXPECT_EQ(time_steps_for(*straight_track({{}, 0, 0, 100, 0, nullptr}), {0, 10}, 100, 1e-6), 2u);
  EXPECT_EQ(time_steps_for(*straight_track({{}, 0, 0, 100, 0, nullptr}), {5, 5}, 100, 1e-6), 1u);
  EXPECT_EQ(time_steps_for(*straight_track({{}, 0, 0, 1e-9, 0, nullptr}), {0, 10}, 100, 1e-6), 1u);
  // A corner at 1/3 of the window: keys at thirds have one on it.
  const TrackPtr corner = keyframe_track({{0, {}}, {1, {{}, {10, 0, 0}}}, {3, {{}, {10, 20, 0}}}});
  EXPECT_EQ(time_steps_for(*corner, {0, 3}, 0, 1e-6), 4u);
}

TEST(TimeSteps, Refusals) {
  const TrackPtr track = keyframe_track({{0, {}}, {1, {}}});
  EXPECT_THROW(time_steps_for(*track, {0, 2}, 1, 1e-3), Error);
  EXPECT_THROW(time_steps_for(*track, {1, 0}, 1, 1e-3), Error);
  EXPECT_THROW(time_steps_for(*track, {0, 1}, 1, 0), Error);
  EXPECT_THROW(time_steps_for(*track, {0, 1}, -1, 1e-3), Error);
  EXPECT_THROW(time_steps_for(*spin_track({{}, {0, 0, 1}, {}, 1e9, 0}), {0, 1}, 1, 1e-3), Error);
}

}  // namespace
}  // namespace suite::track_test
