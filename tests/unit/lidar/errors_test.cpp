// Errors of range bins, and extreme cases with a documented outcome.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include "math/sampling.h"
#include "motion/track.h"
#include "tests/support/lidar_kit.h"
#include "tests/support/message_of.h"

namespace suite::test::errors_test {
namespace {

std::shared_ptr<Scene> plate(double reflectance, double half = 1000) {
  return scene_of({quad(half, 0, 0)}, {material("plate", lambert(reflectance))});
}

// Over many rows, each an experiment of its own: how often the 95 % interval of a bin holds the mean of all rows. Of
// all light and of both channels apart, bins with at least 30 contributions.
struct Covered {
  int intervals = 0, held = 0, student = 0;  // student: by so many standard errors to either side
  double share() const { return static_cast<double>(held) / intervals; }
};
enum class Of { all_light, single, multiple };
Covered covered(const Received& got, Of what) {
  const size_t channels = got.head.channels.size(), c = what == Of::multiple ? kMultiple : kSingle;
  std::map<uint32_t, RunningStats> truth;
  size_t rows = 0;
  for (const ResponseBlock& b : got.blocks) {
    rows += b.row_count();
    for (size_t e = 0; e < b.entries(); ++e)
      truth[b.bin[e]].add(what == Of::all_light ? b.value[e * channels] + b.value[e * channels + 1]
                                                : b.value[e * channels + c]);
  }
  const double t = student_t_quantile(0.95, got.head.scrambles - 1);
  Covered n;
  for (const ResponseBlock& b : got.blocks)
    for (size_t r = 0; r < b.row_count(); ++r) {
      const ResponseRow row(got.head, b, r);
      for (size_t k = 0; k < row.size(); ++k) {
        const RunningStats& all = truth[row.bin(k)];
        if (row.contributions(k) < 30 || all.n() < rows || !(all.variance() > 1e-12 * all.mean() * all.mean()))
          continue;
        const bool light = what == Of::all_light;
        if (!light && !(row.variance(k, c) > 0)) continue;
        const BinInterval i = light ? row.photon_interval(k) : row.interval(k, c);
        const double value = light ? row.photons(k) : row.value(k, c),
                     error = std::sqrt(light ? row.photon_variance(k) : row.variance(k, c));
        ++n.intervals;
        n.held += i.low <= all.mean() && all.mean() <= i.high;
        n.student += std::fabs(value - all.mean()) <= t * error;
      }
    }
  return n;
}

std::shared_ptr<Scene> room() {
  return scene_of({box({-6, -5, 0}, {5, 6, 12}, 0, false), box({-0.5, -0.3, 0}, {0.2, 0.3, 2}, 0, true)},
                  {material("wall", lambert(0.6))});
}

// Disks of 15 cm radius over soil.
std::shared_ptr<Scene> leaves() {
  auto scene = scene_of({quad(1000, 0, 0)}, {material("soil", lambert(0.3)), material("leaf", lambert(0.45, 0.4))});
  Pcg32 random(5);
  for (int i = 0; i < 600; ++i) {
    const Vec3 at{6 * random.uniform() - 3, 6 * random.uniform() - 3, 1 + 8 * random.uniform()};
    const Dir n = uniform_sphere({random.uniform(), random.uniform()});
    const Vec3 axis = cross({0, 0, 1}, n);
    const double s = length(axis);
    const Affine3 turn = s > 0 ? rotation(axis / s, angle_between({0, 0, 1}, n)) : Affine3{};
    place(*scene, PrimitiveKind::disk, {0.15, 0}, 1, translation(at) * turn);
  }
  check_scene(*scene, "leaves");
  return scene;
}

DownLidar over_leaves(uint64_t pulses, uint32_t paths) {
  DownLidar lidar(60, pulses);
  lidar.laser.beam.full_angle_1_e2 = 0.02;
  lidar.receiver.field_of_view = 0.04, lidar.receiver.aperture = 0.2;
  lidar.gate_of(45, 75, 2e-9);
  lidar.paths = paths;
  return lidar;
}

DownLidar in_room(uint64_t pulses, uint32_t paths, double bin) {
  DownLidar lidar(10, pulses);
  lidar.laser.beam.full_angle_1_e2 = 0.1;
  lidar.receiver.field_of_view = 0.4;
  lidar.paths = paths, lidar.orders = 4;
  lidar.gate_of(0, 20, bin);
  return lidar;
}

// With n intervals of 95 % the share has a standard deviation of sqrt(0.05 0.95 / n), times some for bins that share
// paths; thousands of intervals are compared. Multiple scattering is so skewed that Student's interval does not cover
// it (negative control).
TEST(LidarErrors, IntervalsCoverWhatTheySay) {
  const auto fog = slab_scene(medium(Curve::constant(0.05), Curve::constant(0.4), hg(0.3)), 6);
  const struct {
    const char* name;
    std::shared_ptr<Scene> scene;
    DownLidar lidar;
  } cases[] = {{"room", room(), in_room(200, 512, 4e-9)},
               {"leaves", leaves(), over_leaves(300, 256)},
               {"fog", fog, in_room(250, 512, 2e-8)}};
  for (const auto& c : cases) {
    const Received got = receive(c.scene, c.lidar);
    for (const Of what : {Of::all_light, Of::single, Of::multiple}) {
      const Covered n = covered(got, what);
      if (n.intervals < 500) continue;
      std::printf("%s %d: %.4f of %d intervals, Student's %.4f\n", c.name, static_cast<int>(what), n.share(),
                  n.intervals, static_cast<double>(n.student) / n.intervals);
      EXPECT_GT(n.share(), 0.93) << c.name << " " << n.intervals;
      EXPECT_LT(n.share(), 0.97) << c.name << " " << n.intervals;
      if (what == Of::multiple && c.scene != cases[0].scene) {
        EXPECT_LT(n.student, 0.93 * n.intervals) << c.name;
      }
    }
  }
}

// A bin that no path has reached is not known to be dark: of 100 rows in which a bin was not reached although light
// comes there, at most 5 may have more in it than the bound says. The truth is the mean of all rows.
TEST(LidarErrors, BinsThatNoPathReachedHaveABound) {
  const Received got = receive(leaves(), over_leaves(2000, 16));
  const size_t channels = got.head.channels.size();
  std::vector<double> truth(got.head.bins + 1);
  size_t rows = 0;
  for (const ResponseBlock& b : got.blocks) {
    rows += b.row_count();
    for (size_t e = 0; e < b.entries(); ++e) truth[b.bin[e]] += b.value[e * channels] + b.value[e * channels + 1];
  }
  for (double& v : truth) v /= static_cast<double>(rows);
  int dark = 0, above = 0, flagged = 0;
  for (const ResponseBlock& b : got.blocks)
    for (size_t r = 0; r < b.row_count(); ++r) {
      const ResponseRow row(got.head, b, r);
      for (uint32_t bin = 1; bin <= got.head.bins; ++bin) {
        const BinKnown known = row.known(bin);
        if (known.reached || !(truth[bin] > 0)) continue;
        EXPECT_EQ(known.interval.high, known.bound);
        ++dark, flagged += known.bound > 0, above += truth[bin] > known.bound;
      }
    }
  std::printf("%d bins not reached, %d with more than the bound\n", dark, above);
  EXPECT_GT(dark, 10000);
  EXPECT_EQ(flagged, dark);
  EXPECT_LT(above, 0.05 * dark);
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
// nothing but smooth surfaces: it is left out, and the report says so. The pulse has its record.
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
    EXPECT_TRUE(got.report.smooth);
    ASSERT_EQ(got.blocks.size(), 1u);
    EXPECT_EQ(got.blocks[0].row_count(), 1u);
  }
  DownLidar lidar(1000);
  lidar.laser.beam.full_angle_1_e2 = 1e-3;
  lidar.gate_of(990, 1010, 1e-9);
  EXPECT_FALSE(receive(plate(0.3), lidar).report.smooth);
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
  lidar.laser.stokes = {1, 1, 0.5, 0};
  EXPECT_NE(message_of([&] { receive(plate(0.3), lidar); }).find("Q2 + U2 + V2 at most 1"), std::string::npos);
  lidar.laser.stokes = {1, 1, 0, 0}, lidar.start_from = StartFrom::laser;
  EXPECT_NE(message_of([&] { receive(plate(0.3), lidar); }).find("begin at the receiver"), std::string::npos);
  lidar.start_from = StartFrom::automatic;
  lidar.laser.stokes = {1, 0, 0, 0};
  lidar.tags = {"roof"};
  EXPECT_NE(message_of([&] { receive(plate(0.3), lidar); }).find("no tag and no material 'roof'"), std::string::npos);
  lidar.tags.clear();
  TraceOptions options;
  options.scrambles = 1;
  EXPECT_NE(message_of([&] { receive(plate(0.3), lidar, {}, options); }).find("2 to 64"), std::string::npos);
}

}  // namespace
}  // namespace suite::test::errors_test
