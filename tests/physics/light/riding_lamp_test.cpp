// Lamps that ride: what a point lamp on a moving frame sends to a level plane, at several times and over a window,
// against the closed form I h / d^3.
#include "light/riding_light.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/lamps_kit.h"
#include "tests/support/message_of.h"

namespace suite::test {
namespace {

constexpr double kHeight = 2, kSpeed = 3, kIntensity = 5, kReflectance = 0.5;

// Along x at a height over the origin at second 0, without turning.
TrackPtr passing() {
  const auto at = [](double t) { return PoseKey{t, {{}, {kSpeed * t, 0, kHeight}}}; };
  return keyframe_track({at(-10), at(10)});
}

std::shared_ptr<Scene> floor() { return scene_of({quad(50, 0, 0)}, {material("floor", lambert(kReflectance))}); }

SourceSpecs lit_by(LampSpec lamp, TrackPtr track) {
  SourceSpecs s;
  s.add(std::vector<LightSpecPtr>{riding(make_light(std::move(lamp)), std::move(track))});
  return s;
}

// Irradiance of the plane at the origin at a time.
double irradiance(double t) {
  const double x = kSpeed * t;
  return kIntensity * kHeight / std::pow(kHeight * kHeight + x * x, 1.5);
}

TEST(RidingLamp, IsWhereItsTrackIsAtTheTimeOfTheRay) {
  const Tracer tracer(floor());
  const SpectralState state = make_state(one_band(), 1);
  const auto light = lit_by(point_lamp({{0, 0, 0}}, kIntensity), passing()).lights[0]->bake(tracer, state);
  EXPECT_TRUE(light->nature().moves);
  EXPECT_TRUE(light->nature().delta);
  EXPECT_EQ(light->members(), 1u);
  const LightReceiver at{{0, 0, 0}, {0, 0, 1}, false};
  for (const double t : {-4.0, -1.0, 0.0, 0.5, 7.0}) {
    const auto s = light->sample(at, {0.5, 0.5, 0.5, 0.5}, t);
    ASSERT_TRUE(s) << t;
    EXPECT_NEAR(s->scale * static_cast<double>(s->spectrum[0]) * s->direction.z, irradiance(t), 1e-9) << t;
    EXPECT_NEAR(length(s->end - Vec3{kSpeed * t, 0, kHeight}), 0, 1e-12) << t;
    const auto half = light->sample_member(0, 0.5, at, {0.5, 0.5, 0.5, 0.5}, t);
    ASSERT_TRUE(half) << t;
    EXPECT_NEAR(half->scale, 2 * s->scale, 1e-12) << t;
  }
  // Beyond its track it stands at the end of it.
  EXPECT_EQ(light->sample(at, {}, 30)->end, light->sample(at, {}, 10)->end);
}

TEST(RidingLamp, TurnsWithWhatCarriesIt) {
  // A spot that looks along the x axis of a body that turns about z: it reaches a wall of receivers one after the
  // other.
  LampSpec spot = point_lamp({{0.5, 0, 0}}, 1);
  spot.kind = LampSpec::Kind::spot;
  spot.axis = {1, 0, 0};
  spot.inner = spot.outer = 0.1;
  SpinMotion turning;
  turning.rate = kPi / 2;
  const Tracer tracer(floor());
  const auto light = lit_by(spot, spin_track(turning)).lights[0]->bake(tracer, make_state(one_band(), 1));
  for (int quarter = 0; quarter < 4; ++quarter)
    for (int t = 0; t < 4; ++t) {
      const LightReceiver at{Vec3{std::cos(quarter * kPi / 2), std::sin(quarter * kPi / 2), 0} * 3, {}, true};
      const auto s = light->sample(at, {}, t);
      EXPECT_EQ(s.has_value(), quarter == t) << quarter << " " << t;
      if (s) {
        EXPECT_NEAR(s->scale, 1 / (2.5 * 2.5), 1e-9);
      }
    }
}

// Looks at the origin at times spread evenly over its window.
class Exposure final : public RaySensor {
 public:
  Exposure(TimeSpan window, uint32_t paths)
      : RaySensor({{{0, 0, 1}, {0, 0, -1}, 0}}, one_band(), paths), window_(window) {}
  SensorRay ray(const RayRequest& request) const override {
    Ray ray = rays_[0];
    ray.time = window_.begin + request.u[0] * (window_.end - window_.begin);
    return {ray, 1};
  }

 private:
  TimeSpan window_;
};

TEST(RidingLamp, AnExposureSeesTheMeanOfItsWindow) {
  // The integral of (h^2 + x^2)^(-3/2) is x / (h^2 sqrt(h^2 + x^2)).
  const auto passed = [](double t) {
    const double x = kSpeed * t;
    return kIntensity / (kSpeed * kHeight) * x / std::sqrt(kHeight * kHeight + x * x);
  };
  const SourceSpecs lamp = lit_by(point_lamp({{0, 0, 0}}, kIntensity), passing());
  for (const TimeSpan window : {TimeSpan{-1, 1}, TimeSpan{0, 4}, TimeSpan{2, 2.5}, TimeSpan{0.7, 0.7}}) {
    const Rendered run = render(floor(), lamp, std::make_unique<Exposure>(window, 1 << 12));
    const double mean = window.end > window.begin
                            ? (passed(window.end) - passed(window.begin)) / (window.end - window.begin)
                            : irradiance(window.begin),
                 expected = mean * kReflectance / kPi;
    EXPECT_NEAR(run.result.radiance[0], expected, 4 * run.result.standard_error[0] + 1e-6 * expected) << window.begin;
    EXPECT_LT(run.result.standard_error[0], 0.02 * expected);
    EXPECT_GT(std::fabs(irradiance(0) * kReflectance / kPi - expected), 0.02 * expected) << "a lamp at rest would do";
  }
}

TEST(RidingLamp, OnlyPointsAndSpotsRide) {
  const Tracer tracer(floor());
  const SpectralState state = make_state(one_band(), 1);
  const auto message = [&](LightSpecPtr carried) {
    return message_of([&] { riding(std::move(carried), passing())->bake(tracer, state); });
  };
  EXPECT_THAT(message(make_light(uniform_sky(1, false))), testing::HasSubstr("only points and spots ride"));
  EXPECT_THAT(message(make_light(glow("floor", 1))), testing::HasSubstr("only points and spots ride"));
  const Tracer cell(floor(), Periodic{{-1, -1}, {2, 2}});
  EXPECT_THAT(message_of([&] {
                riding(make_light(point_lamp({{0, 0, 0}}, 1)), passing())->bake(cell, state);
              }),
              testing::HasSubstr("repeats itself"));
}

}  // namespace
}  // namespace suite::test
