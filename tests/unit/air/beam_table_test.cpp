// Depths of beams from tables against their exact sums, at all heights and angles down to the Earth's shadow.
#include "air/beam_table.h"

#include <gtest/gtest.h>

#include <random>

namespace suite::beam_table_test {
namespace {

constexpr double kRadius = 6371000, kGround = -200;

// Molecules, haze with a top at 2 km and a thin cloud at 1 km, and ozone between 15 and 30 km: one bin each.
const std::vector<double> kHeights = {0,    200,  500,  1000, 1100, 1500, 2000, 3000, 4000, 5000, 7000,
                                      10e3, 13e3, 15e3, 20e3, 25e3, 30e3, 40e3, 50e3, 70e3, 100e3};

std::vector<float> extinction() {
  std::vector<float> e;
  for (size_t l = 0; l + 1 < kHeights.size(); ++l) {
    const double h = kHeights[l];
    e.push_back(static_cast<float>(1.2e-5 * std::exp(-h / 8000)));
    e.push_back(h == 1000 ? 0.05f : h < 2000 ? 2e-4f : 1e-12f);
    e.push_back(h >= 15e3 && h < 30e3 ? 2e-6f : 0.0f);
  }
  return e;
}

struct Worst {
  double depth = 0, transmittance = 0;
  int lit = 0, shadowed = 0;
};

Worst worst(const Shells& shells, size_t nodes) {
  const BeamTable table(shells, kGround, extinction(), 3, {}, nodes);
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> u(0, 1);
  Worst w;
  float got[3];
  double expected[3];
  for (int i = 0; i < 100000; ++i) {
    const double height = kGround + (i % 2 ? 120e3 * u(random) : std::pow(10, 5 * u(random)) - 1);
    // Half of them within 12 degrees of the local horizon.
    const double cosine = i % 4 < 2 ? 0.2 * (2 * u(random) - 1) : 2 * u(random) - 1;
    if (shells.curvature() == 0 && std::fabs(cosine) < 1e-3) continue;  // beyond the longest level way
    const Dir d{std::sqrt(1 - cosine * cosine), 0, cosine};
    const bool lit = beam_depth(shells, kGround, extinction(), shells.above_zero(height), d, expected);
    EXPECT_EQ(table.depth(height, cosine, got), lit) << height << " m, cosine " << cosine;
    ++(lit ? w.lit : w.shadowed);
    for (size_t bin = 0; lit && bin < 3; ++bin) {
      const double off = std::fabs(double(got[bin]) - expected[bin]);
      EXPECT_GE(got[bin], 0);
      if (expected[bin] > 1e-9) w.depth = std::max(w.depth, off / expected[bin]);
      w.transmittance = std::max(w.transmittance, std::fabs(std::exp(-double(got[bin])) - std::exp(-expected[bin])));
    }
  }
  return w;
}

TEST(BeamTable, AgreesWithExactSums) {
  const Worst round = worst(Shells::round({0, 0, -kRadius}, kRadius, kHeights), 64);
  std::printf("largest error: %.1e of the depth, %.1e of transmittance\n", round.depth, round.transmittance);
  EXPECT_LT(round.depth, 2e-5);
  EXPECT_LT(round.transmittance, 2e-6);
  EXPECT_GT(round.lit, 50000);
  EXPECT_GT(round.shadowed, 20000);
  // Fewer nodes are seen to be worse.
  EXPECT_GT(worst(Shells::round({0, 0, -kRadius}, kRadius, kHeights), 12).depth, 2e-3);
  EXPECT_LT(worst(Shells::flat(kHeights), 64).depth, 1e-6);
}

TEST(BeamTable, ShadowOfTheEarth) {
  const BeamTable table(Shells::round({0, 0, -kRadius}, kRadius, kHeights), 0, extinction(), 3);
  float depth[3];
  // Seen from 30 km the horizon lies 5.55 degrees below.
  const double horizon = -std::sqrt(1 - std::pow(kRadius / (kRadius + 30e3), 2));
  EXPECT_TRUE(table.depth(30e3, horizon + 1e-6, depth));
  EXPECT_GT(depth[0], 5);
  EXPECT_FALSE(table.depth(30e3, horizon - 1e-6, depth));
  EXPECT_FALSE(table.depth(1, -0.01, depth));
  EXPECT_TRUE(table.depth(150e3, 0.3, depth));
  EXPECT_EQ(depth[0], 0);
}

}  // namespace
}  // namespace suite::beam_table_test
