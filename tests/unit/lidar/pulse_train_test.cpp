// When pulses leave and where to: clocks, bursts, channels, scanners, motion while light is on its way.
#include "lidar/pulse_train.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/params.h"
#include "spectral/planck.h"

namespace suite::pulse_train_test {
namespace {

std::shared_ptr<const Deflector> deflector(const std::string& yaml) {
  return make_deflector(Params::parse_text(yaml, "scanner.yaml"));
}

// 1000 m up, heading north at 60 m/s.
TrainSpec over_flat_ground() {
  TrainSpec s;
  s.clock.tasks = {{10, 100}};
  s.clock.rate = 1000;
  s.carrier.track = straight_track({{0, 0, 1000}, kPi / 2, 0, 60, 10, nullptr});
  s.deflector = deflector("kind: fixed");
  return s;
}

TEST(PulseTrain, RotationsFromDown) {
  for (const Dir& to : {Dir{0, 0, -1}, Dir{0, 0, 1}, Dir{1, 0, 0}, normalized(Vec3{1, 2, 3}),
                        normalized(Vec3{1e-9, 0, 1}), normalized(Vec3{-3, 1, -0.1})})
    EXPECT_LT(length(rotate(rotation_from_down(to), {0, 0, -1}) - to), 1e-12) << to.x << " " << to.y << " " << to.z;
}

TEST(PulseTrain, TicksTasksAndPlaces) {
  TrainSpec s = over_flat_ground();
  s.clock.tasks.push_back({20, 5});
  const ClockedTrain train(s);
  ASSERT_EQ(train.size(), 105u);
  EXPECT_DOUBLE_EQ(train.pulse(0)->time, 10);
  EXPECT_DOUBLE_EQ(train.pulse(99)->time, 10.099);
  EXPECT_DOUBLE_EQ(train.pulse(100)->time, 20);
  EXPECT_NEAR(train.pulse(99)->emission.translation.y, 0.099 * 60, 1e-9);
  EXPECT_LT(length(train.pulse(7)->emission.vector({0, 0, -1}) - Vec3{0, 0, -1}), 1e-12);
  EXPECT_DOUBLE_EQ(train.interval(), 1e-3);
}

// Light is received where the vehicle then is: 2 R / c later.
TEST(PulseTrain, ReceptionIsLater) {
  TrainSpec s = over_flat_ground();
  s.carrier.track = straight_track({{0, 0, 5e5}, kPi / 2, 0, 7500, 10, nullptr});
  const double round_trip = 2 * 5e5 / kSpeedOfLight;
  const ResponsePulse p = *ClockedTrain(s).pulse(0, round_trip);
  EXPECT_NEAR(p.reception.translation.y - p.emission.translation.y, 7500 * round_trip, 1e-6);  // 25.02 m
}

TEST(PulseTrain, BurstsAndChannels) {
  TrainSpec s = over_flat_ground();
  s.clock.burst = 3, s.clock.burst_rate = 1e5;
  s.deflector = deflector("{kind: rotating_head, rotation_hz: 10, elevations_deg: [-15, 0, 15], firing_us: [4, 0, 2]}");
  const ClockedTrain train(s);
  ASSERT_EQ(train.size(), 900u);
  double last = 0;
  for (uint64_t i = 0; i < train.size(); ++i) {
    const ResponsePulse p = *train.pulse(i);
    EXPECT_GT(p.time, last) << i;
    last = p.time;
  }
  EXPECT_DOUBLE_EQ(train.pulse(1)->time, 10 + 2e-6);  // the third channel fires second
  EXPECT_DOUBLE_EQ(train.pulse(3)->time, 10 + 1e-5);  // the second of the burst
  EXPECT_DOUBLE_EQ(train.pulse(9)->time, 10 + 1e-3);  // the next tick
  EXPECT_NEAR(train.pulse(1)->emission.vector({0, 0, -1}).z, std::sin(15 * kDegree), 1e-12);
  EXPECT_NEAR(train.interval(), 1e-5, 1e-12);
}

// Each task starts the scanner anew; the mirror turns on while light is on its way only if the receiver looks along it.
TEST(PulseTrain, ScannersStartWithTheTask) {
  TrainSpec s = over_flat_ground();
  s.deflector = deflector("{kind: galvo, half_angle_deg: 15, rate_hz: 50}");
  const double half = 15 * kDegree, round_trip = 2000 / kSpeedOfLight;
  ClockedTrain train(s);
  const Dir quarter = train.pulse(5)->emission.vector({0, 0, -1});  // 5 ms of 20 ms
  EXPECT_NEAR(quarter.x, std::sin(half), 1e-9);
  const auto lag = [&](const ClockedTrain& of) {
    const ResponsePulse p = *of.pulse(0, round_trip);
    return std::acos(std::min(1.0, dot(p.emission.vector({0, 0, -1}), p.reception.vector({0, 0, -1}))));
  };
  EXPECT_NEAR(lag(train), 0, 1e-7);
  s.scan_lag = true;
  EXPECT_NEAR(lag(ClockedTrain(s)), half * 2 * kPi * 50 * round_trip, 1e-6);  // 0.549 mrad
}

// No beam leaves at the edges of facets.
TEST(PulseTrain, Edges) {
  TrainSpec s = over_flat_ground();
  s.deflector = deflector("{kind: polygon, facets: 4, rotation_hz: 25, duty: 0.5}");
  const ClockedTrain train(s);
  size_t lit = 0;
  for (uint64_t i = 0; i < train.size(); ++i) lit += train.pulse(i).has_value();
  EXPECT_NEAR(static_cast<double>(lit), 50, 10);
}

// Bistatic: the laser goes its own way, and the scanner turns its beam alone.
TEST(PulseTrain, TwoVehicles) {
  TrainSpec s = over_flat_ground();
  s.laser.emplace();
  s.laser->track = static_track({{}, {500, 0, 20}});
  s.laser_place.translation = {0, 0, 1};
  s.deflector = deflector("{kind: galvo, half_angle_deg: 15, rate_hz: 50}");
  const ResponsePulse p = *ClockedTrain(s).pulse(5);
  EXPECT_LT(length(p.emission.translation - Vec3{500, 0, 21}), 1e-12);
  EXPECT_NEAR(p.emission.vector({0, 0, -1}).x, std::sin(15 * kDegree), 1e-9);
  EXPECT_NEAR(p.reception.vector({0, 0, -1}).z, -1, 1e-12);
}

}  // namespace
}  // namespace suite::pulse_train_test
