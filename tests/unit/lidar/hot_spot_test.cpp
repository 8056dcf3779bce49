// Leaves that fill space as matter let out what they let in: the ground's return and the canopy's against closed forms
// and against leaves one by one.
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>

#include "tests/support/lidar_kit.h"

namespace suite::test::hot_spot_test {
namespace {

constexpr double kTop = 10, kHeight = 100, kIndex = 3, kProjection = 0.5, kReflectance = 0.4, kTransmittance = 0.3;

// A layer of leaves of leaf area index 3 between the ground and kTop, that lie every way alike (projection 0.5).
std::shared_ptr<Scene> matter_of_leaves(const std::string& phase) {
  const double extinction = kProjection * kIndex / kTop, albedo = kReflectance + kTransmittance;
  ModelSpec how = hg(0);
  if (phase == "leaves") how = {"leaves", {}, {{"transmitted", Curve::constant(kTransmittance / albedo)}}, {}, nullptr};
  auto scene = scene_of({quad(1000, 0, 0)}, {material("soil", lambert(0.2))});
  scene->materials.push_back(boundary(0));
  scene->media = {medium(Curve::constant(extinction * (1 - albedo)), Curve::constant(extinction * albedo), how)};
  place(*scene, PrimitiveKind::plane, {0, 0}, 1, translation({0, 0, kTop}));
  check_scene(*scene, "leaves");
  return scene;
}

DownLidar over_leaves() {
  DownLidar lidar(kHeight, 64);
  lidar.laser.beam.full_angle_1_e2 = 1e-3;
  lidar.receiver.field_of_view = 3e-3;
  lidar.gate_of(kHeight - kTop - 1, kHeight + 1, 1e-10);
  lidar.paths = 256, lidar.orders = 1;
  return lidar;
}

Received::Sum ground(const Received& r, const DownLidar& lidar) {
  return r.sum([&](uint32_t b) {
    return b > 0 && std::fabs(lidar.gate.start + (b - 0.5) * lidar.gate.bin - 2 * kHeight / kSpeedOfLight) < 1.5e-10;
  });
}

// exp(-G LAI) = 0.223 through leaves, exp(-2 G LAI) = 0.050 through drops.
TEST(HotSpot, GroundUnderLeavesIsSeenByTheWayIn) {
  for (const StartFrom from : {StartFrom::laser, StartFrom::receiver})
    for (const bool leaves : {true, false}) {
      DownLidar lidar = over_leaves();
      lidar.start_from = from;
      const Received got = receive(matter_of_leaves(leaves ? "leaves" : "drops"), lidar);
      const auto seen = ground(got, lidar);
      const double bare = 64 * lidar.photons() * 0.2 / kPi / (kHeight * kHeight) * kPi * 0.01 / 4;
      const double depth = kProjection * kIndex;
      // What fills the last 2 cm comes back with it.
      const double expected = bare * std::exp(-(leaves ? 1 : 2) * depth);
      EXPECT_NEAR(seen.photons, expected, 4 * seen.error() + 0.01 * expected) << leaves;
      EXPECT_LT(seen.error(), 0.06 * expected);
    }
}

// The canopy's own return: (1 - exp(-t)) over (1 - exp(-2 t)) / 2 of what drops of the same phase function send: 0.777
// against 0.475 times the backscattering per depth.
TEST(HotSpot, LeavesReturnMoreThanDrops) {
  DownLidar lidar = over_leaves();
  const auto scene = matter_of_leaves("leaves");
  const Received got = receive(scene, lidar);
  const auto all = got.total(), soil = ground(got, lidar);
  float back = 0;
  {
    const SpectralState state = make_state(one_band(), 0.01, 0, 1);
    bake_phase(scene->media[0].phase, state)->eval(-1, {&back, 1});
  }
  const double depth = kProjection * kIndex, albedo = kReflectance + kTransmittance;
  const double unit = 64 * lidar.photons() * kPi * 0.01 / 4 * albedo * back;
  // With 1 / R^2 over the canopy.
  double integral = 0;
  const int n = 10000;
  for (int i = 0; i < n; ++i) {
    const double x = (i + 0.5) / n, R = kHeight - kTop + kTop * x;
    if (R < kHeight - 0.02) integral += std::exp(-depth * x) * depth / n / (R * R);
  }
  EXPECT_NEAR(all.photons - soil.photons, unit * integral, 0.01 * unit * integral);
}

// Leaves one by one over soil, disks that lie every way alike from kLow to kLow + kTop, as many as kIndex asks for.
constexpr double kLow = 0.1;
std::shared_ptr<Scene> single_leaves(uint64_t seed, double radius, double half, const ModelSpec& leaf) {
  Pcg32 random(seed);
  auto scene = std::make_shared<Scene>();
  scene->materials = {material("soil", lambert(0.2)), material("leaf", leaf)};
  // Hits are known to 1e-7 of what they lie on. A ground of 1 km moves the way back by 0.1 mm off the way out, and of
  // 1e4 leaves a square metre some edges lie between them: 3 % of the canopy's light would be lost.
  scene->meshes = {quad(5, 0, 0)};
  scene->groups.push_back({"root", {}});
  scene->groups[0].placements.push_back({});
  const auto leaves = static_cast<int>(kIndex * 4 * half * half / (kPi * radius * radius) + random.uniform());
  for (int i = 0; i < leaves; ++i) {
    const Vec3 at{half * (2 * random.uniform() - 1), half * (2 * random.uniform() - 1), kLow + kTop * random.uniform()};
    const Dir n = uniform_sphere({random.uniform(), random.uniform()});
    const Vec3 axis = cross({0, 0, 1}, n);
    const double s = length(axis);
    const Affine3 turn = s > 0 ? rotation(axis / s, angle_between({0, 0, 1}, n)) : Affine3{};
    place(*scene, PrimitiveKind::disk, {radius, 0}, 1, translation(at) * turn);
  }
  check_scene(*scene, "canopy");
  return scene;
}

// The mean over canopies of what the ground returns is exp(-t) to the same accuracy, by the same visibility on both
// ways.
TEST(HotSpot, SingleLeavesAreTheSameOnAverage) {
  RunningStats ground_return;
  for (uint64_t canopy = 1; canopy <= 64; ++canopy) {
    DownLidar lidar = over_leaves();
    lidar.train->count = 1;
    // The spot is 0.1 m wide, its edges are covered from all sides.
    ground_return.add(ground(receive(single_leaves(canopy, 0.03, 0.3, lambert(0)), lidar), lidar).photons);
  }
  const double bare = DownLidar(kHeight).photons() * 0.2 / kPi / (kHeight * kHeight) * kPi * 0.01 / 4;
  EXPECT_NEAR(ground_return.mean(), bare * std::exp(-kProjection * kIndex), 4 * ground_return.stderr_of_mean());
  EXPECT_GT(ground_return.mean() - 4 * ground_return.stderr_of_mean(), bare * std::exp(-2 * kProjection * kIndex));
}

// The same leaves as matter, from kLow to kLow + kTop.
std::shared_ptr<Scene> layer_of_leaves(const std::string& phase) {
  const std::shared_ptr<Scene> like = matter_of_leaves(phase);
  auto scene = scene_of({quad(1000, 0, 0)}, {like->materials[0]});
  Medium nothing;
  nothing.id = "void";
  nothing.priority = 1;
  scene->media = {like->media[0], nothing};
  scene->materials.push_back(boundary(0)), scene->materials.push_back(boundary(1));
  place(*scene, PrimitiveKind::plane, {0, 0}, 1, translation({0, 0, kLow + kTop}));
  place(*scene, PrimitiveKind::plane, {0, 0}, 2, translation({0, 0, kLow}));
  check_scene(*scene, "layer");
  return scene;
}

// 64 random canopies of leaves one by one against the same as matter, under a spot of 1 m: what the ground returns and
// what the leaves return, within 2 % and 4 sigma. Negative control: drops of the same depth. SUITE_PROFILE=FILE keeps
// the mean waveforms (docs/theory/laser_pulses.md).
TEST(HotSpot, CanopiesOfSingleLeavesAreMatterOfLeavesOnAverage) {
  if (!std::getenv("SUITE_LONG")) GTEST_SKIP() << "in the long run";
  const auto wide = [](uint64_t pulses, uint32_t paths) {
    DownLidar lidar = over_leaves();
    lidar.train->count = pulses, lidar.paths = paths;
    lidar.laser.beam.kind = BeamProfile::Kind::top_hat;
    lidar.laser.beam.half_angle = 0.5 / kHeight;
    lidar.receiver.field_of_view = 2.5 * 0.5 / kHeight;
    return lidar;
  };
  RunningStats soil[3], leaves[3];
  std::vector<double> profile[3];
  const auto take = [&](int which, const Received& got, const DownLidar& lidar) {
    const size_t channels = got.head.channels.size();
    profile[which].resize(got.head.bins + 1);
    for (const ResponseBlock& b : got.blocks)
      for (size_t r = 0; r < b.row_count(); ++r) {
        double low = 0, high = 0;
        for (uint64_t e = b.begin[r]; e < b.begin[r + 1]; ++e) {
          const double t = lidar.gate.start + (b.bin[e] - 0.5) * lidar.gate.bin, v = b.value[e * channels];
          (std::fabs(t - 2 * kHeight / kSpeedOfLight) < 3e-10 ? low : high) += v;
          profile[which][b.bin[e]] += v / 64;
        }
        soil[which].add(low), leaves[which].add(high);
      }
  };
  const ModelSpec leaf = lambert(kReflectance, kTransmittance);
  for (uint64_t canopy = 1; canopy <= 64; ++canopy) {
    const DownLidar one = wide(1, 4096);
    take(0, receive(single_leaves(canopy, 0.01, 0.56, leaf), one), one);
  }
  const DownLidar many = wide(64, 2048);
  take(1, receive(layer_of_leaves("leaves"), many), many);
  take(2, receive(layer_of_leaves("drops"), many), many);
  for (const auto* part : {soil, leaves}) {
    const double error = std::hypot(part[0].stderr_of_mean(), part[1].stderr_of_mean());
    std::printf("%s: leaves one by one %.5g +- %.2g, as matter %.5g +- %.2g (%+.2f %%), as drops %.5g\n",
                part == soil ? "ground" : "canopy", part[0].mean(), part[0].stderr_of_mean(), part[1].mean(),
                part[1].stderr_of_mean(), 100 * (part[1].mean() / part[0].mean() - 1), part[2].mean());
    EXPECT_NEAR(part[1].mean(), part[0].mean(), std::min(0.02 * part[0].mean(), 4 * error));
    EXPECT_LT(4 * error, 0.02 * part[0].mean()) << "the bound is that of the noise";
    EXPECT_GT(std::fabs(part[2].mean() - part[0].mean()), 0.2 * part[0].mean());
  }
  if (const char* file = std::getenv("SUITE_PROFILE")) {
    std::ofstream out(file);
    out << "range_m,single_leaves,leaves_as_matter,drops\n";
    for (size_t bin = 1; bin < profile[0].size(); ++bin)
      out << (many.gate.start + (static_cast<double>(bin) - 0.5) * many.gate.bin) * kSpeedOfLight / 2 << ','
          << profile[0][bin] << ',' << profile[1][bin] << ',' << profile[2][bin] << '\n';
  }
}

}  // namespace
}  // namespace suite::test::hot_spot_test
