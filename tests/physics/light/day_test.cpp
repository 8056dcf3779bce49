// Time goes on: captures over a day in one run see the Sun, the Moon and the sky of their own moments, and are bit for
// bit what runs at those moments give. (Sources used to be resolved once a job, so that all of a day's captures had one
// sun.)
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "light/kinds/clear_sky.h"
#include "light/kinds/lamps.h"
#include "light/kinds/moon.h"
#include "motion/ephemeris.h"
#include "scheduler/kits.h"
#include "support/message_of.h"
#include "support/radiometry_kit.h"

namespace suite::day_test {
namespace {

using testing::HasSubstr;

constexpr int kHours = 5;
const char* const kMorning = "2026-06-21T07:00:00Z";
std::string hour(int h) { return strf("2026-06-21T%02d:00:00Z", 7 + 2 * h); }

// Looks down at two places in each of its captures; one every two hours, or all at the same moment.
class Day final : public Sensor {
 public:
  Day(std::string name, bool goes_on, double seconds = 0) : name_(std::move(name)) {
    states_.push_back(make_state(bands_, 0.05));
    Task task{"day", {0, (kHours - 1) * 7200.0}, {}};
    for (int h = 0; h < kHours; ++h) {
      Capture c;
      c.name = strf("%d", h);
      const double t = goes_on ? h * 7200.0 : 0;
      c.window = {t - 0.5 * seconds, t + 0.5 * seconds};
      c.columns = 2, c.rows = 1;
      c.neighbours = false;
      c.convergence.min_paths = c.convergence.max_paths = 16;
      task.captures.push_back(c);
    }
    tasks_.push_back(task);
  }
  std::string name() const override { return name_; }
  std::span<const SpectralState> states() const override { return states_; }
  std::span<const Band> bands(size_t) const override { return bands_; }
  std::span<const Task> tasks() const override { return tasks_; }
  SensorRay ray(const RayRequest& r) const override {
    return {{{0.3 * static_cast<double>(r.problem), 0, 5}, normalized(Vec3{0.02, 0.01, -1}), r.capture.window.begin}};
  }
  void accept(CaptureResult&& r) override { results[r.capture] = std::move(r); }
  std::vector<CaptureResult> results = std::vector<CaptureResult>(kHours);

