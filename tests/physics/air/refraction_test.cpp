// Bent rays against a published formula for the air mass, and against rays traced step by step.
#include "air/refraction.h"

#include <gtest/gtest.h>

#include <cmath>

#include "air/beam_table.h"
#include "air/molecules.h"
#include "base/error.h"
#include "math/vec.h"

namespace suite::refraction_test {
namespace {

constexpr double kRadius = 6371000;

double density(double height) {
  const Air air = standard_air(height);
  return air.pressure / air.temperature;
}

Refraction standard(double wavelength_um, bool straight = false) {
  std::vector<double> heights, densities;
  for (double h = 0; h <= 86e3; h += h < 30e3 ? 250 : 1000) heights.push_back(h), densities.push_back(density(h));
  return Refraction(kRadius, heights, densities, straight ? 0 : refractivity(wavelength_um, 1, 1));
}

// Kasten, F. and Young, A. T., "Revised optical air mass tables and approximation formula", Appl. Opt. 28, 1989, eq. 3:
// over the apparent elevation.
double kasten_young(double zenith_deg) {
  return 1 / (std::cos(zenith_deg * kDegree) + 0.50572 * std::pow(96.07995 - zenith_deg, -1.6364));
}

TEST(Refraction, AirMassOfKastenAndYoung) {
  const Refraction air = standard(0.7), straight = standard(0.7, true);
  for (double zenith = 0; zenith < 89.95; zenith += 0.1) {
    const auto ray = air.ray(0, zenith * kDegree);
    ASSERT_TRUE(ray);
    ASSERT_NEAR(ray->air_mass / kasten_young(zenith), 1, 0.02) << zenith;
  }
  EXPECT_NEAR(kasten_young(89.9), 36.5, 0.05);
  EXPECT_NEAR(air.ray(0, 89.9 * kDegree)->air_mass, 36.5, 0.5);
  // Straight rays miss it.
  EXPECT_NEAR(straight.ray(0, 89.9 * kDegree)->air_mass, 33.9, 0.3);
  EXPECT_EQ(straight.ray(0, 89.9 * kDegree)->bending, 0);
  EXPECT_NEAR(air.ray(0, 0)->air_mass, 1, 1e-12);
  EXPECT_EQ(air.ray(0, 0)->bending, 0);
}

// The ray itself, d/ds (n dx/ds) = grad n, by steps of fourth order in the plane, through the standard air as it is
// and not through exponentials between levels.
struct Traced {
  double column = 0, bending = 0, lowest = 1e9;
};

Traced traced(double height, double apparent_zenith, double per_density, double step) {
  struct State {
    double x, y, px, py, column;  // position, n times direction
  };
  const auto slope = [&](const State& s) {
    const double r = std::hypot(s.x, s.y), h = r - kRadius, d = density(h);
    const double fall = (density(h + 0.5) - density(h - 0.5)) * per_density, n = 1 + per_density * d;
    return State{s.px / n, s.py / n, fall * s.x / r, fall * s.y / r, d};
  };
  const auto ahead = [](const State& s, const State& d, double t) {
    return State{s.x + t * d.x, s.y + t * d.y, s.px + t * d.px, s.py + t * d.py, s.column + t * d.column};
  };
  const double n = 1 + per_density * density(height);
  State s{0, kRadius + height, n * std::sin(apparent_zenith), n * std::cos(apparent_zenith), 0};
  const double first = std::atan2(s.px, s.py);
  Traced t;
  while (std::hypot(s.x, s.y) < kRadius + 86e3) {
    const State a = slope(s), b = slope(ahead(s, a, step / 2)), c = slope(ahead(s, b, step / 2)),
                d = slope(ahead(s, c, step));
    const State mean{(a.x + 2 * b.x + 2 * c.x + d.x) / 6, (a.y + 2 * b.y + 2 * c.y + d.y) / 6,
                     (a.px + 2 * b.px + 2 * c.px + d.px) / 6, (a.py + 2 * b.py + 2 * c.py + d.py) / 6,
                     (a.column + 2 * b.column + 2 * c.column + d.column) / 6};
    s = ahead(s, mean, step);
    t.lowest = std::min(t.lowest, std::hypot(s.x, s.y) - kRadius);
  }
  t.column = s.column;
  t.bending = std::atan2(s.px, s.py) - first;
  return t;
}

TEST(Refraction, AgreesWithTracedRays) {
  const Refraction air = standard(0.55);
  const double per_density = refractivity(0.55, 1, 1);
  struct Case {
    double height, zenith_deg;
  };
  // 92 degrees from where the horizon lies lower than that, and the deepest ray from 20 km.
  for (const Case c :
       {Case{1, 60}, {1, 85}, {1, 89}, {1, 89.9}, {1, 90}, {10e3, 92}, {20e3, 92}, {20e3, 94.3}, {60e3, 97}}) {
    const auto ray = air.ray(c.height, c.zenith_deg * kDegree);
    ASSERT_TRUE(ray) << c.height;
    const Traced t = traced(c.height, c.zenith_deg * kDegree, per_density, 100),
                 up = traced(c.height, 0, per_density, 100);
    // The traced ray overshoots the top by up to a step.
    EXPECT_NEAR(ray->air_mass / (t.column / up.column), 1, 5e-4) << c.height << " m, " << c.zenith_deg;
    EXPECT_NEAR(ray->bending / t.bending, 1, 2e-3) << c.height << " m, " << c.zenith_deg;
    if (c.zenith_deg > 90) {
      EXPECT_NEAR(ray->lowest_height, t.lowest, 2) << c.height;
      // Straight rays are elsewhere.
      EXPECT_GT(std::fabs(standard(0.55, true).ray(c.height, c.zenith_deg * kDegree)->air_mass / ray->air_mass - 1),
                5e-3);
    }
  }
}

// Tables of the Sun's beam: molecules in layers of 250 m, against quadrature along the bent ray through the continuous
// air.
TEST(Refraction, BeamOfTheLowSun) {
  std::vector<double> heights, n;
  for (double h = 0; h <= 86e3; h += h < 60e3 ? 250 : 1000)
    heights.push_back(h), n.push_back(refractivity(0.55, 1, 1) * density(h));
  std::vector<float> extinction;
  for (size_t i = 0; i + 1 < heights.size(); ++i)  // the mean of an exponential, relative to the ground's, 1/km
    extinction.push_back(static_cast<float>(1e-3 / n[0] * (n[i] - n[i + 1]) / std::log(n[i] / n[i + 1])));
  const Shells shells = Shells::round({0, 0, -kRadius}, kRadius, heights);
  const BeamTable bent(shells, 0, extinction, 1, n), straight(shells, 0, extinction, 1);
  const Refraction air = standard(0.55);
  float up = 0, depth = 0, off = 0;
  double worst = 0, worst_angle = 0;
  int lit = 0, dark = 0;
  for (const double height : {0.0, 100.0, 5e3, 10.1e3, 20e3, 30e3, 50e3})
    for (double zenith_deg = 60; zenith_deg < 97; zenith_deg += zenith_deg < 88 ? 7 : 0.25) {
      const double cosine = std::cos(zenith_deg * kDegree);
      const auto apparent = air.apparent_zenith(height, zenith_deg * kDegree);
      const auto seen = bent.seen(height, cosine);
      ASSERT_EQ(bent.depth(height, cosine, {&depth, 1}), apparent.has_value()) << height << " m, " << zenith_deg;
      ASSERT_EQ(seen.has_value(), apparent.has_value());
      ++(apparent ? lit : dark);
      if (!apparent) continue;
      bent.depth(height, 1, {&up, 1});
      const double air_mass = air.ray(height, *apparent)->air_mass;
      worst = std::max(worst, std::fabs(depth / up / air_mass - 1));
      worst_angle = std::max(worst_angle, std::fabs(std::acos(*seen) - *apparent));
      if (height == 10.1e3 && zenith_deg == 92) {
        straight.depth(height, cosine, {&off, 1});
        EXPECT_GT(off / depth, 1.1);  // what a straight beam would have
      }
    }
  std::printf("bent beam: %.2f %% of the depth, %.4f degrees at worst\n", 100 * worst, worst_angle / kDegree);
  EXPECT_LT(worst, 5e-3);
  EXPECT_LT(worst_angle, 0.001 * kDegree);
  EXPECT_GT(lit, 150);
  EXPECT_GT(dark, 50);
}

TEST(Refraction, ApparentAndTrueAngles) {
  const Refraction air = standard(0.55);
  // The setting Sun: about 34' at the horizon.
  const double at_horizon = air.ray(0, kPi / 2)->bending / kDegree * 60;
  EXPECT_GT(at_horizon, 30);
  EXPECT_LT(at_horizon, 37);
  for (const double zenith_deg : {0.0, 10.0, 45.0, 80.0, 89.0, 90.0, 90.4}) {
    const auto apparent = air.apparent_zenith(0, zenith_deg * kDegree);
    ASSERT_TRUE(apparent) << zenith_deg;
    EXPECT_NEAR(*apparent + air.ray(0, *apparent)->bending, zenith_deg * kDegree, 1e-11);
  }
  EXPECT_FALSE(air.apparent_zenith(0, 91 * kDegree));
  EXPECT_TRUE(air.apparent_zenith(10e3, 92 * kDegree));
  EXPECT_NEAR(air.horizon(0), kPi / 2, 1e-12);
  EXPECT_TRUE(air.ray(10e3, air.horizon(10e3) - 1e-9));
  EXPECT_FALSE(air.ray(10e3, air.horizon(10e3) + 1e-6));
}

// Ciddor 1996, table 1: dry air at 20 degrees C, 100 kPa, 633 nm, 450 ppm of CO2: n - 1 = 26824.4e-8.
TEST(Refraction, RefractivityOfDryAir) {
  EXPECT_NEAR(refractivity(0.633, 100e3, 293.15), 26824.4e-8, 3e-4 * 26824.4e-8);
  EXPECT_GT(refractivity(0.4, 1e5, 288), refractivity(10, 1e5, 288));
}

TEST(Refraction, BadProfiles) {
  EXPECT_THROW(Refraction(kRadius, {0, 1000}, {1}, 0), Error);
  EXPECT_THROW(Refraction(kRadius, {0, 1000, 500}, {1, 0.9, 0.8}, 0), Error);
  EXPECT_THROW(Refraction(kRadius, {0, 1000}, {1, 0}, 0), Error);
  EXPECT_THROW(Refraction(kRadius, {0, 100}, {1, 0.5}, 3e-4), Error);  // a duct
  EXPECT_THROW(standard(0.55).ray(90e3, 0), Error);
  EXPECT_THROW(standard(0.55).ray(-1, 0), Error);
}

}  // namespace
}  // namespace suite::refraction_test
