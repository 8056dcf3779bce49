// Leaves that fill space as matter let out what they let in: the ground's return and the canopy's against closed forms
// and against leaves one by one.
#include <gtest/gtest.h>

#include "tests/support/lidar_kit.h"

namespace suite::test {
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

// Leaves one by one: disks of 2 cm radius, lit and seen from one place. The mean over canopies of what the ground
// returns is exp(-t) to the same accuracy, by the same visibility on both ways.
TEST(HotSpot, SingleLeavesAreTheSameOnAverage) {
  RunningStats ground_return;
  for (uint64_t canopy = 0; canopy < 64; ++canopy) {
    Pcg32 random(canopy + 1);
    auto scene = std::make_shared<Scene>();
    scene->materials = {material("soil", lambert(0.2)), material("leaf", lambert(0))};
    scene->meshes = {quad(1000, 0, 0)};
    scene->groups.push_back({"root", {}});
    Placement soil;
    scene->groups[0].placements.push_back(soil);
    const double radius = 0.03, half = 0.3;  // the spot is 0.1 m wide, its edges are covered from all sides
    const auto leaves = static_cast<int>(kIndex * 4 * half * half / (kPi * radius * radius) + random.uniform());
    for (int i = 0; i < leaves; ++i) {
      const Vec3 at{half * (2 * random.uniform() - 1), half * (2 * random.uniform() - 1),
                    0.1 + kTop * random.uniform()};
      const Dir n = uniform_sphere({random.uniform(), random.uniform()});
      const Vec3 axis = cross({0, 0, 1}, n);
      const double s = length(axis);
      const Affine3 turn = s > 0 ? rotation(axis / s, angle_between({0, 0, 1}, n)) : Affine3{};
      place(*scene, PrimitiveKind::disk, {radius, 0}, 1, translation(at) * turn);
    }
    check_scene(*scene, "canopy");
    DownLidar lidar = over_leaves();
    lidar.train->count = 1;
    lidar.paths = 256;
    ground_return.add(ground(receive(scene, lidar), lidar).photons);
  }
  const double bare = DownLidar(kHeight).photons() * 0.2 / kPi / (kHeight * kHeight) * kPi * 0.01 / 4;
  EXPECT_NEAR(ground_return.mean(), bare * std::exp(-kProjection * kIndex), 4 * ground_return.stderr_of_mean());
  EXPECT_GT(ground_return.mean() - 4 * ground_return.stderr_of_mean(), bare * std::exp(-2 * kProjection * kIndex));
}

}  // namespace
}  // namespace suite::test
