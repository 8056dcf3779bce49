// Sample points: known Sobol values, the net property before and after scrambling, streams as pure functions.
#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <vector>

#include "math/sampling.h"

namespace suite::sampling_test {

namespace {

// Is each elementary interval 2^-k x 2^-(m-k) hit by exactly one of the 2^m points? (A (0, m, 2)-net in base 2.)
bool is_net(const std::vector<std::array<uint32_t, 2>>& points) {
  int m = 0;
  while ((size_t{1} << m) < points.size()) ++m;
  for (int k = 0; k <= m; ++k) {
    std::vector<bool> hit(points.size());
    for (const auto& p : points) {
      const size_t column = k ? p[0] >> (32 - k) : 0, row = m - k ? p[1] >> (32 - (m - k)) : 0;
      const size_t cell = (column << (m - k)) | row;
      if (hit[cell]) return false;
      hit[cell] = true;
    }
  }
  return true;
}

uint32_t bits_of(double u) { return static_cast<uint32_t>(u * 0x1p32); }

}  // namespace

TEST(Sobol, FirstPointsAreThePublishedOnes) {
  // The first eight points in binary-counter order, three dimensions: Joe & Kuo's table gives the same sequence in
  // Gray-code order. Dimension 1 is van der Corput's sequence.
  const double expected[8][3] = {{0, 0, 0},
                                 {0.5, 0.5, 0.5},
                                 {0.25, 0.75, 0.75},
                                 {0.75, 0.25, 0.25},
                                 {0.125, 0.625, 0.375},
                                 {0.625, 0.125, 0.875},
                                 {0.375, 0.375, 0.625},
                                 {0.875, 0.875, 0.125}};
  for (uint32_t i = 0; i < 8; ++i)
    for (int d = 0; d < 3; ++d) EXPECT_EQ(unit_double(sobol4(i, d)), expected[i][d]) << i << " " << d;
}

TEST(Sobol, EachDimensionOfEveryPowerOfTwoBlockIsStratified) {
  for (int d = 0; d < 4; ++d)
    for (const uint32_t start : {0u, 4096u, 0xfffff000u}) {
      std::set<uint32_t> strata;
      for (uint32_t i = 0; i < 4096; ++i) strata.insert(sobol4(start + i, d) >> 20);
      EXPECT_EQ(strata.size(), 4096u) << d << " " << start;
    }
}

TEST(Sobol, TheFirstTwoDimensionsAreNets) {
  for (int m = 0; m <= 12; ++m)
    for (const uint32_t block : {0u, 5u}) {
      std::vector<std::array<uint32_t, 2>> points;
      for (uint32_t i = 0; i < (1u << m); ++i)
        points.push_back({sobol4((block << m) + i, 0), sobol4((block << m) + i, 1)});
      EXPECT_TRUE(is_net(points)) << m;
    }
  // Negative control: one point moved out of its interval, and random points, are no nets.
  std::vector<std::array<uint32_t, 2>> points;
  for (uint32_t i = 0; i < 256; ++i) points.push_back({sobol4(i, 0), sobol4(i, 1)});
  points[7][1] ^= 1u << 31;
  EXPECT_FALSE(is_net(points));
  Pcg32 rng(1);
  for (auto& p : points) p = {rng.next(), rng.next()};
  EXPECT_FALSE(is_net(points));
}

TEST(Owen, ScramblesArePermutationsThatKeepEveryElementaryInterval) {
  Pcg32 rng(7);
  for (int t = 0; t < 50; ++t) {
    const uint32_t seed = rng.next(), a = rng.next();
    for (int k = 0; k < 32; ++k) {
      // Two values with k leading bits in common keep exactly k in common.
      const uint32_t b = a ^ (1u << (31 - k)) ^ (k < 31 ? rng.next() >> (k + 1) : 0);
      const uint32_t difference = owen_scramble(a, seed) ^ owen_scramble(b, seed);
      ASSERT_EQ(__builtin_clz(difference), k) << seed << " " << a;
    }
  }
}

TEST(Stream, EveryPowerOfTwoPrefixOfEveryBlockIsANetInItsFirstTwoDimensions) {
  for (uint64_t problem = 0; problem < 8; ++problem) {
    const SampleStream stream(3, 0, problem);
    for (const uint32_t block : {0u, 1u, 9u})
      for (const uint32_t n : {1u, 4u, 64u, 1024u}) {
        std::vector<std::array<uint32_t, 2>> points;
        for (uint32_t i = 0; i < n; ++i) {
          const auto u = stream.draw(i, block);
          points.push_back({bits_of(u[0]), bits_of(u[1])});
        }
        EXPECT_TRUE(is_net(points)) << problem << " " << block << " " << n;
      }
  }
}

TEST(Stream, IsAFunctionOfItsIndicesAndTellsThemApart) {
  EXPECT_EQ(SampleStream(1, 2, 3, 4).draw(5, 6), SampleStream(1, 2, 3, 4).draw(5, 6));
  for (const uint32_t n : {0u, 1u, 2u, 7u}) {  // many at once, in pairs or not
    std::vector<std::array<double, 4>> together(n);
    std::vector<SampleStream::Point> points;
    for (uint32_t i = 0; i < n; ++i) points.push_back(SampleStream(1, 2, 3, i % 3).point(5 + i, 6 * i, together[i]));
    SampleStream::draw(points);
    for (uint32_t i = 0; i < n; ++i) EXPECT_EQ(together[i], SampleStream(1, 2, 3, i % 3).draw(5 + i, 6 * i));
  }
  std::set<std::array<double, 4>> different;
  different.insert(SampleStream(1, 2, 3, 4).draw(5, 6));
  different.insert(SampleStream(2, 2, 3, 4).draw(5, 6));
  different.insert(SampleStream(1, 3, 3, 4).draw(5, 6));
  different.insert(SampleStream(1, 2, 4, 4).draw(5, 6));
  different.insert(SampleStream(1, 2, 3, 5).draw(5, 6));
  different.insert(SampleStream(1, 2, 3, 4).draw(6, 6));
  different.insert(SampleStream(1, 2, 3, 4).draw(5, 7));
  different.insert(SampleStream(2, 1, 3, 4).draw(5, 6));  // swapped seed and capture
  EXPECT_EQ(different.size(), 8u);
  for (const auto& u : different)
    for (const double x : u) EXPECT_TRUE(x >= 0 && x < 1);
}

TEST(Stream, UniformNumbersNeverReachOne) {
  EXPECT_LT(unit_double(~uint64_t{0}), 1.0);
  EXPECT_LT(unit_double(~uint32_t{0}), 1.0);
  EXPECT_EQ(unit_double(uint64_t{0}), 0.0);
}

TEST(Pcg, KnownAnswers) {
  // The first numbers of the reference implementation's demonstration: seed 42, stream 54.
  Pcg32 rng(42, 54);
  for (const uint32_t expected : {0xa15c02b7u, 0x7b47f409u, 0xba1d3330u, 0x83d2f293u, 0xbfa4784bu, 0xcbed606eu})
    EXPECT_EQ(rng.next(), expected);
}

}  // namespace suite::sampling_test
