#include "math/mueller.h"

#include <gtest/gtest.h>

#include "math/sampling.h"
#include "math/warps.h"

namespace suite::mueller_test {
namespace {

Dir random_direction(Pcg32& random) { return uniform_sphere({random.uniform(), random.uniform()}); }
void expect_near(const Mueller& a, const Mueller& b, double tolerance) {
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j) EXPECT_NEAR(a(i, j), b(i, j), tolerance) << i << j;
}

TEST(Mueller, MeridianFramesAreRightHandedWithTheSecondAxisHorizontal) {
  Pcg32 random(1);
  for (int n = 0; n < 100; ++n) {
    const Dir k = n < 2 ? Dir{0, 0, n ? 1.0 : -1.0} : random_direction(random);
    const PolarFrame f = meridian_frame(k);
    EXPECT_NEAR(length(cross(f.e1, f.e2) - k), 0, 1e-14);
    EXPECT_NEAR(dot(f.e1, f.e2), 0, 1e-15);
    EXPECT_EQ(f.e2.z, 0);
    if (n >= 2) {
      EXPECT_GT(dot(f.e2, cross(Vec3{0, 0, 1}, k)), 0);
    }
  }
}
TEST(Mueller, TurningAFrameTurnsTheAngleOfPolarisation) {
  // Light polarised along 30 deg from e1 towards e2 is along 10 deg in a frame that has turned by 20 deg.
  const double a = 30 * kDegree, t = 20 * kDegree;
  const Stokes s = frame_rotation(std::cos(t), std::sin(t)) * Stokes{1, std::cos(2 * a), std::sin(2 * a), 0.25};
  EXPECT_NEAR(s[1], std::cos(2 * (a - t)), 1e-15);
  EXPECT_NEAR(s[2], std::sin(2 * (a - t)), 1e-15);
  EXPECT_EQ(s[3], 0.25);
}
// A matrix told in a local frame, of either hand, is the same event in the world: what the mirrored frame sees is the
// mirror image.
TEST(Mueller, LocalFramesOfEitherHandTellTheSameEvent) {
  Pcg32 random(2);
  const PlaneBlocks metal = PlaneBlocks::of(0.9, -0.2, -0.8, 0.15);
  for (int n = 0; n < 100; ++n) {
    const Dir out = random_direction(random), in = random_direction(random);
    const Mueller world = ScatteringPlane(out, in).matrix(metal);
    Frame frame = Frame::with_tangent(random_direction(random), random_direction(random));
    expect_near(to_world(ScatteringPlane(frame.to_local(out), frame.to_local(in)).matrix(metal), frame, out, in), world,
                1e-10);
    // A plane's mirror image is the same to what lies in it, so the blocks stay as they are.
    frame.y = -frame.y;
    expect_near(to_world(ScatteringPlane(frame.to_local(out), frame.to_local(in)).matrix(metal), frame, out, in), world,
                1e-10);
  }
}
TEST(Mueller, OnlyMatricesOfThingsThatExistHaveACoherencyWithoutNegativeEigenvalues) {
  EXPECT_NEAR(least_coherency(Mueller::identity()), 0, 1e-14);
  EXPECT_NEAR(least_coherency(Mueller::depolariser()), 0.25, 1e-14);
  const Mueller mirror = ScatteringPlane({0.6, 0, 0.8}, {-0.48, 0.36, 0.8}).matrix(PlaneBlocks::of(1, 0.1, -0.9, 0.3));
  EXPECT_GT(least_coherency(mirror), -1e-12);
  // Nothing turns V alone around, and nothing polarises without weakening the other state.
  EXPECT_LT(least_coherency(Mueller::diagonal(1, 1, 1, -1)), -0.1);
  Mueller flipped = mirror;
  flipped(0, 1) = -flipped(0, 1), flipped(0, 2) = -flipped(0, 2);
  EXPECT_LT(least_coherency(flipped), -1e-3);
}
TEST(Mueller, OtherConventionsDifferBySigns) {
  const Mueller m = PlaneBlocks::of(1, -0.3, 0.2, 0.4).matrix();
  for (const StokesConvention& c : kStokesConventions) {
    expect_near(converted(converted(m, c), c), m, 0);
    EXPECT_EQ(c.signs[0], 1);
  }
  EXPECT_EQ(converted(m, kStokesConventions[1])(0, 1), 0.3);   // SCATMECH: Q
  EXPECT_EQ(converted(m, kStokesConventions[2])(2, 3), 0.4);   // Bohren & Huffman: U and V together
  EXPECT_EQ(converted(m, kStokesConventions[3])(2, 3), -0.4);  // Mitsuba: V alone
}

}  // namespace
}  // namespace suite::mueller_test
