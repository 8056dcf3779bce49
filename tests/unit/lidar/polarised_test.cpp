// Polarised lasers and analysers against closed forms.
#include <gtest/gtest.h>

#include "lidar/ends.h"
#include "math/instrument_frame.h"
#include "optics/fresnel_mueller.h"
#include "optics/models.h"
#include "tests/support/lidar_kit.h"

namespace suite::test::polarised_test {
namespace {

using enum Analyser;

std::shared_ptr<Scene> gas(const ModelSpec& phase, double thickness = 5, double scattering = 0.02) {
  return slab_scene(medium(Curve::constant(0), Curve::constant(scattering), phase), thickness);
}

ModelSpec rayleigh(double depolarisation) {
  return {"rayleigh", {{"depolarisation", depolarisation}}, {}, {}, nullptr};
}

DownLidar above(double height, const std::array<double, 4>& stokes, std::vector<Analyser> analysers) {
  DownLidar lidar(height, 16);
  lidar.laser.beam.full_angle_1_e2 = 1e-4;
  lidar.receiver.field_of_view = 2e-4;
  lidar.laser.stokes = stokes;
  lidar.receiver.analysers = std::move(analysers);
  lidar.gate_of(height - 8, height + 1, 1e-9);
  lidar.orders = 1, lidar.paths = 64;
  return lidar;
}

// Photons of channel 2 + a over those of all light.
double share(const Received& got, int a) { return got.total(2 + a).photons / got.total().photons; }

// Molecules with a depolarisation factor of 0.0279: P11 = 1.4793629, P22 = 1.4380887, P44 = -1.3968139 straight back,
// so that (P11 - P22) / (P11 + P22) = 0.0141474 of a linear laser comes back crossed, and (P11 + P44) / (P11 - P44) =
// 0.0287009 of a circular one with the turn kept. (Q, U and V of what comes back: U and V turn the other way.)
TEST(LidarPolarised, MoleculesDepolarise) {
  const auto scene = gas(rayleigh(0.0279));
  const double linear = 0.0141474, circular = 0.0287009;
  for (const double turn : {0.0, 0.4, 2.0}) {
    DownLidar lidar = above(100, {1, 1, 0, 0}, {linear_0, linear_90, linear_45, linear_135});
    lidar.train->like.emission.rotation = quat_about({0, 0, 1}, turn);  // both ends turn
    const Received got = receive(scene, lidar);
    EXPECT_EQ(got.head.channels[2], "linear_0");
    EXPECT_FALSE(got.report.laser_first);
    EXPECT_NEAR(share(got, 1) / share(got, 0), linear, 1e-6) << turn;
    EXPECT_NEAR(share(got, 0) + share(got, 1), 1, 1e-9);
    EXPECT_NEAR(share(got, 2), 0.5, 1e-4);
    EXPECT_NEAR(share(got, 3), 0.5, 1e-4);
    EXPECT_EQ(got.report.unknown_polarisation, 0);
  }
  const Received got = receive(scene, above(100, {1, 0, 0, 1}, {circular_plus, circular_minus}));
  EXPECT_NEAR(share(got, 0) / share(got, 1), circular, 1e-6);
  const Received plus = receive(scene, above(100, {1, 0, 1, 0}, {linear_45, linear_135}));
  EXPECT_NEAR(share(plus, 0) / share(plus, 1), linear, 1e-6)
      << "+U of light that goes down lies between x and -y, which is 135 degrees as the receiver counts";
}

// Small spheres keep linear light as it is and turn circular light round.
TEST(LidarPolarised, SpheresDoNot) {
  const auto scene = gas(rayleigh(0));
  const Received linear = receive(scene, above(100, {1, 1, 0, 0}, {linear_0, linear_90}));
  EXPECT_NEAR(share(linear, 1), 0, 1e-7);
  const Received circular = receive(scene, above(100, {1, 0, 0, 1}, {circular_plus, circular_minus}));
  EXPECT_NEAR(share(circular, 0), 0, 1e-7);
  // A laser that is turned by 30 degrees about its axis: cos^2 of it gets through.
  DownLidar turned = above(100, {1, 1, 0, 0}, {linear_0, linear_90});
  turned.laser.offset = {quat_about({0, 0, 1}, 30 * kDegree), {}};
  EXPECT_NEAR(share(receive(scene, turned), 0), 0.75, 1e-6);
  // Not polarised: halves.
  EXPECT_NEAR(share(receive(scene, above(100, {1, 0, 0, 0}, {linear_0})), 0), 0.5, 1e-6);
}

// What paints and unknown phase functions send back is not polarised; the latter is told.
TEST(LidarPolarised, OthersDepolarise) {
  const auto plate = scene_of({quad(100, 0, 0)}, {material("plate", lambert(0.3))});
  const Received painted = receive(plate, above(100, {1, 1, 0, 0}, {linear_0, linear_90}));
  EXPECT_NEAR(share(painted, 0), 0.5, 1e-9);
  EXPECT_EQ(painted.report.unknown_polarisation, 0);
  DownLidar plain = above(100, {1, 1, 0, 0}, {});
  plain.laser.stokes = {1, 0, 0, 0}, plain.start_from = StartFrom::receiver;
  EXPECT_NEAR(painted.total().photons, receive(plate, plain).total().photons, 1e-6 * painted.total().photons);
}

// A laser at a slant, rough metal under flat water, and back the same way: with T the Fresnel matrices of the surface
// and M that of the metal, the receiver gets T(up) M T(down) S. The surface alone makes 3 % of Q of unpolarised light
// on each way at 55 degrees: what leaves T out is wrong by as much.
TEST(LidarPolarised, WaterBendsWaysAndKeepsTheirPolarisation) {
  const double n = 1.33, slant = 55 * kDegree, inside = std::asin(std::sin(slant) / n), height = 100, depth = 2;
  const ModelSpec metal{
      "ggx", {{"roughness", 0.4}}, {{"n", Curve::constant(1.2)}, {"k", Curve::constant(1)}}, {}, nullptr};
  auto scene = std::make_shared<Scene>();
  scene->materials = {material("bed", metal),
                      material("water", {"dielectric", {}, {{"index", Curve::constant(n)}}, {}, nullptr})};
  place(*scene, PrimitiveKind::plane, {0, 0}, 0, translation({0, 0, -depth}));
  place(*scene, PrimitiveKind::plane, {0, 0}, 1);
  check_scene(*scene, "pond");
  const Stokes sent{1, 0.6, 0.5, 0.6};
  DownLidar lidar =
      above(height, {1, 0.6, 0.5, 0.6}, {linear_0, linear_90, linear_45, linear_135, circular_plus, circular_minus});
  lidar.train->like.emission.rotation = quat_about(normalized(Vec3{1, 0.4, 0}), slant);
  const double range = height / std::cos(slant) + depth * n / std::cos(inside);
  lidar.gate_of(range - 1, range + 1, 1e-9);

  const Vec3 x = rotate(lidar.train->like.emission.rotation, {1, 0, 0});
  const Dir down = rotate(lidar.train->like.emission.rotation, {0, 0, -1}), up = -down;
  const Dir seen = dir_from_angles(inside, std::atan2(up.y, up.x));  // from the bed, both ways
  const ModelSpec bed = scene->materials[0].surface;
  const SpectralState state = make_state(one_band(), 0.01);
  std::vector<Mueller> M(state.size());
  bake(bed, state)->mueller(seen, seen, M);
  const auto over = [](PlaneBlocks b) { return (b * (1 / b.a)).matrix(); };
  const Mueller in = over(fresnel_transmission(std::cos(slant), n)),
                out = over(fresnel_transmission(std::cos(inside), 1 / n));
  const Mueller from_laser = frame_rotation(frame_about(down, x), meridian_frame(down).e1),
                to_receiver = frame_rotation(meridian_frame(up), frame_about(up, x).e1);
  const Stokes got = to_receiver * (out * (M[0] * (in * (from_laser * sent)))),
               straight = to_receiver * (M[0] * (from_laser * sent));
  const Received seen_back = receive(scene, lidar);
  ASSERT_GT(seen_back.total().photons, 0);
  EXPECT_GT(
      std::fabs(got[1] / got[0] - straight[1] / straight[0]) + std::fabs(got[2] / got[0] - straight[2] / straight[0]),
      0.02);
  for (int k = 0; k < 3; ++k) {
    const double along = got[static_cast<size_t>(k + 1)] / got[0];
    EXPECT_NEAR(share(seen_back, 2 * k), 0.5 * (1 + along), 1e-4) << k;
    EXPECT_NEAR(share(seen_back, 2 * k + 1), 0.5 * (1 - along), 1e-4) << k;
  }
}

// Of all orders, a medium that depolarises sends what it sends without polarisation; and molecules that are crossed in
// single scattering hardly at all are so more and more in further orders.
TEST(LidarPolarised, FurtherOrders) {
  const auto wide = [](DownLidar lidar) {
    lidar.laser.beam.full_angle_1_e2 = 0.1, lidar.receiver.field_of_view = 0.5;
    lidar.gate_of(1, 20, 4e-9);
    lidar.orders = 6, lidar.paths = 256, lidar.train->count = 64;
    return lidar;
  };
  const auto fog = gas(hg(0.3), 6, 0.3);
  const Received with = receive(fog, wide(above(10, {1, 1, 0, 0}, {linear_0, linear_90})));
  DownLidar plain = wide(above(10, {1, 0, 0, 0}, {}));
  plain.start_from = StartFrom::receiver;
  const Received without = receive(fog, plain);
  for (const int channel : {int(kSingle), int(kMultiple)}) {
    const auto a = with.total(channel), b = without.total(channel);
    EXPECT_NEAR(a.photons, b.photons, 4 * std::hypot(a.error(), b.error())) << channel;
  }
  EXPECT_GT(with.report.unknown_polarisation, 0.1);
  DownLidar lidar = wide(above(10, {1, 1, 0, 0}, {linear_0, linear_90}));
  const auto air = gas(rayleigh(0), 6, 0.3);
  lidar.orders = 1;
  const Received once = receive(air, lidar);
  lidar.orders = 6;
  const Received often = receive(air, lidar);
  EXPECT_LT(share(once, 1), 1e-3);
  EXPECT_GT(often.total(3).photons - 4 * often.total(3).error(), 0.03 * often.total(kMultiple).photons);
  EXPECT_LT(often.total(3).photons, 0.5 * often.total(kMultiple).photons);
}

}  // namespace
}  // namespace suite::test::polarised_test
