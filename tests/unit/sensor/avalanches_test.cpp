// Single-photon avalanche diodes and image intensifiers against closed forms. Seeds are fixed; the limit is 4.5
// standard errors, and beside it stands a hypothesis that has to fail.
#include <gtest/gtest.h>

#include <cmath>

#include "math/stats.h"
#include "sensor/detectors/disk.h"
#include "spectral/photopic.h"
#include "support/detector_kit.h"

namespace suite::avalanches_test {
namespace {

using test::detector_of;
using test::even_light;
using test::expect_moments;
using test::kSure;
using test::snr;
using test::stats_of;

// 1-bit frames: counts are binomial; without a neighbour that triggers, as without cross-talk.
TEST(Spad, FramesOfOneBit) {
  const std::vector<double> counts =
      detector_of("kind: spad, frames: 50, seed: 2").reader->read(even_light(200, 200, 20)).counts;
  const double P = -std::expm1(-0.4);
  expect_moments(counts, 50 * P, 50 * P * (1 - P));
  EXPECT_GT(std::fabs(stats_of(counts).mean() - 20), 1) << "negative control: without saturation";
  const std::vector<double> one =
      detector_of("kind: spad, frames: 50, crosstalk: 1.0e-12").reader->read(even_light(60, 60, 20)).counts;
  expect_moments(one, 50 * P, 50 * P * (1 - P));
  // At a low rate a click makes 4 c others, each 3 c more (the fourth neighbour has fired): 1 + 4 c + 12 c^2 to c^3.
  const double c = 0.02, n = 0.5;
  const RunningStats s =
      stats_of(detector_of("kind: spad, frames: 500, crosstalk: 0.02").reader->read(even_light(100, 100, n)).counts);
  EXPECT_NEAR(s.mean() / n, 1 + 4 * c + 12 * c * c, kSure * std::sqrt(1.3 / n / 10000) + 0.003);
}

// Mean and variance of counts behind a dead time, n / (1 + n tau) and n / (1 + n tau)^3 of long exposures (Knoll).
TEST(Spad, DeadTime) {
  const auto d = detector_of("kind: spad, dead_time_ns: 1.0e+6, dark_rate_hz: 100, seed: 6");
  const double n = 600, blind = 1 + n * 1e-3;
  expect_moments(d.reader->read(even_light(120, 120, 500)).counts, n / blind + 0.5 * (0.6 / blind) * (0.6 / blind),
                 n / (blind * blind * blind));
  const double many = 2e4;  // beyond 4096 counts they are normal
  const auto fast = detector_of("kind: spad, dead_time_ns: 1.0e+5");
  expect_moments(fast.reader->read(even_light(60, 60, many)).counts, many / (1 + many * 1e-4),
                 many / std::pow(1 + many * 1e-4, 3) + 1.0 / 12);
  const ArrayReading full = detector_of("kind: spad, dead_time_ns: 0, bits: 8").reader->read(even_light(4, 4, 1000));
  EXPECT_EQ(full.counts[3], 255);
  EXPECT_TRUE(full.clipped[3]);
}

TEST(Disk, KeepsTheLight) {
  constexpr uint32_t n = 101;
  std::vector<double> light(n * n, 0);
  light[50 * n + 50] = 1;
  for (const double radius : {0.3, 4.0, 20.5}) {
    const std::vector<double> out = over_disk(light, n, {radius, radius}, 0.04);
    double sum = 0, second = 0;
    for (size_t i = 0; i < out.size(); ++i) {
      const double x = static_cast<double>(i % n) - 50, y = static_cast<double>(i / n) - 50;
      sum += out[i], second += out[i] * (x * x + y * y);
    }
    EXPECT_NEAR(sum, 1, 1e-12) << radius;
    if (radius > 1) {
      EXPECT_NEAR(second / (0.04 * radius * radius / 2), 1, 0.04) << radius;  // of an even disk R^2 / 2
      EXPECT_NEAR(out[50 * n + 50 + 3], 0.04 / (kPi * radius * radius), 1e-12);
      EXPECT_EQ(out[50 * n + 50 + static_cast<size_t>(radius) + 2], 0) << "sharp edge";
    }
  }
}

const std::string kTube = "kind: intensifier, gain_e: 200, gain_e_per_dn: 1, bias_dn: 0, read_noise_e: 0, ";

// Camera electrons: mean n g, variance g^2 F^2 n + g n (Poisson of the camera), while spots stay in their pixels.
TEST(Intensifier, PulseHeights) {
  for (const double n : {0.2, 3.0, 100.0}) {
    const auto d = detector_of(kTube + "pulse_excess: 1.6");
    const std::vector<double> dn = d.reader->read(even_light(200, 200, n)).dn;
    expect_moments(dn, 200 * n, 200 * 200 * 1.6 * n + 200 * n, 3 + 4 / n);
    EXPECT_GT(std::fabs(stats_of(dn).variance() / (200 * 200 * n) - 1), 0.3)
        << "negative control: without pulse heights";
  }
  const double f2 = 1.6, n = 4;
  EXPECT_NEAR(snr("kind: intensifier, gain_e: 1.0e+6, gain_e_per_dn: 1, pulse_excess: 1.6", n),
              std::sqrt(n / (f2 + 1e-6)), 1e-9);
}

// Spots and halo move light about; none is lost but at the edges.
TEST(Intensifier, SpotsAndHaloKeepTheLight) {
  const auto d = detector_of(kTube + "halo: {share: 0.03, radius_um: 150}, phosphor: {blur_um: 12}");
  ArrayLight light = even_light(101, 101, 0);
  light.electrons[50 * 101 + 50] = 50000;
  const auto dim = detector_of(
      "kind: intensifier, gain_e: 0.5, gain_e_per_dn: 0.5, bias_dn: 0, halo: {share: 0.03, "
      "radius_um: 150}, phosphor: {blur_um: 12}, pulse_excess: 1");
  const ArrayReading r = dim.reader->read(light);
  double sum = 0, far = 0;
  for (size_t i = 0; i < r.dn.size(); ++i) {
    const double x = static_cast<double>(i % 101) - 50, y = static_cast<double>(i / 101) - 50;
    sum += 0.5 * r.dn[i];
    if (x * x + y * y > 64) far += 0.5 * r.dn[i];
  }
  EXPECT_NEAR(sum, 25000, kSure * std::sqrt(25000 + 0.25 * 50000));
  EXPECT_NEAR(far / 25000, 0.03 * (1 - 64 / 225.0), 0.003);
  // Single events: twenty photoelectrons are at most twenty spots, and few pixels are lit.
  ArrayLight few = even_light(64, 64, 20.0 / 4096);
  const ArrayReading events = d.reader->read(few);
  double lit = 0;
  for (const double dn : events.dn) lit += dn > 4;
  EXPECT_GT(lit, 20);
  EXPECT_LT(lit, 40 * 25);
}

// 2e-7 lx of a lamp of 2856 K on a photocathode of 1000 uA/lm and 10 um pixels: E A S / e.
TEST(Intensifier, BackgroundIllumination) {
  const Curve qe({0.3, 0.9, 0.901}, {0.3, 0.3, 0}, Outside::zero);
  const auto d = detector_of(
      "kind: intensifier, gain_e: 10, gain_e_per_dn: 1, pulse_excess: 1, background_lx: 1.0e-3, quantum_efficiency: "
      "{wavelength_um: [0.3, 0.9, 0.901], value: [0.3, 0.3, 0]}");
  // Sum of its own over the same spectrum, in steps of 1 nm.
  double electrons = 0;
  std::vector<double> um, lamp;
  for (int i = 0; i <= 2700; ++i) {
    um.push_back(0.3 + 0.001 * i);
    const double x = 14387.768775 / (um.back() * 2856);
    lamp.push_back(std::pow(um.back(), -5) / std::expm1(x));
    if (um.back() <= 0.9) electrons += 0.3 * lamp.back() * um.back() * 1e-3;
  }
  const double per_lumen = electrons / photopic(Curve(um, lamp, Outside::zero)) * 1e-6 / (6.62607015e-34 * 299792458.0);
  EXPECT_NEAR(d.reader->noise(1, 1e-10).constant / (1e-3 * 1e-10 * per_lumen), 1, 0.02);
  const double n = 1e-3 * 1e-10 * per_lumen;
  const double read = stats_of(d.reader->read(even_light(100, 100, 0)).dn).mean() - 100;
  EXPECT_NEAR(read / (10 * n), 1, kSure / std::sqrt(n * 1e4) + 0.02);
  std::printf("photocathode of 30 %%, 0.3 to 0.9 um: %.0f uA/lm\n", n / 1e-13 * 1.602176634e-13);
}

// Light left over: of frames T apart with exposure t, sum over all frames of the share is 1 - what falls between them.
TEST(Intensifier, PhosphorDecay) {
  const auto d = detector_of(kTube + "pulse_excess: 1, phosphor: {decay_ms: 500}");
  ArrayLight light = even_light(100, 100, 50);
  light.exposure = 1, light.period = 1, light.before = 0;
  const double own = 1 - 0.5 * -std::expm1(-2.0), first = stats_of(d.reader->read(light).dn).mean();
  EXPECT_NEAR(first / (200 * 50 * own), 1, 0.01);
  light.before = 12, light.read_out = 12;  // frames without a gap: in the end all light is seen
  EXPECT_NEAR(stats_of(d.reader->read(light).dn).mean() / (200 * 50), 1, 0.01);
  // What is left over from a frame is of that frame's own photoelectrons.
  light.before = 1, light.read_out = 1;
  const std::vector<double> next = d.reader->read(light).dn;
  light.before = 0, light.read_out = 0;
  const std::vector<double> before = d.reader->read(light).dn;
  const RunningStats a = stats_of(before), b = stats_of(next);
  double together = 0;
  for (size_t i = 0; i < before.size(); ++i) together += (before[i] - a.mean()) * (next[i] - b.mean()) / 1e4;
  EXPECT_GT(together / std::sqrt(a.variance() * b.variance()), 0.2);
}

TEST(Intensifier, AutoGatingHoldsTheMean) {
  const auto d = detector_of(kTube + "auto_gate_e_s: 10");
  EXPECT_NEAR(stats_of(d.reader->read(even_light(100, 100, 80)).dn).mean(), 2000, 30);
  EXPECT_NEAR(stats_of(d.reader->read(even_light(100, 100, 5)).dn).mean(), 1000, 20);
}

}  // namespace
}  // namespace suite::avalanches_test
