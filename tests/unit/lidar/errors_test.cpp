// Errors of range bins, and extreme cases with a documented outcome.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include "motion/track.h"
#include "tests/support/lidar_kit.h"
#include "tests/support/message_of.h"

namespace suite::test {
namespace {

std::shared_ptr<Scene> plate(double reflectance, double half = 1000) {
  return scene_of({quad(half, 0, 0)}, {material("plate", lambert(reflectance))});
}

// Share of the rows, each an experiment of its own, whose interval holds the mean of all; of bins with at least 30
// contributions. 16 scrambles: Student's t of 15 degrees of freedom, 2.1314 at 95 %.
double covered(const std::shared_ptr<const Scene>& scene, const LidarInstrument& lidar, int& intervals) {
  const Received got = receive(scene, lidar);
  const size_t channels = got.head.channels.size();
  std::map<uint32_t, RunningStats> truth;
  size_t rows = 0;
  for (const ResponseBlock& b : got.blocks) {
    rows += b.row_count();
    for (size_t e = 0; e < b.entries(); ++e) truth[b.bin[e]].add(b.value[e * channels] + b.value[e * channels + 1]);
  }
  int inside = 0;
  intervals = 0;
  for (const ResponseBlock& b : got.blocks)
    for (size_t r = 0; r < b.row_count(); ++r) {
      const ResponseRow row(got.head, b, r);
      for (size_t k = 0; k < row.size(); ++k) {
        const RunningStats& all = truth[row.bin(k)];
        if (row.contributions(k) < 30 || all.n() < rows || !(all.variance() > 1e-12 * all.mean() * all.mean()))
          continue;
        ++intervals;
        inside += std::fabs(row.photons(k) - all.mean()) <= 2.1314 * std::sqrt(row.photon_variance(k));
      }
    }
  return static_cast<double>(inside) / intervals;
}

// With n intervals of 95 % the share has a standard deviation of sqrt(0.05 0.95 / n), times some for bins that share
// paths; thousands of intervals are compared.
TEST(LidarErrors, IntervalsCoverWhatTheySay) {
  DownLidar lidar(10, 400);
  lidar.laser.beam.full_angle_1_e2 = 0.1;
  lidar.receiver.field_of_view = 0.4;
  lidar.paths = 512, lidar.orders = 4;
  lidar.gate_of(0, 20, 4e-9);
  const auto room = scene_of({box({-6, -5, 0}, {5, 6, 12}, 0, false), box({-0.5, -0.3, 0}, {0.2, 0.3, 2}, 0, true)},
                             {material("wall", lambert(0.6))});
  const auto hills = scene_of({mesh_of({{-9, -9, -9}, {9, -9, 9}, {9, 9, 9}, {-9, 9, -9}}, {0, 1, 2, 0, 2, 3}, 0)},
                              {material("soil", lambert(0.4))});
  const std::shared_ptr<Scene> fog = slab_scene(medium(Curve::constant(0.05), Curve::constant(0.4), hg(0.3)), 6);
  int n = 0;
  for (const auto& [name, scene] : {std::pair{"room", room}, {"hills", hills}, {"fog", fog}}) {
    if (scene == fog) {  // its orders need paths: those of single scattering are counted, too
      lidar.train->count = 250;
      lidar.paths = 2048;
      lidar.gate_of(0, 20, 2e-8);
    }
    const double share = covered(scene, lidar, n);
    EXPECT_GT(n, 500) << name;
    std::printf("%s: %.4f of %d intervals\n", name, share, n);
    EXPECT_GT(share, 0.93) << name << " " << n;
    EXPECT_LT(share, 0.97) << name << " " << n;
  }
}

// A bin that no path has reached is not known to be dark.
TEST(LidarErrors, BinsThatNoPathReachedHaveABound) {
  DownLidar lidar(100, 1);
  lidar.laser.beam.full_angle_1_e2 = 1e-3;
  lidar.receiver.field_of_view = 2e-3;
  lidar.gate_of(90, 110, 1e-9);
  const Received got = receive(plate(0.3), lidar);
  const ResponseRow row(got.head, got.blocks.at(0), 0);
  const BinKnown dark = row.known(1);
  EXPECT_FALSE(dark.reached);
  EXPECT_GT(dark.bound, 0);
  EXPECT_LT(dark.bound, got.total().photons);
}

TEST(LidarExtremes, ABeamWithoutWidthIsANarrowOne) {
  for (const StartFrom from : {StartFrom::automatic, StartFrom::receiver}) {
    DownLidar lidar(1000);
    lidar.laser.beam.full_angle_1_e2 = 0;
    lidar.receiver.field_of_view = 1e-3;
    lidar.gate_of(990, 1010, 1e-9);
    lidar.start_from = from;
    lidar.orders = 1;
    const Received got = receive(plate(0.3), lidar);
    const double expected = lidar.photons() * 0.3 / kPi / 1e6 * kPi * 0.01 / 4;
    EXPECT_NEAR(got.total().photons, expected, 0.05 * expected);
  }
}

// It would see nothing, passive light neither, and say nothing.
TEST(LidarExtremes, AFieldWithoutWidthIsRefused) {
  DownLidar lidar(1000);
  lidar.gate_of(990, 1010, 1e-9);
  lidar.receiver.field_of_view = 0;
  EXPECT_NE(message_of([&] { receive(plate(0.3), lidar); }).find("field of view must be above 0"), std::string::npos);
}

// At the gate's first instant: the first bin has it all. Just before: it is counted as outside.
TEST(LidarExtremes, ATargetAtTheStartOfTheGate) {
  DownLidar lidar(1000);
  lidar.laser.beam.full_angle_1_e2 = 1e-5;
  lidar.receiver.field_of_view = 1e-3;
  const double expected = lidar.photons() * 0.3 / kPi / 1e6 * kPi * 0.01 / 4;
  lidar.gate_of(1000 - 1e-6, 1010, 1e-9);
  const Received at = receive(plate(0.3), lidar);
  EXPECT_NEAR(at.bin(1).photons, expected, 1e-2 * expected);
  lidar.gate_of(1001, 1010, 1e-9);
  const Received before = receive(plate(0.3), lidar);
  EXPECT_EQ(before.total().photons, 0);
  EXPECT_NEAR(before.report.outside, expected, 1e-2 * expected);
}

// 36 000 km, and a target that comes nearer by 300 m/s while light is under way.
TEST(LidarExtremes, FarAway) {
  const double R = 36e6;
  DownLidar lidar(R, 4);
  lidar.laser.beam.full_angle_1_e2 = 1e-5;
  lidar.receiver.field_of_view = 4e-5, lidar.receiver.aperture = 1;
  lidar.gate_of(R - 10, R + 10, 1e-9);
  const Received got = receive(plate(0.5, 1e4), lidar);
  const double expected = lidar.photons() * 0.5 / kPi / (R * R) * kPi / 4;
  EXPECT_NEAR(got.rows().mean(), expected, 1e-2 * expected);
  double sum = 0, first = 0;
  for (const ResponseBlock& b : got.blocks)
    for (size_t e = 0; e < b.entries(); ++e) sum += b.value[2 * e], first += b.value[2 * e] * (b.bin[e] - 0.5) * 1e-9;
  EXPECT_NEAR(first / sum, 2 * 10 / kSpeedOfLight, 1e-11) << "a beam 180 m wide curves by 0.1 mm";
}

// A plate that comes up by 300 m/s: every pulse finds it where it is when light turns back.
TEST(LidarExtremes, AMovingTarget) {
  const double H = 1000, speed = 300;
  auto scene = plate(0.3, 100);
  scene->tracks.push_back({"rise", keyframe_track({{0, {{}, {}}}, {1, {{}, {0, 0, speed}}}})});
  scene->groups[0].placements[0].track = 0;
  DownLidar lidar(H, 3);
  lidar.train->spacing = 0.1;
  lidar.laser.beam.full_angle_1_e2 = 1e-5;
  lidar.receiver.field_of_view = 1e-3;
  lidar.gate_of(H - 100, H + 10, 1e-10);
  const Received got = receive(scene, lidar);
  ASSERT_EQ(got.blocks.size(), 1u);
  for (size_t r = 0; r < 3; ++r) {
    const ResponseRow row(got.head, got.blocks[0], r);
    double sum = 0, first = 0;
    for (size_t k = 0; k < row.size(); ++k)
      sum += row.photons(k), first += row.photons(k) * arrival_of_bin(got.head, row.pulse(), row.bin(k));
    // d = H - v (t + d / c)
    const double d = (H - speed * 0.1 * static_cast<double>(r)) / (1 + speed / kSpeedOfLight);
    EXPECT_NEAR(first / sum, 2 * d / kSpeedOfLight, 2e-13) << r;
  }
}

// 10 km between them at 10 km height: both look at the same spot.
TEST(LidarExtremes, BistaticTenKilometres) {
  const double H = 10e3, b = 5e3, R = std::hypot(H, b), tilt = std::atan2(b, H);
  DownLidar lidar(H, 16);
  lidar.laser.offset = {quat_about({0, 1, 0}, -tilt), {-b, 0, 0}};
  lidar.receiver.offset = {quat_about({0, 1, 0}, tilt), {b, 0, 0}};
  lidar.laser.beam.full_angle_1_e2 = 1e-4;
  lidar.receiver.field_of_view = 1e-3;
  lidar.gate_of(R - 10, R + 10, 1e-9);
  for (const StartFrom from : {StartFrom::laser, StartFrom::receiver}) {
    lidar.start_from = from;
    const Received got = receive(plate(0.5), lidar);
    const double expected = lidar.photons() * 0.5 / kPi * std::cos(tilt) / (R * R) * kPi * 0.01 / 4;
    const RunningStats rows = got.rows();
    EXPECT_NEAR(rows.mean(), expected, 4 * rows.stderr_of_mean() + 1e-3 * expected);
    EXPECT_LT(rows.stderr_of_mean(), 0.05 * expected);
  }
}

// The laser stands in the cloud, and the gate begins there.
TEST(LidarExtremes, AGateThatStartsInACloud) {
  const double alpha = 0.05, start = 10;
  auto scene = std::make_shared<Scene>();
  scene->groups.push_back({"root", {}});
  scene->media = {medium(Curve::constant(0), Curve::constant(alpha))};
  scene->ambient = 0;
  check_scene(*scene, "cloud");
  DownLidar lidar(0, 16);
  lidar.laser.beam.full_angle_1_e2 = 1e-3;
  lidar.receiver.field_of_view = 2e-3;
  lidar.gate_of(start, 60, 1e-8);
  lidar.orders = 1;
  const Received got = receive(scene, lidar);
  double expected = 0;
  for (int i = 0; i < 100000; ++i) {
    const double x = start + (60 - start) * (i + 0.5) / 100000;
    expected += std::exp(-2 * alpha * x) / (x * x) * (60 - start) / 100000;
  }
  expected *= lidar.photons() * alpha / (4 * kPi) * kPi * 0.01 / 4;
  const RunningStats rows = got.rows();
  EXPECT_NEAR(rows.mean(), expected, 4 * rows.stderr_of_mean());
  EXPECT_LT(rows.stderr_of_mean(), 0.005 * expected);
}

// A corner of smooth glass returns the beam to where it comes from. No point that asks finds such light, which meets
// nothing but smooth surfaces: it is left out. The pulse has its record.
TEST(LidarExtremes, ARetroReflectorIsLeftOut) {
  const double s = 2;
  const auto scene =
      scene_of({mesh_of({{0, 0, 0}, {s, 0, 0}, {0, s, 0}, {0, 0, s}}, {0, 1, 2, 0, 2, 3, 0, 3, 1, 1, 3, 2}, 0)},
               {material("glass", {"dielectric", {}, {{"index", Curve::constant(1.5)}}, {}, nullptr})});
  for (const StartFrom from : {StartFrom::laser, StartFrom::receiver}) {
    DownLidar lidar(1000);
    lidar.laser.beam.full_angle_1_e2 = 1e-3;
    lidar.receiver.field_of_view = 2e-3;
    lidar.gate_of(990, 1010, 1e-9);
    lidar.start_from = from;
    const Received got = receive(scene, lidar);
    EXPECT_EQ(got.total().photons, 0);
    ASSERT_EQ(got.blocks.size(), 1u);
    EXPECT_EQ(got.blocks[0].row_count(), 1u);
  }
}

TEST(LidarExtremes, AMillionBins) {
  DownLidar lidar(1000);
  lidar.laser.beam.full_angle_1_e2 = 1e-3;
  lidar.receiver.field_of_view = 2e-3;
  lidar.gate_of(990, 990 + 149.8, 1e-12);
  const Received got = receive(plate(0.3), lidar);
  EXPECT_GT(got.head.bins, 900000u);
  EXPECT_GT(got.total().photons, 0);
  lidar.gate_of(0, 1e6, 1e-13);
  EXPECT_NE(message_of([&] { receive(plate(0.3), lidar); }).find("range bins, at most 1e8"), std::string::npos);
}

TEST(LidarErrors, FaultsAreTold) {
  DownLidar lidar(1000);
  lidar.gate_of(990, 1010, 1e-9);
  lidar.receiver.aperture = 0;
  EXPECT_NE(message_of([&] { receive(plate(0.3), lidar); }).find("aperture"), std::string::npos);
  lidar.receiver.aperture = 0.1;
  lidar.laser.beam.kind = BeamProfile::Kind::image;
  EXPECT_NE(message_of([&] { receive(plate(0.3), lidar); }).find("beam's image"), std::string::npos);
  lidar.laser.beam.kind = BeamProfile::Kind::gaussian;
  lidar.receiver.columns = 4;
  EXPECT_NE(message_of([&] { receive(plate(0.3), lidar); }).find("an array needs rows"), std::string::npos);
  lidar.receiver.rows = 4, lidar.receiver.pitch = 1e-5, lidar.receiver.focal = 0.1, lidar.receiver.columns = 4000000;
  EXPECT_NE(message_of([&] { receive(plate(0.3), lidar); }).find("at most 1e7"), std::string::npos);
  lidar.receiver.columns = 0;
  lidar.laser.stokes = {1, 1, 0, 0};
  EXPECT_NE(message_of([&] { receive(plate(0.3), lidar); }).find("polarisation is not traced"), std::string::npos);
  lidar.laser.stokes = {1, 0, 0, 0};
  lidar.tags = {"roof"};
  EXPECT_NE(message_of([&] { receive(plate(0.3), lidar); }).find("no tag and no material 'roof'"), std::string::npos);
  lidar.tags.clear();
  TraceOptions options;
  options.scrambles = 1;
  EXPECT_NE(message_of([&] { receive(plate(0.3), lidar, {}, options); }).find("2 to 64"), std::string::npos);
}

}  // namespace
}  // namespace suite::test
