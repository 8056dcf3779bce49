// Pulses over surfaces against closed forms: energy, arrival, shape.
#include <gtest/gtest.h>

#include "tests/support/lidar_kit.h"

namespace suite::test {
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

}  // namespace
}  // namespace suite::test
