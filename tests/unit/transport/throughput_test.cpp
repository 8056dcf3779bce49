// Chains of steps against one number after the other, for every number of bins that takes another way through the
// registers, chains that fold on the way, and several sums of light.
#include "transport/throughput.h"

#include <gtest/gtest.h>

#include <vector>

#include "math/sampling.h"

namespace suite::throughput_test {
namespace {

// Factors are multiplied in another order than they come: some 50 roundings of 6e-8.
constexpr double kRounding = 4e-6;

// A path as its definition says: one number a bin.
struct Plain {
  std::vector<float> T;
  std::vector<std::vector<float>> L;  // [target]
  void turn(float scale, const float* a) {
    for (size_t k = 0; k < T.size(); ++k) T[k] *= a ? scale * a[k] : scale;
  }
  void shine(float scale, const float* a, const float* b, size_t target) {
    for (size_t k = 0; k < T.size(); ++k) {
      float x = scale;
      if (a) x *= a[k];
      if (b) x *= b[k];
      L[target][k] += x * T[k];
    }
  }
};

class Throughput : public testing::TestWithParam<size_t> {};

TEST_P(Throughput, ChainsFoldToOneStepAfterTheOther) {
  const size_t bins = GetParam(), targets = 3;
  Pcg32 random(7);
  std::vector<std::vector<float>> spectra(5, std::vector<float>(bins));
  for (auto& s : spectra)
    for (float& x : s) x = static_cast<float>(0.5 + random.uniform());
  const auto any = [&]() -> const float* {
    const uint32_t i = random.next() % 6;
    return i == 5 ? nullptr : spectra[i].data();
  };
  SpectralThroughputs paths(2, bins, targets);
  for (int round = 0; round < 20; ++round) {  // memory is used again
    Plain plain{std::vector<float>(bins, 1), {targets, std::vector<float>(bins, 0)}};
    paths.begin(1, 0.75f, spectra[0].data());
    plain.turn(0.75f, spectra[0].data());
    for (uint32_t step = random.next() % 50; step > 0; --step) {
      const float scale = static_cast<float>(0.5 + random.uniform());
      const float* const a = any();
      if (random.next() % 2) {
        // A turn of its own: numbers would join the turn before, in another order.
        paths.scatter(1, {scale, spectra[2].data()}, {});
        plain.turn(scale, spectra[2].data());
        continue;
      }
      const float* const b = any();
      const auto target = static_cast<uint16_t>(random.next() % targets);
      const auto second = static_cast<uint16_t>((target + 1) % targets);
      const bool both = random.next() % 2;
      paths.shine(1, {1, a}, scale, b, target, both ? second : SpectralThroughputs::kNone);
      plain.shine(scale, a, b, target);
      if (both) plain.shine(scale, a, b, second);
    }
    for (size_t t = 0; t < targets; ++t) {
      const auto light = paths.light(1, t);
      for (size_t k = 0; k < bins; ++k)
        ASSERT_NEAR(light[k], plain.L[t][k], kRounding * plain.L[t][k]) << "round " << round << " bin " << k;
    }
    const auto T = paths.throughput(1);
    for (size_t k = 0; k < bins; ++k)
      ASSERT_NEAR(T[k], plain.T[k], kRounding * plain.T[k]) << "round " << round << " bin " << k;
  }
}

// Light that is none changes when chains fold, and no bit of the rest.
TEST_P(Throughput, NothingIsNothing) {
  const size_t bins = GetParam();
  Pcg32 random(9);
  std::vector<std::vector<float>> spectra(5, std::vector<float>(bins));
  for (auto& s : spectra)
    for (float& x : s) x = static_cast<float>(0.5 + random.uniform());
  const std::vector<float> dark(bins, 0);
  SpectralThroughputs paths(2, bins, 1);
  for (uint32_t p = 0; p < 2; ++p) paths.begin(p, 0.75f, spectra[0].data());
  for (int step = 0; step < 60; ++step) {
    const float scale = static_cast<float>(0.5 + random.uniform());
    const uint32_t kind = random.next() % 3, i = random.next() % 5, j = random.next() % 5;
    for (uint32_t p = 0; p < 2; ++p) {
      if (kind == 0) paths.scatter(p, {scale, i == 4 ? nullptr : spectra[i].data()}, {});
      if (kind == 1) paths.shine(p, {scale, i == 4 ? nullptr : spectra[i].data()}, 1, spectra[j].data(), 0);
      for (int k = 0; p == 1 && k < step % 5; ++k) paths.shine(1, {1, nullptr}, 1, dark.data(), 0);
      if (p == 1 && step % 7 == 0) paths.make_room(1);
    }
  }
  for (size_t k = 0; k < bins; ++k) EXPECT_EQ(paths.light(0)[k], paths.light(1)[k]) << k;
}

// Of a narrow lobe: densities of ten thousand, again and again.
TEST_P(Throughput, NumbersAndSpectraThatMakeUpForEachOtherDoNotRunOut) {
  const size_t bins = GetParam();
  const std::vector<float> narrow(bins, 1e4f), weak(bins, 1e-6f), one(bins, 1);
  SpectralThroughputs paths(1, bins, 1);
  paths.begin(0, 1, nullptr);
  for (int i = 0; i < 40; ++i) paths.scatter(0, {1e-4f, narrow.data()}, {});
  for (int i = 0; i < 40; ++i) paths.scatter(0, {1e6f, weak.data()}, {});
  paths.shine(0, {1, nullptr}, 1, one.data(), 0);
  for (size_t k = 0; k < bins; ++k) EXPECT_NEAR(paths.light(0)[k], 1, 1e-5) << k;
}

INSTANTIATE_TEST_SUITE_P(Bins, Throughput, testing::Values(2, 7, 8, 9, 31, 32, 33, 40, 47, 224));

}  // namespace
}  // namespace suite::throughput_test
