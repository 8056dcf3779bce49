// Warps draw the densities they state: chi-square over bins of equal azimuth and polar cosine, 2 million points,
// significance 1e-4. Negative controls: samplers wrong by 2 % in the exponent of the radius are refused.
#include <gtest/gtest.h>

#include <functional>
#include <vector>

#include "math/sampling.h"
#include "math/stats.h"
#include "math/warps.h"

namespace suite::warps_test {

namespace {

constexpr double kSignificance = 1e-4;
constexpr int kRings = 20, kSectors = 24, kPoints = 2'000'000;

// ring: 0..1, uniform when the sampler is right; phi: azimuth.
double p_value(const std::function<std::pair<double, double>(Vec2)>& ring_and_azimuth, uint64_t seed) {
  Pcg32 rng(seed);
  std::vector<double> observed(kRings * kSectors), expected(kRings * kSectors, double{kPoints} / (kRings * kSectors));
  for (int i = 0; i < kPoints; ++i) {
    const double x = rng.uniform(), y = rng.uniform();
    const auto [ring, phi] = ring_and_azimuth({x, y});
    const int r = std::clamp(static_cast<int>(ring * kRings), 0, kRings - 1);
    const int s = std::clamp(static_cast<int>((phi / (2 * kPi) + 0.5) * kSectors), 0, kSectors - 1);
    ++observed[r * kSectors + s];
  }
  return chi_square_test(observed, expected, 5);
}

double power_102(double x) { return std::pow(x, 1.02); }

}  // namespace

TEST(CosineHemisphere, ManyAreTheSameBitsAsOne) {
  std::vector<double> x{0.5, 0.5, 0, 1, 0, 0.25, 0.75}, y{0.5, 0, 0.5, 1, 0, 0.75, 0.25};
  Pcg32 random(4);
  while (x.size() < 4097) x.push_back(random.uniform()), y.push_back(random.uniform());
  const size_t count = x.size();
  x.resize(4100), y.resize(4100);
  const std::vector<double> u = x, v = y;
  std::vector<double> z(4100);
  cosine_hemispheres(count, x.data(), y.data(), z.data());
  for (size_t i = 0; i < count; ++i) EXPECT_EQ(cosine_hemisphere({u[i], v[i]}), (Dir{x[i], y[i], z[i]})) << i;
}

TEST(Warps, DiskIsUniform) {
  const auto place = [](Vec2 u) {
    const Vec2 d = disk_from_square(u);
    return std::pair{d.x * d.x + d.y * d.y, std::atan2(d.y, d.x)};
  };
  EXPECT_GT(p_value(place, 1), kSignificance);
  EXPECT_LT(p_value(
                [&](Vec2 u) {
                  auto r = place(u);
                  return std::pair{power_102(r.first), r.second};
                },
                1),
            kSignificance);
}

TEST(Warps, CosineHemisphereMatchesItsDensity) {
  // Share of the hemisphere's cosine below polar angle theta: sin^2(theta).
  const auto place = [](Vec2 u) {
    const Dir d = cosine_hemisphere(u);
    EXPECT_GE(d.z, 0);
    EXPECT_NEAR(length(d), 1, 1e-14);
    return std::pair{1 - d.z * d.z, azimuth(d)};
  };
  EXPECT_GT(p_value(place, 2), kSignificance);
  EXPECT_LT(p_value(
                [&](Vec2 u) {
                  auto r = place(u);
                  return std::pair{power_102(r.first), r.second};
                },
                2),
            kSignificance);
  // The density integrates to one (midpoint rule over the polar cosine) and vanishes below the horizon.
  double sum = 0;
  for (int i = 0; i < 1000; ++i) sum += 2 * kPi * cosine_hemisphere_pdf((i + 0.5) / 1000) / 1000;
  EXPECT_NEAR(sum, 1, 1e-12);
  EXPECT_EQ(cosine_hemisphere_pdf(-0.5), 0);
}

TEST(Warps, SphereIsUniform) {
  const auto place = [](Vec2 u) {
    const Dir d = uniform_sphere(u);
    return std::pair{0.5 * (1 - d.z), azimuth(d)};
  };
  EXPECT_GT(p_value(place, 3), kSignificance);
  EXPECT_LT(p_value(
                [&](Vec2 u) {
                  auto r = place(u);
                  return std::pair{power_102(r.first), r.second};
                },
                3),
            kSignificance);
}

TEST(Warps, ConesAreUniformFromTheSunToTheHemisphere) {
  for (const double half_angle : {1e-6, 0.2666 * kDegree, 0.5, kPi / 2}) {
    const double h = one_minus_cos(half_angle);
    const auto place = [&](Vec2 u) {
      const Dir d = uniform_cone(u, h);
      const double sine2 = d.x * d.x + d.y * d.y;
      // 1 - cos without cancellation for the narrow cones.
      const double drop = d.z > 0.5 ? sine2 / (1 + d.z) : 1 - d.z;
      return std::pair{drop / h, std::atan2(d.y, d.x)};
    };
    EXPECT_GT(p_value(place, 4), kSignificance) << half_angle;
    EXPECT_LT(p_value(
                  [&](Vec2 u) {
                    auto r = place(u);
                    return std::pair{power_102(r.first), r.second};
                  },
                  4),
              kSignificance);
  }
  EXPECT_EQ(uniform_cone({0.3, 0.9}, 0).z, 1);  // a collimated sun
}

TEST(Warps, CornersOfTheSquareStayOnTheSphere) {
  for (const double x : {0.0, 0.5, 1 - 0x1p-53})
    for (const double y : {0.0, 0.5, 1 - 0x1p-53})
      for (const Dir d :
           {cosine_hemisphere({x, y}), uniform_sphere({x, y}), uniform_cone({x, y}, 1e-5), uniform_cone({x, y}, 1)}) {
        EXPECT_TRUE(finite(d));
        EXPECT_NEAR(length(d), 1, 1e-15);
      }
}

}  // namespace suite::warps_test
