// Whichever end paths begin at, they bring the same light; and the same as a camera and a lamp.
#include <gtest/gtest.h>

#include "light/kinds/lamps.h"
#include "tests/support/lidar_kit.h"
#include "tests/support/pipeline_kit.h"

namespace suite::test::ends_test {
namespace {

// Totals and ten parts of the gate, of both ends. Parts of less than 2 % are left out: a few paths bring them, and
// their errors are not known.
void expect_same(const std::shared_ptr<const Scene>& scene, DownLidar lidar, const std::string& what) {
  lidar.start_from = StartFrom::laser;
  const Received laser = receive(scene, lidar);
  lidar.start_from = StartFrom::receiver;
  const Received receiver = receive(scene, lidar);
  EXPECT_TRUE(laser.report.laser_first && !receiver.report.laser_first);
  const uint32_t part = laser.head.bins / 10 + 1;
  int filled = 0;
  for (uint32_t k = 0; k <= 10; ++k) {
    const auto in = [&](uint32_t b) { return b > 0 && (k == 10 || (b - 1) / part == k); };
    for (const int channel : {int(kSingle), int(kMultiple)}) {
      const auto a = laser.sum(in, channel), b = receiver.sum(in, channel);
      const double all = laser.total().photons + receiver.total().photons;
      if (a.photons + b.photons < 0.02 * all) continue;
      ++filled;
      EXPECT_NEAR(a.photons, b.photons, 4 * std::sqrt(a.variance + b.variance) + 1e-4 * a.photons)
          << what << ", part " << k << ", channel " << channel;
    }
  }
  EXPECT_GT(filled, 2) << what;
}

DownLidar wide(double height) {
  DownLidar lidar(height, 64);
  lidar.laser.beam.full_angle_1_e2 = 0.4;
  lidar.receiver.field_of_view = 0.6, lidar.receiver.aperture = 0.05;
  lidar.paths = 128, lidar.orders = 6;
  return lidar;
}

TEST(LidarEnds, AgreeInARoom) {
  DownLidar lidar = wide(3);
  lidar.gate_of(0, 20, 1e-9);
  expect_same(scene_of({box({-4, -3, 0}, {4, 3, 4}, 0, false), box({-0.5, -0.5, 0}, {0.2, 0.3, 1}, 1, true)},
                       {material("wall", lambert(0.7)), material("block", lambert(0.3))}),
              lidar, "room");
}

TEST(LidarEnds, AgreeOverLeaves) {
  Pcg32 random(5);
  std::vector<Mesh> meshes{quad(20, 0, 0)};
  std::vector<Vec3> v;
  std::vector<uint32_t> f;
  for (int leaf = 0; leaf < 400; ++leaf) {
    const Vec3 at{6 * random.uniform() - 3, 6 * random.uniform() - 3, 1 + 2 * random.uniform()};
    const Frame frame = Frame::around(uniform_sphere({random.uniform(), random.uniform()}));
    const auto n = static_cast<uint32_t>(v.size());
    for (const Vec2 q : {Vec2{-0.15, -0.15}, {0.15, -0.15}, {0.15, 0.15}, {-0.15, 0.15}})
      v.push_back(at + frame.x * q.x + frame.y * q.y);
    for (const uint32_t i : {0u, 1u, 2u, 0u, 2u, 3u}) f.push_back(n + i);
  }
  meshes.push_back(mesh_of(v, f, 1));
  DownLidar lidar = wide(10);
  lidar.gate_of(5, 14, 1e-9);
  expect_same(scene_of(std::move(meshes), {material("soil", lambert(0.2)), material("leaf", lambert(0.45, 0.4))}),
              lidar, "leaves");
}

TEST(LidarEnds, AgreeInFogOverASlab) {
  auto scene = slab_scene(medium(Curve::constant(0.02), Curve::constant(0.3), hg(0.6)), 5);
  DownLidar lidar = wide(8);
  lidar.gate_of(2, 14, 1e-9);
  expect_same(scene, lidar, "fog");
}

// Bistatic: 3 m apart, aimed at each other's spot.
TEST(LidarEnds, AgreeFromTwoPlaces) {
  DownLidar lidar = wide(5);
  lidar.laser.offset = {quat_about({0, 1, 0}, -0.3), {-1.5, 0, 0}};
  lidar.receiver.offset = {quat_about({0, 1, 0}, 0.3), {1.5, 0, 0}};
  lidar.laser.beam.full_angle_1_e2 = 0.1;
  lidar.gate_of(4, 10, 1e-9);
  auto scene = scene_of({quad(20, 0, 0), box({-0.3, -0.5, 0}, {0.4, 0.5, 1}, 1, true)},
                        {material("soil", lambert(0.5)), material("block", lambert(0.8))});
  expect_same(scene, lidar, "two places");
  // And through mist over the ground.
  scene->media = {medium(Curve::constant(0.01), Curve::constant(0.2), hg(0.3))};
  scene->materials.push_back(boundary(0));
  place(*scene, PrimitiveKind::plane, {0, 0}, 2, translation({0, 0, 2}));
  check_scene(*scene, "mist");
  expect_same(scene, lidar, "two places over mist");
}

// Water that scatters, under a flat surface that bends: manifold connections from the bed and from the water.
TEST(LidarEnds, AgreeThroughWater) {
  auto scene = std::make_shared<Scene>();
  scene->materials = {material("bed", lambert(0.4)),
                      material("water", {"dielectric", {}, {{"index", Curve::constant(1.33)}}, {}, nullptr})};
  place(*scene, PrimitiveKind::plane, {0, 0}, 0, translation({0, 0, -3}));
  place(*scene, PrimitiveKind::plane, {0, 0}, 1);
  scene->media = {medium(Curve::constant(0.05), Curve::constant(0.1), hg(0.4))};
  scene->media[0].index = Curve::constant(1.33);
  scene->materials[1].inside = 0;
  check_scene(*scene, "water");
  DownLidar lidar = wide(10);
  lidar.laser.offset = lidar.receiver.offset = {quat_about({0, 1, 0}, 0.3), {}};  // past the mirror image
  lidar.laser.beam.full_angle_1_e2 = 0.2, lidar.receiver.field_of_view = 0.3;
  lidar.gate_of(8, 20, 2e-9);
  lidar.orders = 3;
  expect_same(scene, lidar, "water");
}

// A grid of cells of different density.
TEST(LidarEnds, AgreeOverACloud) {
  Pcg32 random(3);
  auto scene = scene_with(medium(Curve::constant(0), Curve::constant(1), hg(0.7)),
                          grid_of({8, 8, 6}, translation({-4, -4, 1}), [&](uint32_t, uint32_t, uint32_t) {
                            return random.uniform() < 0.5 ? 0.6 * random.uniform() : 0;
                          }));
  scene->materials = {material("soil", lambert(0.3))};
  place(*scene, PrimitiveKind::plane, {0, 0}, 0);
  check_scene(*scene, "cloud");
  DownLidar lidar = wide(12);
  lidar.gate_of(4, 14, 2e-9);
  expect_same(scene, lidar, "cloud");
}

// A sea of slope variance s2 = 0.003 + 0.00512 U sends f cos = F_0 exp(-tan^2 a / s2) / (4 pi s2 cos^5 a) straight back
// (Cox & Munk 1954), whichever end begins: U = 7 m/s, n = 1.338.
TEST(LidarEnds, TheSeaSendsItsGlitterBack) {
  auto scene = std::make_shared<Scene>();
  scene->materials = {
      material("sea", {"sea", {{"wind_m_s", 7}, {"whitecaps", 0}}, {{"index", Curve::constant(1.338)}}, {}, nullptr})};
  place(*scene, PrimitiveKind::plane, {0, 0}, 0);
  check_scene(*scene, "sea");
  const double H = 1000;
  for (const auto& [angle, expected] :
       {std::pair{0.0, 0.042821}, {3.0, 0.040172}, {10.0, 0.020761}, {20.0, 0.0019295}}) {
    const double R = H / std::cos(angle * kDegree);
    for (const StartFrom from : {StartFrom::laser, StartFrom::receiver}) {
      DownLidar lidar(H, 8);
      lidar.laser.offset = lidar.receiver.offset = {quat_about({0, 1, 0}, angle * kDegree), {}};
      lidar.laser.beam.full_angle_1_e2 = 1e-4;
      lidar.receiver.field_of_view = 2e-3;
      lidar.gate_of(R - 10, R + 10, 1e-9);
      lidar.orders = 1, lidar.start_from = from;
      const double unit = lidar.photons() * kPi * lidar.receiver.aperture * lidar.receiver.aperture / 4 / (R * R);
      EXPECT_NEAR(receive(scene, lidar).rows().mean() / unit, expected, 0.01 * expected) << angle;
    }
  }
}

// A spot of the same angle and power as a top hat of one joule, a camera of one pixel: the sum over all range bins.
// (The beam is even over the plane, the spot over the sphere: they differ by 1.5 % at the edge.)
void expect_steady_image(const std::shared_ptr<const Scene>& scene, double least_multiple) {
  const double half = 0.1, height = 3;
  DownLidar lidar = wide(height);
  lidar.laser.beam.kind = BeamProfile::Kind::top_hat;
  lidar.laser.beam.half_angle = half;
  lidar.receiver.field_of_view = 0.02;
  lidar.orders = 1000;
  lidar.gate_of(0, 3000, 1e-6);
  const Received got = receive(scene, lidar);
  EXPECT_FALSE(got.report.laser_first);
  LampSpec lamp;
  lamp.name = "spot", lamp.kind = LampSpec::Kind::spot;
  lamp.positions = {{0, 0, height}};
  lamp.inner = lamp.outer = half;
  lamp.intensity = Curve::constant(1 / (kPi * std::tan(half) * std::tan(half)));
  SourceSpecs sources;
  sources.add(lamp);
  const Seen seen = see(scene, sources, RaySensor(repeated({{0, 0, height}, {0, 0, -1}, 0}), one_band(), 1024));
  RunningStats radiance;
  for (const double L : seen.radiance) radiance.add(L);
  const double solid = 2 * kPi * (1 - std::cos(0.01)), area = kPi * 0.05 * 0.05 / 4;
  const double image = radiance.mean() * solid * area * lidar.photons();
  const RunningStats rows = got.rows();
  const double error = std::hypot(rows.stderr_of_mean(), image * radiance.stderr_of_mean() / radiance.mean());
  EXPECT_NEAR(rows.mean(), image, 3 * error + 2e-3 * image);
  EXPECT_LT(error, 0.01 * image);
  EXPECT_GT(got.total(kMultiple).photons, least_multiple * got.total().photons);
}

TEST(LidarEnds, SumsOfRangeBinsAreTheSteadyImage) {
  expect_steady_image(scene_of({box({-4, -3, 0}, {4, 3, 4}, 0, false)}, {material("wall", lambert(0.6))}), 0.001);
}

}  // namespace
}  // namespace suite::test::ends_test
