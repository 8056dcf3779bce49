// Lamps that ride on placements, and lamps with schedules: what they send to a level plane at several times and over a
// window, against the closed form I h / d^3.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "motion/track.h"
#include "tests/support/lamps_kit.h"
#include "tests/support/message_of.h"

namespace suite::test::lamps_in_time_test {
namespace {

constexpr double kHeight = 2, kSpeed = 3, kIntensity = 5, kReflectance = 0.5;
const LightReceiver kOrigin{{0, 0, 0}, {0, 0, 1}, false};

// A floor, and a cart that shows a speck 5 m over its axes and moves, comes and goes as `p` says.
std::shared_ptr<Scene> floor_and_cart(Placement p, std::vector<SceneTrack> tracks,
                                      std::vector<Schedule> schedules = {}) {
  auto scene = scene_of({quad(50, 0, 0), quad(0.001, 5, 0)}, {material("floor", lambert(kReflectance))});
  scene->tracks = std::move(tracks);
  scene->schedules = std::move(schedules);
  scene->tags = {"one", "two"};
  Placement speck;
  speck.target = 1;
  p.kind = TargetKind::group, p.target = 1;
  scene->groups = {{"root", {scene->groups[0].placements[0], p}}, {"cart", {speck}}};
  check_scene(*scene, "test");
  return scene;
}

// Along x at a height over the origin at second 0, without turning.
PoseKey key(double t) { return {t, {{}, {kSpeed * t, 0, kHeight}}}; }
std::shared_ptr<Scene> passing() {
  Placement p;
  p.track = 0;
  return floor_and_cart(p, {{"cart", keyframe_track({key(-10), key(10)})}});
}

LampSpec riding_on(const std::string& name, LampSpec lamp) {
  lamp.ride = name;
  return lamp;
}
SourceSpecs lit_by(LampSpec lamp) {
  SourceSpecs s;
  s.add(std::move(lamp));
  return s;
}
std::shared_ptr<const Light> baked(const LampSpec& lamp, const Tracer& tracer) {
  return lit_by(lamp).lights[0]->bake(tracer, make_state(one_band(), 1));
}
LampSpec lamp_at(Vec3 place) { return point_lamp({place}, kIntensity); }

// Irradiance of the plane at the origin at a time.
double irradiance(double t) {
  const double x = kSpeed * t;
  return kIntensity * kHeight / std::pow(kHeight * kHeight + x * x, 1.5);
}
double irradiance_of(const LightSample& s) { return s.scale * static_cast<double>(s.spectrum[0]) * s.direction.z; }

TEST(LampsInTime, ARidingLampIsWhereItsPlacementIsAtTheTimeOfTheRay) {
  const Tracer tracer(passing(), std::nullopt, {-10, 10});
  const auto light = baked(riding_on("cart", lamp_at({})), tracer);
  EXPECT_TRUE(light->nature().moves);
  EXPECT_TRUE(light->nature().delta);
  EXPECT_EQ(light->members(), 1u);
  for (const double t : {-10.0, -4.0, -1.0, 0.0, 0.5, 7.0, 10.0}) {
    const auto s = light->sample(kOrigin, {0.5, 0.5, 0.5, 0.5}, t);
    ASSERT_TRUE(s) << t;
    EXPECT_NEAR(irradiance_of(*s), irradiance(t), 1e-9) << t;
    EXPECT_NEAR(length(s->end - Vec3{kSpeed * t, 0, kHeight}), 0, 1e-12) << t;
    const auto half = light->sample_member(0, 0.5, kOrigin, {0.5, 0.5, 0.5, 0.5}, t);
    ASSERT_TRUE(half) << t;
    EXPECT_NEAR(half->scale, 2 * s->scale, 1e-12) << t;
  }
}

TEST(LampsInTime, ARidingLampTurnsAndGrowsWithItsPlacement) {
  // A spot that looks along the x axis of a body that turns about z, twice as large: it reaches receivers around it one
  // after the other.
  LampSpec spot = riding_on("cart", point_lamp({{0.5, 0, 0}}, 1));
  spot.kind = LampSpec::Kind::spot;
  spot.axis = {1, 0, 0};
  spot.inner = spot.outer = 0.1;
  SpinMotion turning;
  turning.rate = kPi / 2;
  Placement p;
  p.track = 0;
  p.to_parent = scaling({2, 2, 2});
  const auto scene = floor_and_cart(p, {{"cart", spin_track(turning)}});
  for (const TimeSpan window : {TimeSpan{0, 3}, TimeSpan{-0.01, 3.01}}) {
    const Tracer tracer(scene, std::nullopt, window);
    const auto light = baked(spot, tracer);
    for (int quarter = 0; quarter < 4; ++quarter)
      for (int t = 0; t < 4; ++t) {
        const LightReceiver at{Vec3{std::cos(quarter * kPi / 2), std::sin(quarter * kPi / 2), 0} * 4, {}, true};
        const auto s = light->sample(at, {}, t);
        EXPECT_EQ(s.has_value(), quarter == t) << quarter << " " << t;
        if (s) {
          EXPECT_NEAR(s->scale, 1 / (3.0 * 3.0), 1e-9);
        }
      }
  }
}

TEST(LampsInTime, EveryPlacementOfTheNameCarriesOneWhileItIsThere) {
  // Two carts, one from 1 to 3 s; the lamp rides on all, on a tag, and on what never was placed.
  Placement first, second;
  first.tag = 0, first.to_parent.b = {-4, 0, 2};
  Schedule s;
  s.name = "cart";
  s.life = {1, 3};
  auto scene = floor_and_cart(first, {}, {s});
  second = scene->groups[0].placements[1];
  second.tag = 1, second.schedule = 0, second.to_parent.b = {4, 0, 2};
  scene->groups[0].placements.push_back(second);
  const Tracer tracer(scene, std::nullopt, {0, 10});
  const auto both = baked(riding_on("cart", lamp_at({})), tracer), one = baked(riding_on("two", lamp_at({})), tracer);
  EXPECT_EQ(both->members(), 2u);
  EXPECT_EQ(one->members(), 1u);
  for (const double t : {0.5, 1.0, 2.9, 3.0, 9.0}) {
    const bool there = t >= 1 && t < 3;
    const auto of = [&](const Light& light) {
      double sum = 0;
      for (size_t m = 0; m < light.members(); ++m)
        if (const auto drawn = light.sample_member(m, 1, kOrigin, {}, t)) sum += irradiance_of(*drawn);
      return sum;
    };
    const double each = kIntensity * 2 / std::pow(4 + 16, 1.5);
    EXPECT_NEAR(of(*both), each * (there ? 2 : 1), 1e-12) << t;
    EXPECT_NEAR(of(*one), there ? each : 0, 1e-12) << t;
    // The tree's choice averages to the same.
    double sum = 0;
    for (int k = 0; k < 1000; ++k)
      if (const auto drawn = both->sample(kOrigin, {(k + 0.5) / 1000, 0, 0, 0}, t)) sum += irradiance_of(*drawn) / 1000;
    EXPECT_NEAR(sum, each * (there ? 2 : 1), 2e-3 * each) << t;
  }
  // Where it is not there all through the window it is no lamp.
  EXPECT_EQ(baked(riding_on("cart", lamp_at({})), Tracer(scene, std::nullopt, {5, 6}))->members(), 1u);
}

TEST(LampsInTime, ASchedulesRowHoldsFromItsTimeOn) {
  LampSpec lamp = lamp_at({0, 0, kHeight}), surface = glow("floor", 3, true);
  lamp.schedule = surface.schedule = std::make_shared<const LampSchedule>(LampSchedule{{{0, 2, 3}, 10}, {1, 0, 2.5}});
  const Tracer tracer(passing());
  const auto point = baked(lamp, tracer), glowing = baked(surface, tracer);
  EXPECT_TRUE(point->nature().moves);
  for (const auto& [t, scale] : {std::pair{0.0, 1.0},
                                 {1.999, 1.0},
                                 {2.0, 0.0},
                                 {2.9, 0.0},
                                 {3.0, 2.5},
                                 {9.9, 2.5},
                                 {10.0, 1.0},
                                 {-0.1, 2.5},
                                 {-8.0, 0.0}}) {
    const auto s = point->sample(kOrigin, {}, t);
    EXPECT_NEAR(s ? irradiance_of(*s) : 0, scale * irradiance(0), 1e-9) << t;
    const auto drawn = glowing->sample({{0, 0, 1}, {0, 0, -1}, false}, {0.3, 0.4, 0.5, 0.6}, t);
    Hit hit;
    hit.object = 0;
    const auto met = glowing->met_surface({{0, 0, 1}, {0, 0, -1}, false}, hit, 0, {0, 0, -1}, 1, 1, t);
    EXPECT_EQ(drawn ? drawn->scale : 0, scale) << t;
    EXPECT_EQ(met ? met->scale : 0, scale) << t;
  }
}

TEST(LampsInTime, WhatIsDarkAllThroughTheWindowIsNotDrawn) {
  LampSpec lamp = lamp_at({0, 0, kHeight});
  lamp.schedule = std::make_shared<const LampSchedule>(LampSchedule{{{0, 2, 3}, 10}, {1, 0, 2.5}});
  for (const auto& [window, members] :
       {std::pair{TimeSpan{0, 1.9}, 1u}, {{2.1, 2.9}, 0u}, {{2.1, 3}, 1u}, {{-9, 9}, 1u}})
    EXPECT_EQ(baked(lamp, Tracer(passing(), std::nullopt, window))->members(), members) << window.begin;
}

TEST(LampsInTime, AnExposureSeesTheMeanOfItsWindow) {
  // The integral of (h^2 + x^2)^(-3/2) is x / (h^2 sqrt(h^2 + x^2)).
  const auto passed = [](double t) {
    const double x = kSpeed * t;
    return kIntensity / (kSpeed * kHeight) * x / std::sqrt(kHeight * kHeight + x * x);
  };
  const SourceSpecs lamp = lit_by(riding_on("cart", lamp_at({})));
  for (const TimeSpan window : {TimeSpan{-1, 1}, TimeSpan{0, 4}, TimeSpan{2, 2.5}, TimeSpan{0.7, 0.7}}) {
    const Rendered run = render(passing(), lamp, std::make_unique<Exposure>(1, window, 1 << 12));
    const double mean = window.end > window.begin
                            ? (passed(window.end) - passed(window.begin)) / (window.end - window.begin)
                            : irradiance(window.begin),
                 expected = mean * kReflectance / kPi;
    EXPECT_NEAR(run.result.radiance[0], expected, 4 * run.result.standard_error[0] + 1e-6 * expected) << window.begin;
    EXPECT_LT(run.result.standard_error[0], 0.02 * expected);
    EXPECT_GT(std::fabs(irradiance(0) * kReflectance / kPi - expected), 0.02 * expected) << "a lamp at rest would do";
  }
}

TEST(LampsInTime, WhatCannotCarryIsRefused) {
  using testing::HasSubstr;
  const auto message = [](const std::shared_ptr<Scene>& scene, const std::string& name) {
    const Tracer tracer(scene, std::nullopt, {0, 1});
    return message_of([&] { baked(riding_on(name, lamp_at({})), tracer); });
  };
  EXPECT_THAT(message(passing(), "cat"), HasSubstr("'cat', which the scene does not place"));
  Placement wide, turned;
  wide.to_parent = scaling({1, 2, 1});
  EXPECT_THAT(message(floor_and_cart(wide, {}), "cart"), HasSubstr("stretched"));
  turned.to_parent = scaling({1, 1, -1});
  EXPECT_THAT(message(floor_and_cart(turned, {}), "cart"), HasSubstr("mirrored"));
  const Tracer cell(floor_and_cart({}, {}), Periodic{{-1, -1}, {2, 2}});
  EXPECT_THAT(message_of([&] { baked(riding_on("cart", lamp_at({})), cell); }), HasSubstr("repeats itself"));
}

}  // namespace
}  // namespace suite::test::lamps_in_time_test
