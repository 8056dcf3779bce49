// Pulses over surfaces against closed forms: energy, arrival, shape.
#include <gtest/gtest.h>

#include "base/parallel.h"
#include "tests/support/lamps_kit.h"
#include "tests/support/lidar_kit.h"

namespace suite::test::trace_test {
namespace {

std::shared_ptr<Scene> plate(double reflectance, double half = 1000) {
  return scene_of({quad(half, 0, 0)}, {material("plate", lambert(reflectance))});
}

// DIRSIG's demo LidarValidate1: a 10 % plate 2 km below 128 x 128 pixels, 7.345289 photons each:
// (E lambda / h c) / (pi R^2 tan^2 theta) rho / pi A_pix / G#, with a rectangular beam profile of half-angle 8 mrad.
TEST(Trace, APlateFillsEveryPixelOfAnArray) {
  DownLidar lidar(2000);
  lidar.train->like.energy = 1.5e-4;
  lidar.laser.beam.kind = BeamProfile::Kind::top_hat;
  lidar.laser.beam.half_angle = 8e-3;
  lidar.receiver.aperture = 0.2, lidar.receiver.throughput = 0.5;
  lidar.receiver.columns = lidar.receiver.rows = 8;
  lidar.receiver.pitch = 50e-6, lidar.receiver.focal = 0.4;
  lidar.gate_of(1990, 2010, 1e-9);
  lidar.paths = 16;
  const Received got = receive(plate(0.1), lidar);
  EXPECT_FALSE(got.report.laser_first);
  ASSERT_EQ(got.rows().n(), 64u);
  EXPECT_NEAR(got.rows().mean(), 7.345289, 1e-3 * 7.345289);
  EXPECT_NEAR(got.total(1).photons, 0, 1e-12) << "nothing is scattered twice";
  EXPECT_EQ(got.report.outside, 0);
}

// The same receiver with a field stop: energy x rho / pi x cos / R^2 x area of the aperture, whichever end begins.
TEST(Trace, APlateUnderAGaussianBeamSendsItsShareIntoTheAperture) {
  for (const StartFrom from : {StartFrom::laser, StartFrom::receiver}) {
    DownLidar lidar(1000, 16);
    lidar.laser.beam.full_angle_1_e2 = 0.5e-3;
    lidar.receiver.aperture = 0.15, lidar.receiver.field_of_view = 2e-3;
    lidar.gate_of(990, 1010, 1e-9);
    lidar.start_from = from;
    lidar.orders = 1;
    lidar.paths = 64;
    const Received got = receive(plate(0.3), lidar);
    const double expected = lidar.photons() * 0.3 / kPi / 1e6 * kPi * 0.15 * 0.15 / 4;
    EXPECT_NEAR(got.rows().mean(), expected, 1e-3 * expected) << (from == StartFrom::laser ? "laser" : "receiver");
    EXPECT_EQ(got.report.laser_first, from == StartFrom::laser);
    // All of it comes back from 1000 m.
    const double middle = 2 * 1000 / kSpeedOfLight;
    double first = 0;
    for (const ResponseBlock& b : got.blocks)
      for (size_t e = 0; e < b.entries(); ++e)
        first += b.value[2 * e] * (lidar.gate.start + (b.bin[e] - 0.5) * lidar.gate.bin - middle);
    EXPECT_NEAR(first / got.total().photons, 0, 1e-12);
  }
}

// DIRSIG's demo LidarSide2: a sphere of 2.5 m radius and 10 % at 166.68 km, far within a beam of 0.05 mrad half-angle:
// 2/3 rho r^2 E / (pi R^2 tan^2 theta) A / R^2. The share returned from above depth z is 1 - (1 - z / r)^3.
TEST(Trace, ASphereReturnsByItsDepth) {
  const double R = 166680, r = 2.5;
  auto scene = std::make_shared<Scene>();
  scene->materials = {material("sphere", lambert(0.1))};
  place(*scene, PrimitiveKind::sphere, {r}, 0);
  check_scene(*scene, "sphere");
  DownLidar lidar(R, 64);
  lidar.laser.beam.kind = BeamProfile::Kind::top_hat;
  lidar.laser.beam.half_angle = 0.05e-3;
  lidar.receiver.aperture = 0.1, lidar.receiver.field_of_view = 2 * 2.6 / R;
  lidar.gate_of(R - 3, R + 3, 1e-10);
  lidar.paths = 256, lidar.orders = 1;
  const Received got = receive(scene, lidar);
  const RunningStats rows = got.rows();
  EXPECT_NEAR(rows.mean(), 2.89148, 4 * rows.stderr_of_mean() + 1e-4 * 2.89148);
  EXPECT_LT(rows.stderr_of_mean(), 5e-3 * rows.mean());
  const auto bin_of = [&](double depth) {
    return static_cast<uint32_t>((2 * (R - r + depth) / kSpeedOfLight - lidar.gate.start) / lidar.gate.bin) + 1;
  };
  EXPECT_NEAR(2 * (R - r) / kSpeedOfLight, 1.11195259e-3, 5e-12);
  const uint32_t first = bin_of(0);
  EXPECT_EQ(got.sum([&](uint32_t b) { return b + 1 < first; }).photons, 0);
  EXPECT_GT(got.sum([&](uint32_t b) { return b <= first + 1; }).photons, 0);
  for (const double depth : {0.3, 0.8, 1.3, 2.0}) {
    const auto above = got.sum([&](uint32_t b) { return b <= bin_of(depth); });
    const double at = (lidar.gate.start + bin_of(depth) * lidar.gate.bin) * kSpeedOfLight / 2 - (R - r);  // bin's end
    const double expected = (1 - std::pow(1 - at / r, 3)) * 64 * 2.89148;
    EXPECT_NEAR(above.photons, expected, 4 * above.error() + 2e-3 * expected) << depth;
  }
}

// Under a top hat an inclined plate returns a half ellipse, sqrt(1 - (t / t_m)^2) with t_m = 2 R theta tan(slope) / c.
TEST(Trace, AnInclinedPlateReturnsAHalfEllipse) {
  const double R = 1000, theta = 0.5e-3, slope = 45 * kDegree;
  const double half = 50, rise = half * std::tan(slope);
  const auto scene =
      scene_of({mesh_of({{-half, -half, -rise}, {half, -half, rise}, {half, half, rise}, {-half, half, -rise}},
                        {0, 1, 2, 0, 2, 3}, 0)},
               {material("plate", lambert(0.3))});
  DownLidar lidar(R, 64);
  lidar.laser.beam.kind = BeamProfile::Kind::top_hat;
  lidar.laser.beam.half_angle = theta;
  lidar.receiver.field_of_view = 2e-3;
  lidar.gate_of(R - 2, R + 2, 2e-11);
  lidar.paths = 256, lidar.orders = 1;
  const Received got = receive(scene, lidar);
  const double tm = 2 * R * theta * std::tan(slope) / kSpeedOfLight, middle = 2 * R / kSpeedOfLight;
  const auto ellipse = [](double x) { return 0.5 + (x * std::sqrt(1 - x * x) + std::asin(x)) / kPi; };
  const double all = got.total().photons;
  for (const double x : {-0.9, -0.5, 0.0, 0.5, 0.9}) {
    const auto bin = static_cast<uint32_t>((middle + x * tm - lidar.gate.start) / lidar.gate.bin);
    const double at = (lidar.gate.start + bin * lidar.gate.bin - middle) / tm;
    const auto before = got.sum([&](uint32_t b) { return b <= bin; });
    EXPECT_NEAR(before.photons / all, ellipse(at), 4 * before.error() / all + 1e-3) << x;
  }
  // Nothing returns from outside of it.
  const auto outside = got.sum([&](uint32_t b) {
    const double t = lidar.gate.start + (b - 0.5) * lidar.gate.bin - middle;
    return b > 0 && std::fabs(t) > tm * 1.001 + 2 * lidar.gate.bin;
  });
  EXPECT_EQ(outside.photons, 0);
}

// A Gaussian beam on a slope: sigma = 2 R tan(slope) (full angle / 4) / c: 0.83391 ns at 1 km, 0.5 mrad and 45 degrees.
TEST(Trace, AGaussianBeamIsSpreadByASlope) {
  const double R = 1000, half = 50;
  const auto scene =
      scene_of({mesh_of({{-half, -half, -half}, {half, -half, half}, {half, half, half}, {-half, half, -half}},
                        {0, 1, 2, 0, 2, 3}, 0)},
               {material("plate", lambert(0.3))});
  DownLidar lidar(R, 64);
  lidar.laser.beam.full_angle_1_e2 = 0.5e-3;
  lidar.receiver.field_of_view = 4e-3;
  lidar.gate_of(R - 3, R + 3, 5e-11);
  lidar.paths = 256, lidar.orders = 1;
  const Received got = receive(scene, lidar);
  double sum = 0, first = 0, second = 0;
  for (const ResponseBlock& b : got.blocks)
    for (size_t e = 0; e < b.entries(); ++e) {
      const double t = (b.bin[e] - 0.5) * lidar.gate.bin, v = b.value[2 * e];
      sum += v, first += v * t, second += v * t * t;
    }
  const double mean = first / sum, split = lidar.gate.bin * lidar.gate.bin / 6;  // what the linear split adds
  EXPECT_NEAR(std::sqrt(second / sum - mean * mean - split), 0.83391e-9, 0.01 * 0.83391e-9);
  EXPECT_NEAR(lidar.gate.start + mean, 2 * R / kSpeedOfLight, 4 * 0.84e-9 / std::sqrt(64 * 256.0));
}

// Bits do not depend on threads or on where a run is cut.
TEST(Trace, ResultsAreTheSameOnAnyNumberOfThreads) {
  DownLidar lidar(100, 600);
  lidar.laser.beam.full_angle_1_e2 = 2e-3;
  lidar.receiver.field_of_view = 5e-3;
  lidar.gate_of(90, 110, 1e-9);
  lidar.paths = 4;
  const auto scene =
      scene_of({quad(50, 0, 0), box({-0.1, -0.1, 0}, {0.05, 0.05, 2}, 0, true)}, {material("plate", lambert(0.5))});
  const auto flat = [](const Received& r) {
    std::vector<double> all;
    for (const ResponseBlock& b : r.blocks) {
      all.insert(all.end(), b.value.begin(), b.value.end());
      all.insert(all.end(), b.variance.begin(), b.variance.end());
      all.insert(all.end(), b.bin.begin(), b.bin.end());
    }
    return all;
  };
  set_threads(1);
  const Received one = receive(scene, lidar);
  set_threads(3);
  const Received three = receive(scene, lidar);
  set_threads(0);
  EXPECT_EQ(flat(one), flat(three));
  Received parts;
  parts.head = one.head;
  for (const uint64_t first : {0u, 256u, 512u}) {
    TraceOptions options;
    options.first = first, options.count = 256;
    trace_pulses(scene, {}, lidar, options, parts);
  }
  EXPECT_EQ(parts.blocks.back().first_pulse + parts.blocks.back().pulses.size(), 600u);
  std::vector<double> joined, whole;
  for (const ResponseBlock& b : parts.blocks) joined.insert(joined.end(), b.value.begin(), b.value.end());
  for (const ResponseBlock& b : one.blocks) whole.insert(whole.end(), b.value.begin(), b.value.end());
  EXPECT_EQ(joined, whole);
  TraceOptions other;
  other.seed = 2;
  EXPECT_NE(flat(receive(scene, lidar, {}, other)), flat(one));
}

// A uniform sky of radiance L over a Lambert plate: radiance rho L in bin 0, within the width of a bin.
TEST(Trace, PassiveLightStandsInBinZero) {
  SourceSpecs sky;
  sky.add(uniform_sky(10, false));
  for (const StartFrom from : {StartFrom::laser, StartFrom::receiver}) {
    DownLidar lidar(100, 8);
    lidar.laser.beam.full_angle_1_e2 = 2e-3;
    lidar.receiver.field_of_view = 5e-3, lidar.receiver.aperture = 0.2, lidar.receiver.filter_um = 1e-3;
    lidar.gate_of(90, 110, 1e-9);
    lidar.start_from = from;
    const Received got = receive(plate(0.4), lidar, sky);
    const double solid = 2 * kPi * (1 - std::cos(2.5e-3)), area = kPi * 0.01;
    const double expected = 8 * 0.4 * 10 * solid * area * 1e-3 * 1e-9 * 1.064e-6 / (kPlanckConstant * kSpeedOfLight);
    EXPECT_TRUE(got.report.passive);
    const auto dark = got.bin(0);
    EXPECT_NEAR(dark.photons, expected, 4 * dark.error() + 0.01 * expected);
    const double active = 8 * lidar.photons() * 0.4 / kPi / 1e4 * area;
    EXPECT_NEAR(got.total().photons, active, 0.05 * active);
  }
}

// Sun, lamp and a warm plate together: the radiance of the band that the filter passes. Sun and lamp have a line within
// the filter, but beside the laser's: alone at the laser's wavelength they would be a third weaker.
TEST(Trace, PassiveLightIsThatOfTheFiltersBand) {
  const double um = 3.5, filter = 0.02, kelvin = 400, reflectance = 0.4, height = 60;
  const Curve lines({3, 3.5045, 3.505, 3.5055, 4}, {2, 2, 40, 2, 2}, Outside::hold);
  const double mean = lines.mean(um - filter / 2, um + filter / 2);
  EXPECT_NEAR(mean, 2.95, 1e-9);
  auto scene = plate(reflectance);
  scene->materials[0].temperature_k = kelvin;
  SourceSpecs all;
  all.add(SunSpec{{{0, 0, 1}, 0.00465, lines.scaled(5)}});
  LampSpec lamp = point_lamp({{0, 0, height}}, 0);
  lamp.intensity = lines.scaled(9000);
  all.add(lamp);
  const double emitted = (1 - reflectance) * planck_band_radiance(um - filter / 2, um + filter / 2, kelvin) / filter,
               scattered = reflectance / kPi * mean * (5 + 9000 / (height * height));
  EXPECT_GT(emitted, 0.1 * scattered);
  EXPECT_LT(emitted, 10 * scattered);
  for (const StartFrom from : {StartFrom::laser, StartFrom::receiver}) {
    DownLidar lidar(100, 8);
    lidar.train->like.wavelength_um = um;
    lidar.laser.beam.full_angle_1_e2 = 2e-3;
    lidar.receiver.field_of_view = 5e-3, lidar.receiver.aperture = 0.2, lidar.receiver.filter_um = filter;
    lidar.gate_of(90, 110, 1e-9);
    lidar.paths = 512;
    lidar.start_from = from;
    const Received got = receive(scene, lidar, all);
    const double solid = 2 * kPi * (1 - std::cos(2.5e-3)), area = kPi * 0.01;
    const double expected =
        8 * (emitted + scattered) * solid * area * filter * 1e-9 * um * 1e-6 / (kPlanckConstant * kSpeedOfLight);
    const auto dark = got.bin(0);
    EXPECT_NEAR(dark.photons, expected, 4 * dark.error() + 2e-3 * expected);
    EXPECT_LT(dark.error(), 0.02 * expected);
    const double active = 8 * lidar.photons() * reflectance / kPi / 1e4 * area;
    EXPECT_NEAR(got.total().photons, active, 0.05 * active);
  }
}

// Channels by the tag of what is met first: half of the spot lies on a roof.
TEST(Trace, TagsHaveChannels) {
  for (const StartFrom from : {StartFrom::laser, StartFrom::receiver}) {
    auto scene = scene_of(
        {quad(100, 0, 0), mesh_of({{0, -50, 2}, {50, -50, 2}, {50, 50, 2}, {0, 50, 2}}, {0, 1, 2, 0, 2, 3}, 1)},
        {material("plate", lambert(0.3)), material("tiles", lambert(0.3))});
    scene->tags = {"street", "roof"};
    scene->groups[0].placements[0].tag = 0, scene->groups[0].placements[1].tag = 1;
    DownLidar lidar(1000, 8);
    lidar.laser.beam.full_angle_1_e2 = 1e-3;
    lidar.receiver.field_of_view = 4e-3;
    lidar.gate_of(990, 1010, 1e-9);
    lidar.start_from = from;
    lidar.tags = {"roof", "tiles", "plate"};
    const Received got = receive(scene, lidar);
    ASSERT_EQ(got.head.channels,
              (std::vector<std::string>{"single", "multiple", "tag:roof", "tag:tiles", "tag:plate"}));
    const auto roof = got.total(2), all = got.total();
    EXPECT_NEAR(roof.photons, all.photons / 2, 4 * std::hypot(roof.error(), all.error()) + 0.01 * all.photons);
    EXPECT_EQ(got.total(3).photons, 0) << "a tag of a placement goes before its material";
    EXPECT_NEAR(got.total(4).photons, all.photons - roof.photons, 1e-9 * all.photons)
        << "the street has a tag that nobody asks for, its material has a channel";
    // And it is what comes back first.
    const double between = 2 * 999 / kSpeedOfLight;
    const auto early = got.sum([&](uint32_t b) { return lidar.gate.start + (b - 0.5) * lidar.gate.bin < between; }, 2);
    EXPECT_NEAR(early.photons, roof.photons, 1e-9 * roof.photons);
  }
}

// Light is under way while the receiver moves: 7.5 km/s at 500 km are 25 m of track.
TEST(Trace, PosesAreThoseOfEmissionAndReception) {
  const double H = 500e3;
  DownLidar lidar(H, 4);
  lidar.train->velocity = {7500, 0, 0};
  lidar.laser.beam.full_angle_1_e2 = 50e-6;
  lidar.receiver.field_of_view = 400e-6, lidar.receiver.aperture = 1;
  lidar.gate_of(H - 10, H + 10, 1e-9);
  lidar.paths = 32;
  const Received got = receive(plate(0.9), lidar);
  ASSERT_EQ(got.blocks.size(), 1u);
  const ResponsePulse& pulse = got.blocks[0].pulses[1];
  const double trip = 2 * H / kSpeedOfLight, moved = 7500 * trip;
  EXPECT_NEAR(pulse.reception.translation.x - pulse.emission.translation.x, moved, 1e-6);
  EXPECT_NEAR(moved, 25.017, 1e-3);
  // Against a pair that stands there: the same light.
  EXPECT_NEAR(got.total().photons, 4 * lidar.photons() * 0.9 / kPi / (H * H) * kPi / 4, 2e-3 * got.total().photons);
}

}  // namespace
}  // namespace suite::test::trace_test
