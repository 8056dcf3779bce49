// Jitter: the variances that exposures see against the two integrals over the power spectral density, within 5 %;
// fixed seeds. Each comparison averages 12 000 exposures, whose own scatter is 1.3 % (standard deviation of a
// variance).
#include "motion/jitter.h"

#include <gtest/gtest.h>

#include "base/error.h"
#include "math/sampling.h"
#include "math/stats.h"

namespace suite::jitter_test {
namespace {

AxisJitter coloured(const Psd& psd) {
  AxisJitter a;
  a.kind = AxisJitter::Kind::psd;
  a.psd = psd;
  return a;
}

struct Split {
  double in_frame, between_frames;
};

// Measures all six axes with the same PSD over exposures at scattered times.
Split measure(const Psd& psd, double exposure, uint64_t seed) {
  std::array<AxisJitter, 6> axes;
  axes.fill(coloured(psd));
  const Jitter jitter(axes, seed, 64);
  RunningStats within, means[6];
  Pcg32 rng(seed + 1);
  // Evenly spaced samples, closer than half the shortest period, make a sum over the exposure as good as an integral.
  const int kFrames = 2000, kSamples = 12 + static_cast<int>(2.5 * exposure * psd.frequency.back());
  for (int frame = 0; frame < kFrames; ++frame) {
    const double begin = rng.uniform() * 1e4 / psd.frequency[0];
    std::array<double, 6> sum{}, square{};
    for (int i = 0; i < kSamples; ++i) {
      const auto x = jitter.at(begin + exposure * (i + 0.5) / kSamples);
      for (int a = 0; a < 6; ++a) sum[a] += x[a], square[a] += x[a] * x[a];
    }
    for (int a = 0; a < 6; ++a) {
      const double mean = sum[a] / kSamples;
      within.add(square[a] / kSamples - mean * mean);
      means[a].add(mean);
    }
  }
  double between_frames = 0;
  for (const RunningStats& m : means) between_frames += (m.variance() + m.mean() * m.mean()) / 6;
  return {within.mean(), between_frames};
}

const Psd kPowerLaw{{0.5, 5, 200}, {1e-8, 4e-9, 1e-13}};
const Psd kFlat{{1, 100}, {2e-9, 2e-9}, Psd::Between::linear};
const Psd kPeak{{1, 28, 30, 32, 100}, {1e-11, 1e-11, 5e-8, 1e-11, 1e-12}};

TEST(Jitter, ExposuresSeeTheTwoIntegrals) {
  for (const Psd* psd : {&kPowerLaw, &kFlat, &kPeak})
    for (const double exposure : {0.004, 0.02, 0.1}) {
      const Split s = measure(*psd, exposure, 42);
      const double in = in_frame_variance(*psd, exposure), between_frames = frame_to_frame_variance(*psd, exposure);
      EXPECT_NEAR(s.in_frame, in, 0.05 * in) << psd->frequency.size() << " points, T = " << exposure;
      EXPECT_NEAR(s.between_frames, between_frames, 0.05 * between_frames)
          << psd->frequency.size() << " points, T = " << exposure;
    }
}

// Negative control: a motion with 12 % more variance must be told apart.
TEST(Jitter, TheComparisonRejectsAWrongSpectrum) {
  Psd wrong = kPowerLaw;
  for (double& s : wrong.density) s *= 1.12;
  const Split s = measure(wrong, 0.02, 42);
  EXPECT_GT(std::fabs(s.in_frame / in_frame_variance(kPowerLaw, 0.02) - 1), 0.05);
  EXPECT_GT(std::fabs(s.between_frames / frame_to_frame_variance(kPowerLaw, 0.02) - 1), 0.05);
}

TEST(Jitter, IntegralsAgainstClosedForms) {
  // Flat from 0 to far beyond 1/T: the mean over T has variance S0 / (2 T).
  const Psd flat{{0, 1e5}, {3, 3}, Psd::Between::linear};
  EXPECT_NEAR(frame_to_frame_variance(flat, 0.5), 3, 3e-5);
  EXPECT_NEAR(flat.variance(), 3e5, 1e-4);
  EXPECT_NEAR(in_frame_variance(flat, 0.5), 3e5 - 3, 1e-2);
  // A power law integrates in closed form: S = f^-2 from 1 to 100 gives 1 - 1/100.
  const Psd law{{1, 100}, {1, 1e-4}};
  EXPECT_NEAR(law.variance(), 0.99, 1e-9);
  EXPECT_NEAR(law.at(10), 0.01, 1e-15);
  EXPECT_EQ(law.at(0.5), 0);
  // A short exposure sees pi^2 T^2/3 of the integral of S f^2, here 99.
  EXPECT_NEAR(in_frame_variance(law, 1e-6) / (kPi * kPi * 1e-12 / 3 * 99), 1, 1e-6);
  // The two formulas for it meet where one hands over to the other.
  EXPECT_NEAR(in_frame_variance(law, 0.0024999) / in_frame_variance(law, 0.0025001), 1, 2e-4);
  EXPECT_EQ(frame_to_frame_variance(law, 0), law.variance());
  for (const double t : {0.001, 0.01, 0.1, 1.0, 50.0})
    EXPECT_NEAR(in_frame_variance(law, t) + frame_to_frame_variance(law, t), law.variance(), 1e-9);
}

TEST(Jitter, IsAFunctionOfSeedAxisAndTime) {
  std::array<AxisJitter, 6> axes;
  axes[0] = coloured(kPowerLaw);
  axes[1] = coloured(kPowerLaw);
  axes[2].kind = AxisJitter::Kind::white;
  axes[2].sigma = 1;
  const Jitter a(axes, 7), b(axes, 7), c(axes, 8);
  EXPECT_EQ(a.at(123.456), b.at(123.456));
  EXPECT_NE(a.at(123.456)[0], c.at(123.456)[0]);
  EXPECT_NE(a.at(123.456)[2], c.at(123.456)[2]);
  EXPECT_NE(a.at(123.456)[0], a.at(123.456)[1]);
  EXPECT_EQ(a.at(123.456)[5], 0);
  EXPECT_FALSE(a.still());
  EXPECT_TRUE(Jitter({}, 1).still());
}

TEST(Jitter, WhiteNoiseHasItsMomentsAndNoMemory) {
  std::array<AxisJitter, 6> axes;
  axes[4].kind = AxisJitter::Kind::white;
  axes[4].mean = 0.5;
  axes[4].sigma = 2;
  const Jitter jitter(axes, 3);
  RunningStats x, product, fourth;
  constexpr int kCount = 200000;
  double last = 0;
  for (int i = 0; i < kCount; ++i) {
    const double v = jitter.at(i * 1e-4)[4] - 0.5;
    x.add(v);
    product.add(v * last);
    fourth.add(v * v * v * v);
    last = v;
  }
  // Four standard errors.
  EXPECT_NEAR(x.mean(), 0, 4 * 2 / std::sqrt(kCount));
  EXPECT_NEAR(x.variance(), 4, 4 * 4 * std::sqrt(2.0 / kCount));
  EXPECT_NEAR(product.mean(), 0, 4 * 4 / std::sqrt(kCount));
  EXPECT_NEAR(fourth.mean(), 48, 4 * fourth.stderr_of_mean());
}

TEST(Jitter, TheTableOfAWindowAgreesWithTheSum) {
  std::array<AxisJitter, 6> axes;
  axes.fill(coloured(kPowerLaw));
  axes[3].kind = AxisJitter::Kind::white;
  axes[3].sigma = 1e-3;
  axes[1].mean = 4;
  const Jitter jitter(axes, 5);
  const JitterWindow window(jitter, {10, 11});
  const double sigma = std::sqrt(kPowerLaw.variance());
  for (int i = -50; i <= 1050; ++i) {
    const double t = 10 + i / 1000.0;
    const auto direct = jitter.at(t), table = window.at(t);
    for (int a = 0; a < 6; ++a) EXPECT_NEAR(direct[a], table[a], 2e-5 * sigma) << i;
    EXPECT_EQ(direct[3], table[3]);
  }
  const Pose p = jitter.pose(10.5);
  EXPECT_NEAR(p.translation.y, jitter.at(10.5)[1], 0);
  EXPECT_NEAR(2 * std::asin(length(p.rotation.vec())),
              length(Vec3{jitter.at(10.5)[3], jitter.at(10.5)[4], jitter.at(10.5)[5]}), 1e-12);
}

TEST(Jitter, RefusesWhatIsNoSpectrum) {
  for (const Psd& bad :
       {Psd{{1}, {1}}, Psd{{1, 2}, {1}}, Psd{{2, 1}, {1, 1}}, Psd{{1, 2}, {1, -1}}, Psd{{0, 1}, {1, 1}},
        Psd{{1, 2}, {0, 1}}, Psd{{1, 2}, {1, NAN}}, Psd{{1, 2}, {0, 0}, Psd::Between::linear}})
    EXPECT_THROW(bad.check(), Error);
  std::array<AxisJitter, 6> axes;
  axes[0].kind = AxisJitter::Kind::white;
  axes[0].sigma = -1;
  EXPECT_THROW(Jitter(axes, 1), Error);
  axes[0].sigma = 1;
  axes[0].mean = INFINITY;
  EXPECT_THROW(Jitter(axes, 1), Error);
  EXPECT_THROW(Jitter({}, 1, 8), Error);
  EXPECT_THROW(frame_to_frame_variance(kFlat, -1), Error);
}

}  // namespace
}  // namespace suite::jitter_test