 private:
  std::string name_;
  std::vector<Band> bands_{Band::rectangular("b", 0.55, 0.1)};
  std::vector<SpectralState> states_;
  std::vector<Task> tasks_;
};

std::shared_ptr<Scene> scene() {
  auto s = test::scene_of({test::quad(3, 0, 0), test::box({1, -1, 0}, {2, 1, 2}, 1, true)},
                          {test::material("ground", test::lambert(0.4)), test::material("wall", test::lambert(0.7))});
  s->origin = {48.5, 9.1, 400, true};
  return s;
}

// Everything that a date moves, and a lamp, which it does not.
SourceSpecs sources(const std::string& utc, bool air) {
  SourceSpecs s;
  SunSpec sun;
  sun.irradiance = Curve({0.2, 0.5, 0.6, 5}, {1500, 1900, 1800, 1500}, Outside::hold);
  sun.time = SourceTime{utc, {}};
  sun.disk_by_time = sun.at_1_au = true;
  s.add(sun);
  MoonSpec moon;
  moon.disk.time = SourceTime{utc, {}};
  moon.disk.disk_by_time = true;
  s.add(moon);
  s.dut1 = 0.3;
  if (air)
    s.atmosphere = AtmosphereSpec{};
  else
    s.add(ClearSkySpec{});
  LampSpec lamp;
  lamp.name = "lamp";
  lamp.positions = {{0, 1, 1}};
  lamp.intensity = Curve::constant(3);
  s.add(lamp);
  return s;
}

struct Finished {
  std::vector<CaptureResult> results;
  JobReport report;
};
Finished run(const SourceSpecs& s, std::vector<std::unique_ptr<Sensor>> sensors) {
  JobOptions job;
  job.progress = false;
  Finished r;
  r.report = run_job(scene(), s, sensors, job);
  for (auto& sensor : sensors)
    for (CaptureResult& c : static_cast<Day&>(*sensor).results) r.results.push_back(std::move(c));
  return r;
}
std::vector<std::unique_ptr<Sensor>> days(bool goes_on, int n = 1) {
  std::vector<std::unique_ptr<Sensor>> list;
  for (int i = 0; i < n; ++i) list.push_back(std::make_unique<Day>(strf("day %d", i), goes_on));
  return list;
}

TEST(Day, CapturesOverADayAreThoseOfRunsAtTheirHours) {
  for (const bool air : {false, true}) {
    SCOPED_TRACE(air);
    const Finished day = run(sources(kMorning, air), days(true));
    for (int h = 0; h < kHours; ++h) {
      SCOPED_TRACE(h);
      const auto i = static_cast<size_t>(h);
      const Finished then = run(sources(hour(h), air), days(false));
      EXPECT_EQ(day.results[i].radiance, then.results[i].radiance);
      EXPECT_EQ(day.results[i].standard_error, then.results[i].standard_error);
      // Another hour is another picture: the comparison can fail.
      const Finished other = run(sources(hour((h + 1) % kHours), air), days(false));
      EXPECT_NE(day.results[i].radiance, other.results[i].radiance);
    }
  }
}

TEST(Day, OnlyTheLightIsBakedAnewAndKitsAreShared) {
  const Finished day = run(sources(kMorning, false), days(true));
  EXPECT_EQ(day.report.optics_bakes, 1u);
  EXPECT_EQ(day.report.light_bakes, size_t{kHours});
  // Three sensors of one state at the same moments share all of it.
  const Finished three = run(sources(kMorning, false), days(true, 3));
  EXPECT_EQ(three.report.optics_bakes, 1u);
  EXPECT_EQ(three.report.light_bakes, size_t{kHours});
  EXPECT_EQ(three.results[0].radiance, day.results[0].radiance);
  // Sources without a date are baked once.
  SourceSpecs still = sources(kMorning, false);
  const auto at = scene();
  resolve_sources(still, *at);
  EXPECT_EQ(run(still, days(true)).report.light_bakes, 1u);
}

// Moments stand on a grid of absolute seconds: captures within half a second share their lights, wherever second 0 is.
TEST(Day, MomentsOfOneSecondShareTheirLights) {
  const auto at = scene();
  const SourceSpecs s = sources(kMorning, true), late = sources("2026-06-21T07:00:00.3Z", true);
  SourcesInTime in_time(s, *at), in_late(late, *at);
  for (const double t : {-0.49, 0.0, 0.3, 0.49}) EXPECT_EQ(in_time.on_grid(t), 0);
  EXPECT_EQ(in_time.on_grid(0.51), 1);
  EXPECT_EQ(in_time.on_grid(-0.51), -1);
  EXPECT_NEAR(in_late.on_grid(0), -0.3, 1e-11);
  EXPECT_EQ(in_late.on_grid(0), in_late.on_grid(0.1));
  EXPECT_EQ(in_late.on_grid(80000.9), in_late.on_grid(81000.8 - 1000));
  EXPECT_NEAR(in_late.on_grid(7200.1), 7199.7, 1e-11);
  SourceSpecs still = s;
  resolve_sources(still, *at);
  EXPECT_EQ(SourcesInTime(still, *at).on_grid(1234.56), 0);
  // What the grid costs, as moments.h says.
  const Dir exact = in_time.at(0.4999).sun()->disk()->direction;
  const double apart = angle_between(exact, Dir(in_time.at(in_time.on_grid(0.4999)).sun()->disk()->direction));
  EXPECT_LT(apart, 7.6 / 3600 * kDegree);
  EXPECT_GT(apart, 4 / 3600.0 * kDegree) << "nothing was tested";
  EXPECT_LT(apart, 0.0081 * in_time.at(0).sun()->disk()->half_angle);
}

TEST(Day, KitsGoWithTheirLastCapture) {
  const auto at = scene();
  const SourceSpecs s = sources(kMorning, true);
  const auto tracer = std::make_shared<const Tracer>(at);
  Kits kits(*at, s, false, {});
  const Day day("day", true);
  for (int c = 0; c < kHours; ++c) kits.expect(7);
  for (const Capture& c : day.tasks()[0].captures) {
    kits.get(7, day, c, tracer);
    EXPECT_EQ(kits.held(), 1u);
    kits.done(7);
  }
  EXPECT_EQ(kits.held(), 0u);
}

TEST(Day, OnlyWhatAMomentChangesIsBakedAgain) {
  const auto at = scene();
  const Tracer tracer(at);
  const SpectralState state = make_state(std::vector<Band>{Band::rectangular("b", 0.55, 0.01)}, 0.01);
  const SourceSpecs s = sources(kMorning, false);  // sun, moon, clear sky, lamp
  SourcesInTime in_time(s, *at);
  const Environment first = bake_environment(in_time.at(0), tracer, false, state);
  Environment later = first;
  rebake_changed(later, in_time.at(3600), tracer, state);
  const Environment fresh = bake_environment(in_time.at(3600), tracer, false, state);
  ASSERT_EQ(later.lights.size(), 4u);
  for (size_t i = 0; i < 3; ++i) EXPECT_NE(later.lights[i], first.lights[i]) << i;
  EXPECT_EQ(later.lights[3], first.lights[3]);
  for (size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(later.lights[i]->beam()->direction, fresh.lights[i]->beam()->direction);
    EXPECT_EQ(later.lights[i]->beam()->irradiance[0], fresh.lights[i]->beam()->irradiance[0]);
    EXPECT_NE(later.lights[i]->beam()->irradiance[0], first.lights[i]->beam()->irradiance[0]);
  }
}

TEST(Day, Dut1TurnsTheSky) {
  // 0.9 s are 13.5 arc seconds of hour angle.
  const auto at = scene();
  SourceSpecs s = sources(kMorning, true), t = s;
  s.dut1 = -0.45, t.dut1 = 0.45;
  resolve_sources(s, *at), resolve_sources(t, *at);
  const double declination = 23.43 * kDegree;
  const auto turned = [&](size_t body) {
    return angle_between(s.lights[body]->disk()->direction, t.lights[body]->disk()->direction);
  };
  EXPECT_NEAR(turned(0), 0.9 * 2 * kPi / 86164 * std::cos(declination), 2e-7);
  EXPECT_GT(turned(1), 5e-5);
}

TEST(Day, SentencesAndRefusals) {
  const auto at = scene();
  const auto sensors = days(true);
  const std::vector<std::string> said = describe_sources(sources(kMorning, true), *at, sensors);
  ASSERT_EQ(said.size(), 4u);
  EXPECT_THAT(said[0], HasSubstr("first capture: sun at 2026-06-21T07:00:00Z"));
  EXPECT_THAT(said[2], HasSubstr("last capture: sun at 2026-06-21T15:00:00.000Z"));
  // A clear sky ends with the day.
  EXPECT_THAT(
      message_of([&] { describe_sources(sources("2026-06-21T15:00:00Z", false), *at, sensors); }),
      HasSubstr("a clear sky needs the sun above the horizon; at 21600 s, when '3' of sensor 'day 0' is taken"));
}

TEST(Day, LongCapturesAreTold) {
  const auto at = scene();
  SourceSpecs s = sources(kMorning, true);
  std::erase_if(s.lights, [](auto& light) { return light->key() == "moon"; });
  // 2 s: the sun moves by 0.008 degrees, less than its radius, and the light of the morning changes by less than 0.1 %.
  EXPECT_FALSE(long_exposure(s, *at, Day("short", true, 2)));
  const auto found = long_exposure(s, *at, Day("long", true, 600));
  ASSERT_TRUE(found);
  EXPECT_EQ(found->seconds, 600);
  // By eye of the ephemeris: from the beginning to the end of the window.
  const SceneFrame frame({48.5, 9.1, 400});
  double most = 0;
  for (int h = 0; h < kHours; ++h) {
    const Instant then = instant_from_utc(parse_iso8601(hour(h)));
    most = std::max(most, angle_between(sun_at(frame, {}, then + -300, 0.3, {}).direction,
                                        sun_at(frame, {}, then + 300, 0.3, {}).direction));
  }
  EXPECT_LE(found->moved, most + 1e-9);
  EXPECT_GT(found->moved, 0.99 * most);
  EXPECT_GT(found->irradiance_change, kExposureLimit);
  SourceSpecs still = s;
  resolve_sources(still, *at);
  EXPECT_FALSE(long_exposure(still, *at, Day("long", true, 600)));
}

}  // namespace
}  // namespace suite::day_test
