// The Moon's disk with its phase: the law of Lommel and Seeliger in closed form, and the same light as the even disk.
#include "light/kinds/phased_disk.h"

#include <gtest/gtest.h>

#include <cmath>

namespace suite::test::phased_disk_test {
namespace {

constexpr double kHalf = 0.26 * kDegree;
SpectralState state() { return make_state(std::vector<Band>{Band::rectangular("b", 0.55, 0.01)}, 0.01); }
// Towards the zenith; x, y: in the disk of radius 1.
Dir at(double x, double y) {
  const double s = std::sin(kHalf);
  return {x * s, y * s, std::sqrt(1 - s * s * (x * x + y * y))};
}
// Waning or waxing, the Sun towards the east (x) of it, by a phase angle (rad).
PhasedDisk moon(double phase, double even = 0) {
  FarDisk disk;
  disk.half_angle = kHalf, disk.irradiance = Curve::constant(2e-3);
  return PhasedDisk(disk, {std::sin(phase), 0, -std::cos(phase)}, even, state());
}
double mean(const PhasedDisk& disk) {
  double sum = 0;
  constexpr int n = 400;
  for (int i = 0; i < n; ++i)
    for (int k = 0; k < n; ++k) {
      const double r = std::sqrt((i + 0.5) / n), turn = 2 * kPi * (k + 0.3) / n;
      sum += disk.shade(at(r * std::cos(turn), r * std::sin(turn)));
    }
  return sum / (n * n);
}

TEST(PhasedDisk, KeepsItsLight) {
  for (const double degrees : {0.0, 30.0, 90.0, 150.0}) EXPECT_NEAR(mean(moon(degrees * kDegree)), 1, 2e-3) << degrees;
  EXPECT_NEAR(mean(moon(kPi / 2, 0.3)), 1, 2e-3);
}

TEST(PhasedDisk, LommelAndSeeliger) {
  // The full Moon is as bright at its limb as in the middle.
  for (const double r : {0.0, 0.5, 0.99}) EXPECT_NEAR(moon(0).shade(at(r, 0)), 1, 1e-6);
  const PhasedDisk half = moon(kPi / 2);
  const auto law = [](double x) { return x / (x + std::sqrt(1 - x * x)); };
  EXPECT_NEAR(half.shade(at(0.5, 0)) / half.shade(at(0.8, 0)), law(0.5) / law(0.8), 1e-5);
  EXPECT_EQ(half.shade(at(-0.01, 0)), 0);
  EXPECT_GT(half.shade(at(0.01, 0)), 0);
  EXPECT_EQ(half.shade(at(1.01, 0)), 0);
  // Earthshine is even, also where nothing else is.
  EXPECT_NEAR(moon(kPi / 2, 0.3).shade(at(-0.5, 0.2)), 0.3, 1e-12);
  EXPECT_NEAR(moon(kPi, 0.3).shade(at(0.5, 0.2)), 1, 1e-12) << "new Moon: nothing else is lit";
}

TEST(PhasedDisk, SamplesCarryIt) {
  const PhasedDisk disk = moon(2);
  double sum = 0;
  constexpr int n = 256;
  for (int i = 0; i < n; ++i)
    for (int k = 0; k < n; ++k)
      if (const auto s = disk.sample({}, {(i + 0.5) / n, (k + 0.5) / n, 0, 0}, 0)) {
        EXPECT_NEAR(s->scale, disk.shade(s->direction), 1e-12);
        sum += s->scale / (n * n);
      }
  EXPECT_NEAR(sum, 1, 2e-3);
}

}  // namespace
}  // namespace suite::test::phased_disk_test
