// Detectors that count, against closed forms of their distributions. Seeds are fixed; where a number is judged by
// chance the limit is 4.5 standard errors or p = 1e-4, and beside it stands a hypothesis that has to fail.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "math/stats.h"
#include "math/variates.h"
#include "sensor/detectors/register.h"
#include "support/detector_kit.h"
#include "support/message_of.h"

namespace suite::detectors_test {
namespace {

using test::chance;
using test::detector_of;
using test::even_light;
using test::expect_moments;
using test::kChance;
using test::kSure;
using test::snr;
using test::stats_of;
using testing::HasSubstr;

double poisson_share(double mean, int n) { return std::exp(n * std::log(mean) - mean - std::lgamma(n + 1.0)); }

// P(charge < x) of Poisson electrons through a gain of gamma pulses (n electrons: shape n, scale G).
double poisson_gamma(double x, double mean, double gain) {
  double p = x > 0 ? std::exp(-mean) : 0;
  for (int n = 1; n < 40 && x > 0; ++n) p += poisson_share(mean, n) * gamma_p(n, x / gain);
  return p;
}

TEST(Variates, BinomialHasItsShares) {
  Pcg32 random(3);
  for (const auto& [n, p] : {std::pair{8u, 0.3}, {200u, 0.02}, {200u, 0.9}}) {
    std::vector<double> observed(n + 1, 0), expected(n + 1);
    constexpr int draws = 40000;
    for (int i = 0; i < draws; ++i) ++observed[binomial(n, p, random)];
    const auto share = [n = n](double q, uint32_t k) {
      return std::exp(std::lgamma(n + 1.0) - std::lgamma(k + 1.0) - std::lgamma(n - k + 1.0) + k * std::log(q) +
                      (n - k) * std::log1p(-q));
    };
    for (uint32_t k = 0; k <= n; ++k) expected[k] = draws * share(p, k);
    EXPECT_GT(chi_square_test(observed, expected, 10), kChance) << n << " " << p;
    for (uint32_t k = 0; k <= n; ++k) expected[k] = draws * share(p * 1.05, k);
    EXPECT_LT(chi_square_test(observed, expected, 10), kChance) << "negative control " << n << " " << p;
  }
  EXPECT_EQ(binomial(1000, 0, random), 0u);
  EXPECT_EQ(binomial(1000, 1, random), 1000u);
}

// Mean and variance of a branching process (Harris 1963): 604 stages, gain 300: p = 0.00948808, F^2 = 1.97793.
TEST(Register, HasTheMomentsOfABranchingProcess) {
  const Register stages(604, std::expm1(std::log(300.0) / 604));
  EXPECT_NEAR(std::expm1(std::log(300.0) / 604), 0.00948808, 1e-8);
  EXPECT_NEAR(stages.gain(), 300, 1e-9);
  EXPECT_NEAR(stages.excess(), 1.97793, 5e-6);
  const double G = 300, N = 604;
  EXPECT_NEAR(stages.excess(), 2 * (G - 1) * std::pow(G, -(N + 1) / N) + 1 / G, 1e-9);  // Robbins & Hadwen 2003
  Pcg32 random(4);
  std::vector<double> out(40000);
  for (const double n : {1.0, 3.0, 60.0}) {
    for (double& x : out) x = stages.multiply(n, random);
    expect_moments(out, n * G, n * G * G * (stages.excess() - 1), 3 + 6 / n);
  }
}

// The same stage by stage, each electron by itself: the histogram of what one and two electrons become.
TEST(Register, IsTheChainOfItsStages) {
  const int N = 40;
  const double p = std::expm1(std::log(20.0) / N);
  const Register stages(N, p);
  Pcg32 random(5);
  const auto chain = [&](double n) {
    for (int s = 0; s < N; ++s) n += binomial(static_cast<uint32_t>(n), p, random);
    return n;
  };
  for (const double n : {1.0, 2.0}) {
    std::vector<double> observed(12, 0), expected(12, 0), sham(12, 0);
    constexpr int draws = 12000;
    const auto cell = [](double x) { return std::min<size_t>(11, static_cast<size_t>(x / 8)); };
    for (int i = 0; i < draws; ++i) {
      ++observed[cell(stages.multiply(n, random))], ++expected[cell(chain(n))];
      ++sham[cell(gamma_variate(n, 24, random))];
    }
    // Two samples of the same size: chi-square of their difference.
    const auto p_of = [&](const std::vector<double>& a) {
      double x = 0;
      for (size_t k = 0; k < a.size(); ++k) x += (a[k] - expected[k]) * (a[k] - expected[k]) / (a[k] + expected[k]);
      return chi_square_tail(x, static_cast<double>(a.size() - 1));
    };
    EXPECT_GT(p_of(observed), kChance);
    EXPECT_LT(p_of(sham), kChance) << "negative control: a gain of 24";
  }
}

// Many stages of a small probability: one electron becomes a geometric number, nearly an exponential one. So charges
// are a Poisson-gamma mixture, and a threshold of 250 of 300 is passed by exp(-250/300) = 0.434598 of single electrons.
TEST(Emccd, HasThePoissonGammaMixture) {
  const auto d =
      detector_of("kind: emccd, em_gain: 1000, stages: 100000, gain_e_per_dn: 0.1, bias_dn: 0, seed: 7, bits: 16");
  const double n = 0.6, G = 1000;
  std::vector<double> charges;
  for (const double dn : d.reader->read(even_light(300, 200, n)).dn) charges.push_back(0.1 * dn);
  const std::vector<double> ends{40, 80, 150, 250, 400, 600, 900, 1300, 1800, 2500, 3500, 5000, 6500};
  EXPECT_GT(chance(charges, ends, [&](double x) { return poisson_gamma(x, n, G); }), kChance);
  EXPECT_LT(chance(charges, ends, [&](double x) { return poisson_gamma(x, 1.06 * n, G); }), kChance);
  const auto none = static_cast<double>(std::count(charges.begin(), charges.end(), 0.0)), all = 60000.0;
  EXPECT_NEAR(none / all, std::exp(-n), kSure * std::sqrt(std::exp(-n) * (1 - std::exp(-n)) / all));

  const Register stages(100000, std::expm1(std::log(300.0) / 100000));
  Pcg32 random(8);
  double one = 0, two = 0;
  constexpr int draws = 40000;
  for (int i = 0; i < draws; ++i) one += stages.multiply(1, random) > 250, two += stages.multiply(2, random) > 250;
  EXPECT_NEAR(one / draws, 0.434598, kSure * std::sqrt(0.2457 / draws) + 0.001);
  EXPECT_NEAR(two / draws, 0.796763, kSure * std::sqrt(0.162 / draws) + 0.001);
}

// Signal over noise, S / sqrt(F^2 (S + dark + CIC) + (read / G)^2), by its formula and by what is read.
TEST(Emccd, SignalToNoise) {
  const std::string emccd = "kind: emccd, em_gain: 300, read_noise_e: 50, gain_e_per_dn: 1, bias_dn: 400";
  const std::string scmos = "kind: scmos, read_noise_e: 1.3, gain_e_per_dn: 0.001";
  const std::string ccd = "gain_e_per_dn: 0.001, read_noise_e: 3";
  for (const auto& [n, of_emccd, of_ccd, of_scmos] : {std::array{0.1, 0.21055, 0.03315, 0.07474},
                                                      {1.0, 0.70610, 0.31623, 0.60971},
                                                      {10.0, 2.24693, 2.29416, 2.92478}}) {
    EXPECT_NEAR(snr(emccd, n), of_emccd, 1e-5);
    EXPECT_NEAR(snr(ccd, n), of_ccd, 1e-5);
    EXPECT_NEAR(snr(scmos, n), of_scmos, 1e-5);
    const RunningStats s = stats_of(detector_of(emccd).reader->read(even_light(200, 200, n)).dn);
    EXPECT_NEAR((s.mean() - 400) / std::sqrt(s.variance()) / of_emccd, 1, kSure * std::sqrt(6 / n + 6) / 200) << n;
  }
}

TEST(Emccd, ClockInducedChargeAndTheRegistersFullWell) {
  const auto d = detector_of(
      "kind: emccd, em_gain: 100, clock_induced_e: 0.2, serial_clock_induced_e: 0.5, gain_e_per_dn: 0.5, bias_dn: 0");
  const Params p = Params::parse_text("{em_gain: 100, serial_clock_induced_e: 0.5}", "x");
  const double serial = read_register(p).serial_gain(), G = 100;
  EXPECT_NEAR(serial, (G - 1) / (604 * std::expm1(std::log(G) / 604)), 1e-9);
  const RunningStats s = stats_of(d.reader->read(even_light(250, 200, 0)).dn);
  // Of 0.5 electrons at any stage the second moment of the gain is at most twice its square's mean.
  EXPECT_NEAR(s.mean() * 0.5, 0.2 * G + 0.5 * serial, kSure * std::sqrt(s.variance() / 50000) * 0.5);
  const ArrayReading full =
      detector_of("kind: emccd, em_gain: 100, register_full_well_e: 5000, gain_e_per_dn: 1, bias_dn: 0")
          .reader->read(even_light(50, 1, 1e4));
  for (size_t i = 0; i < 50; ++i) {
    EXPECT_EQ(full.dn[i], 5000);
    EXPECT_TRUE(full.clipped[i]);
  }
}

// Of n electrons a frame P = 1 - exp(-n), and n = -ln(1 - P) has the signal over noise n e^-n / sqrt(P (1 - P)).
TEST(PhotonCounting, HasItsProbabilityAndItsSignalToNoise) {
  for (const auto& [n, expected] : {std::pair{0.05, 0.22082}, {0.1, 0.30836}, {0.5, 0.62078}}) {
    const double P = -std::expm1(-n);
    EXPECT_NEAR(n * std::exp(-n) / std::sqrt(P * (1 - P)), expected, 1e-5);
    const auto d = detector_of("kind: photon_counting, em_gain: 300, threshold_e: 0.5, frames: 4");
    const std::vector<double> counts = d.reader->read(even_light(200, 200, 4 * n)).counts;
    expect_moments(counts, 4 * P, 4 * P * (1 - P));
    EXPECT_TRUE(d.reader->read(even_light(2, 2, n)).dn.empty());
    // Negative control: without coincidences the mean would be another.
    if (n > 0.4) {
      EXPECT_GT(std::fabs(stats_of(counts).mean() - 4 * n), kSure * std::sqrt(4 * n / 40000));
    }
  }
}

// Single electrons through 604 stages at a threshold of 250 of 300: a little more of them than of an exponential.
TEST(PhotonCounting, LosesWhatIsBelowTheThreshold) {
  const auto d = detector_of("kind: photon_counting, em_gain: 300, threshold_e: 250, read_noise_e: 30");
  const double n = 0.01;
  const auto light = even_light(400, 400, n);
  const double counted = stats_of(d.reader->read(light).counts).mean();
  EXPECT_NEAR(counted / n, 0.4346, 0.05);
  EXPECT_LT(stats_of(d.reader->read(even_light(200, 200, 0)).counts).mean(), 1e-6) << "250 is 8 of the read noise";
}

// Of read noise s a share erfc(1 / (2 sqrt 2 s)) of pixels is rounded to a wrong number: 1.2, 9.6, 21.1 %.
TEST(Qcmos, RoundsToWholeElectrons) {
  for (const auto& [noise, wrong] : {std::pair{0.2, 0.01242}, {0.3, 0.09558}, {0.4, 0.21130}}) {
    const auto d = detector_of(strf("kind: qcmos, read_noise_e: %g, gain_e_per_dn: 0.005, bias_dn: 1000", noise));
    EXPECT_NEAR(std::erfc(0.5 / noise / std::sqrt(2.0)), wrong, 1e-5);
    // At 100 electrons none is cut at 0: P(a whole electron off) moves the variance, at 0 it is seen as counts.
    const std::vector<double> counts = d.reader->read(even_light(200, 200, 0)).counts;
    const auto off =
        static_cast<double>(counts.size() - static_cast<size_t>(std::count(counts.begin(), counts.end(), 0)));
    EXPECT_NEAR(off / 40000, wrong / 2, kSure * std::sqrt(wrong / 2 / 40000) + 1e-3 * wrong) << noise;  // half below 0
  }
}

// Over pixels the noise is log-normal: median 1.3, mean 1.6 electrons, so 3 of 1000 pixels are above 7.6.
TEST(Scmos, NoiseDiffersFromPixelToPixelAndIsAlwaysTheSameThere) {
  const auto d =
      detector_of("kind: scmos, read_noise_e: {median: 1.3, mean: 1.6}, gain_e_per_dn: 0.05, bias_dn: 5000, seed: 3");
  constexpr uint32_t side = 60;
  constexpr int frames = 400;
  std::vector<RunningStats> pixels(side * side);
  for (uint64_t f = 0; f < frames; ++f) {
    const ArrayReading r = d.reader->read(even_light(side, side, 0, f));
    for (size_t i = 0; i < pixels.size(); ++i) pixels[i].add((r.dn[i] - 5000) * 0.05);
  }
  std::vector<double> logs, squares;
  for (const RunningStats& s : pixels) logs.push_back(0.5 * std::log(s.variance() - 0.05 * 0.05 / 12));
  const double deviation = std::sqrt(2 * std::log(1.6 / 1.3));
  // An estimated standard deviation of so many frames scatters by 1 / sqrt(2 frames), and its logarithm is low by half.
  const double own = 1.0 / (2 * frames);
  expect_moments(logs, std::log(1.3) - own / 2, deviation * deviation + own);
  EXPECT_GT(std::fabs(stats_of(logs).mean() - std::log(1.6)), 0.1) << "negative control: the mean as the median";
}

TEST(Scmos, TelegraphStepsAndColumnNoise) {
  // All pixels have a trap: two independent samples of it differ with 2 d (1 - d); E a^2 = 2 A^2 over pixels.
  const auto steps =
      detector_of("kind: scmos, gain_e_per_dn: 0.05, bias_dn: 9000, telegraph: {share: 1, amplitude_e: 5, duty: 0.25}");
  expect_moments(steps.reader->read(even_light(300, 200, 0)).dn, 9000, 2 * 0.25 * 0.75 * 2 * 25 / (0.05 * 0.05), 17);
  const auto columns = detector_of(
      "kind: scmos, gain_e_per_dn: 0.01, bias_dn: 9000, column_noise_e: 2, row_noise_e: 1, "
      "read_noise_e: 0.5");
  const ArrayReading r = columns.reader->read(even_light(400, 400, 0)),
                     next = columns.reader->read(even_light(400, 400, 0, 1));
  std::vector<double> of_column(400, 0), of_row(400, 0), of_next(400, 0);
  for (size_t i = 0; i < r.dn.size(); ++i) {
    of_column[i % 400] += (r.dn[i] - 9000) * 0.01 / 400, of_row[i / 400] += (r.dn[i] - 9000) * 0.01 / 400;
    of_next[i % 400] += (next.dn[i] - 9000) * 0.01 / 400;
  }
  EXPECT_NEAR(stats_of(of_column).variance() / 4, 1, kSure * std::sqrt(2.0 / 400));
  EXPECT_NEAR(stats_of(of_row).variance(), 1, kSure * std::sqrt(2.0 / 400));
  double together = 0;
  for (size_t c = 0; c < 400; ++c) together += of_column[c] * of_next[c] / 400;
  EXPECT_NEAR(together, 0, kSure * 4 / 20.0) << "columns are new in every read-out";
}

TEST(Ingaas, DarkCurrentDoubles) {
  const auto at = [](double kelvin) {
    const auto d =
        detector_of(strf("kind: ingaas, gain_e_per_dn: 1, dark_current_e_s: 1000, dark_reference_k: 290, "
                         "dark_doubling_k: 7, temperature_k: %g",
                         kelvin));
    EXPECT_NEAR(d.spec.dark_current / (1000 * std::exp2((kelvin - 290) / 7)), 1, 1e-12);
    return d.reader->read(even_light(100, 100, 0)).dn;
  };
  expect_moments(at(290), 1100, 1000 + 1.0 / 12);
  expect_moments(at(276), 350, 250 + 1.0 / 12);
}

TEST(Detectors, TheSameSeedTheSameBytesAndAnotherOnesOthers) {
  for (const auto& row : array_detectors()) {
    const std::string keys = "kind: " + row.name + ", seed: ";
    const std::string rest = row.name == "spad"              ? ", dead_time_ns: 10, crosstalk: 0.01"
                             : row.name == "photon_counting" ? ", em_gain: 100, threshold_e: 300"
                             : row.name == "emccd"           ? ", em_gain: 100, gain_e_per_dn: 1"
                             : row.name == "intensifier"     ? ", gain_e: 100, gain_e_per_dn: 1, phosphor: {blur_um: 9}"
                                                             : ", gain_e_per_dn: 1";
    const auto read = [&](int seed, uint64_t read_out) {
      const ArrayReading r =
          detector_of(keys + std::to_string(seed) + rest).reader->read(even_light(20, 20, 2, read_out));
      return r.dn.empty() ? r.counts : r.dn;
    };
    EXPECT_EQ(read(1, 0), read(1, 0)) << row.name;
    EXPECT_NE(read(1, 0), read(2, 0)) << row.name;
    EXPECT_NE(read(1, 0), read(1, 1)) << row.name;
  }
}

// From no light to 1e9 electrons in one frame: each pixel as if it were alone.
TEST(Detectors, HoldNineDecadesInOneFrame) {
  ArrayLight light = even_light(64, 64, 0.5);
  light.electrons[2000] = 5e8;
  const auto d = detector_of(
      "kind: intensifier, gain_e: 1, gain_e_per_dn: 1.0e+4, bias_dn: 0, halo: {share: 0.02, "
      "radius_um: 100}, pulse_excess: 1");
  const ArrayReading r = d.reader->read(light);
  EXPECT_NEAR(r.dn[2000] / (0.98 * 5e4), 1, 0.001);
  EXPECT_NEAR(r.dn[2003], 0.02 * 5e4 / (kPi * 100), 1.5);
  EXPECT_EQ(r.dn[0], 0);
  light.electrons[2000] = 1e9;
  const ArrayReading free = detector_of("gain_e_per_dn: 2.0e+4").reader->read(light);
  EXPECT_NEAR(free.dn[2000], 5e4, 15);
}

// Bias: noise about no light is not cut at 0; without one half of it is, and the pixels say so.
TEST(Detectors, DarksAreNotClipped) {
  const auto d = detector_of("kind: scmos, read_noise_e: 3, gain_e_per_dn: 0.5");
  const ArrayReading r = d.reader->read(even_light(200, 200, 0));
  expect_moments(r.dn, 100, 36 + 1.0 / 12);
  EXPECT_EQ(std::count(r.clipped.begin(), r.clipped.end(), 1), 0);
  const ArrayReading cut =
      detector_of("kind: scmos, read_noise_e: 3, gain_e_per_dn: 0.5, bias_dn: 0").reader->read(even_light(200, 200, 0));
  EXPECT_GT(std::count(cut.clipped.begin(), cut.clipped.end(), 1), 15000);
}

TEST(Detectors, MessagesNameKeysAndRanges) {
  const auto told = [](const std::string& keys) { return message_of([&] { detector_of(keys); }); };
  EXPECT_THAT(told("kind: emcd, gain_e_per_dn: 1"), HasSubstr("did you mean 'emccd'"));
  EXPECT_THAT(told("kind: emccd, em_gain: 0.5, gain_e_per_dn: 1"), HasSubstr("detector.yaml:1"));
  EXPECT_THAT(told("kind: emccd, em_gain: 10, stage_probability: 0.01, gain_e_per_dn: 1"), HasSubstr("say the same"));
  EXPECT_THAT(told("kind: emccd, em_gain: 1.0e+5, stages: 2, gain_e_per_dn: 1"), HasSubstr("more stages"));
  EXPECT_THAT(told("kind: emccd, stage_probability: 0.5, gain_e_per_dn: 1"), HasSubstr("at most 1e5"));
  EXPECT_THAT(told("kind: scmos, read_noise_e: {median: 2, mean: 1}, gain_e_per_dn: 1"), HasSubstr("below the median"));
  EXPECT_THAT(told("kind: spad, frames: 3, dead_time_ns: 4"), HasSubstr("frames or dead_time_ns"));
  EXPECT_THAT(told("kind: spad, frames: 3, crosstalk: 0.5"), HasSubstr("0.2"));
  EXPECT_THAT(told("kind: spad"), HasSubstr("dead_time_ns"));
  EXPECT_THAT(told("kind: scmos"), HasSubstr("gain_e_per_dn"));
  EXPECT_THAT(told("kind: intensifier, gain_e_per_dn: 1"), HasSubstr("gain_e"));
  EXPECT_THAT(told("kind: scmos, gain_e_per_dn: 1, em_gain: 4"), HasSubstr("unknown key 'em_gain'"));
  EXPECT_THAT(told("kind: ingaas, gain_e_per_dn: 1, dark_current_e_s: 1.0e+11, temperature_k: 400, dark_doubling_k: 1"),
              HasSubstr("a lower temperature"));
}

}  // namespace
}  // namespace suite::detectors_test
