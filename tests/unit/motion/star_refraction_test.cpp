// Refraction from anywhere: on the ground as ERFA has it, along the limb as an integral over the ray.
#include "motion/star_refraction.h"

#include <gtest/gtest.h>

#include <cmath>

namespace suite::test::star_refraction_test {
namespace {

constexpr double kArcSecond = kDegree / 3600;
constexpr Geodetic kSites[] = {{49.4, 8.7, 120}, {-24.6, -70.4, 2635}, {78.2, 15.6, 0}};

// eraRefco's two terms by way of eraAtioq, in three kinds of air, to 20 degrees above the horizon and a little below.
TEST(StarRefraction, OnTheGroundItIsErfas) {
  double most = 0, least = 1;
  for (const Geodetic& site : kSites)
    for (const SurfaceAir& air : {SurfaceAir{101325, 283, 0, 0.55}, {74000, 262, 0.2, 0.8}, {101325, 305, 0.5, 0.4}}) {
      const JulianDate date{2461000.5, 0.3};
      const SceneFrame frame(site);
      const CelestialSphere sky(frame, date, date, air);
      const StarRefraction refraction(frame, air);
      for (double declination = -1.4; declination < 1.5; declination += 0.1)
        for (double right_ascension = 0; right_ascension < 6.2; right_ascension += 0.4) {
          const CatalogPlace star{right_ascension, declination};
          const Dir bare = sky.without_air(star), lifted = sky.seen(star);
          if (lifted.z < std::sin(20 * kDegree)) continue;
          most = std::max(most, angle_between(refraction.seen(bare, {}), lifted));
          least = std::min(least, angle_between(refraction.seen(bare, {}), bare));
          EXPECT_GT(angle_between(bare, lifted) * lifted.z, 0);
        }
    }
  std::printf("farthest from ERFA above 20 degrees: %.3f arc seconds\n", most / kArcSecond);
  EXPECT_LT(most, kArcSecond);
  EXPECT_LT(least, 10 * kArcSecond);
}

// Refractivity falls by exp(-h / H): the integral of its slope along the straight ray, by the midpoint rule.
TEST(StarRefraction, AlongAnyRayItIsTheIntegral) {
  constexpr double kEarth = 6371e3, kScale = 4.4474e-6 * 283 * kEarth;
  const StarRefraction refraction(SceneFrame({0, 0, 0}), {101325, 283, 0, 0.55});
  const double at_ground = refraction.bending(0, 45 * kDegree) / (1 - 2 * kScale / kEarth);
  const auto integral = [&](double height, double zenith) {
    const double r = kEarth + height, x0 = r * std::cos(zenith), y = r * std::sin(zenith);
    constexpr double kStep = 500, kEnd = 6e6;
    double sum = 0;
    for (double x = x0 + kStep / 2; x < x0 + kEnd; x += kStep) {
      const double rho = std::hypot(x, y);
      sum += std::exp(-(rho - kEarth) / kScale) / kScale * y / rho * kStep;
    }
    return at_ground * sum;
  };
  const auto limb = [](double height, double tangent) {
    return kPi - std::asin((kEarth + tangent) / (kEarth + height));
  };
  const double rays[][2] = {{0, 80 * kDegree},      {0, 90 * kDegree},         {10e3, 70 * kDegree},
                            {10e3, 92 * kDegree},   {400e3, limb(400e3, 5e3)}, {400e3, limb(400e3, 30e3)},
                            {800e3, limb(800e3, 0)}};
  for (const auto& [height, zenith] : rays) {
    const double expected = integral(height, zenith);
    EXPECT_NEAR(refraction.bending(height, zenith) / expected, 1, 0.01) << height << " " << zenith / kDegree;
  }
  // A horizon on the ground lifts by half a degree, the limb by twice as much; 30 km up it is half an arc minute.
  EXPECT_NEAR(refraction.bending(0, kPi / 2) / kDegree * 60, 34, 2);
  EXPECT_NEAR(refraction.bending(400e3, limb(400e3, 0)) / refraction.bending(0, kPi / 2), 2, 0.02);
}

// From orbit nothing is lifted but what stands behind the limb, and there is no jump anywhere.
TEST(StarRefraction, FromOrbitThereIsNoneUpwards) {
  const SceneFrame frame({49.4, 8.7, 120});
  const StarRefraction refraction(frame, {101325, 283, 0, 0.55});
  const Vec3 orbit{0, 0, 400e3};
  const auto at = [](double zenith) { return dir_from_angles(zenith, 0.3); };
  for (const double zenith : {0.0, 0.5, 1.0, 1.5, 1.57, 1.7}) {
    EXPECT_LT(angle_between(refraction.seen(at(zenith), orbit), at(zenith)), 1e-3 * kArcSecond) << zenith;
    const double on_ground = angle_between(refraction.seen(at(zenith), {}), at(zenith));
    EXPECT_GE(on_ground, zenith > 0.4 && zenith < 1.5 ? 20 * kArcSecond : 0);
  }
  double before = -1;
  for (double zenith = 1.85; zenith < 1.95; zenith += 1e-4) {
    const double seen = polar_angle(refraction.seen(at(zenith), orbit));
    EXPECT_GT(seen, before);
    EXPECT_LE(seen, zenith + 1e-12);
    EXPECT_NEAR(seen + refraction.bending(frame.geodetic_from_enu(orbit).height_m, seen), zenith, 1e-8);
    before = seen;
  }
  // Beside the origin the vertical is another.
  const Vec3 far = frame.enu_from_geodetic({52, 12, 0});
  const Dir up = frame.local_axes(far).z;
  EXPECT_LT(angle_between(refraction.seen(up, far), up), 1e-3 * kArcSecond);
}

}  // namespace
}  // namespace suite::test::star_refraction_test
