// Wind waves against closed forms of their spectra and published figures.
#include "water/waves.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "math/stats.h"
#include "math/vec.h"

namespace suite::waves_test {
namespace {

SeaState sea(WaveSpectrum spectrum, double wind, double fetch = 1e6) { return {spectrum, wind, fetch, 0.4, 1e4}; }
constexpr double kGravity = 9.80665;

TEST(WaveSpectrum, PiersonMoskowitzHasItsClosedFormVariance) {
  for (const double wind : {5.0, 10.0, 20.0}) {
    // alpha g^2 / (4 beta w0^4), and the significant height 0.21 U^2 / g of the wind at 19.5 m.
    const double u = 1.026 * wind, w0 = kGravity / u,
                 truth = 8.1e-3 * kGravity * kGravity / (4 * 0.74 * std::pow(w0, 4));
    const double m0 = height_variance(sea(WaveSpectrum::pierson_moskowitz, wind), 1e-4, kShortestWave);
    EXPECT_NEAR(m0 / truth, 1, 1e-4);
    EXPECT_NEAR(4 * std::sqrt(m0) * kGravity / (u * u), 0.21, 0.002);
  }
}

TEST(WaveSpectrum, JonswapHasItsVariance) {
  // alpha g^2 / (5 peak^4) over 1 - 0.287 ln 3.3 (DNV-RP-C205, section 3.5.5; valid within 1 %).
  for (const double fetch : {1e4, 1e5}) {
    const SeaState s = sea(WaveSpectrum::jonswap, 10, fetch);
    const double level = 0.076 * std::pow(100 / (fetch * kGravity), 0.22),
                 peak = 22 * std::cbrt(kGravity * kGravity / (10 * fetch));
    const double truth = level * kGravity * kGravity / (5 * std::pow(peak, 4)) / (1 - 0.287 * std::log(3.3));
    EXPECT_NEAR(height_variance(s, 1e-4, kShortestWave) / truth, 1, 0.01) << fetch;
    EXPECT_NEAR(std::sqrt(kGravity * peak_wave_number(s)), peak, 1e-9);
  }
}

TEST(WaveSpectrum, ElfouhailyHasTheSlopesOfCoxAndMunk) {
  // They made it so; clean sea: 0.003 + 0.00512 wind.
  for (const double wind : {5.0, 10.0, 14.0})
    EXPECT_NEAR(slope_variance(sea(WaveSpectrum::elfouhaily, wind), 1e-4, kShortestWave) / (0.003 + 0.00512 * wind), 1,
                0.2)
        << wind;
  // Significant height of the fully grown sea at 10 m/s: 2.2 to 2.8 m (0.21 to 0.26 U^2 / g).
  const double m0 = height_variance(sea(WaveSpectrum::elfouhaily, 10, 1e7), 1e-4, kShortestWave);
  EXPECT_NEAR(4 * std::sqrt(m0), 2.5, 0.3);
}

TEST(Waves, HaveTheVarianceAndSlopesOfTheSpectrum) {
  const SeaState s = sea(WaveSpectrum::elfouhaily, 8);
  const double shortest = 3, longest = 0.2 * peak_wave_number(s);
  const Waves waves(s, shortest, 800, 5);
  EXPECT_NEAR(waves.variance() / height_variance(s, longest, shortest), 1, 2e-3);
  std::vector<float> row(500);
  waves.row(-30, 7, 0.2, 3, row);
  for (size_t i = 0; i < row.size(); ++i) EXPECT_NEAR(row[i], waves.height(-30 + 0.2 * double(i), 7, 3), 1e-6);
  // In places far apart, heights and differences over 5 cm; 4 standard errors at 1e-4.
  RunningStats height2, slope2;
  for (int i = 0; i < 4000; ++i) {
    const double x = 997.0 * i, y = 1777.0 * (i % 63), h = waves.height(x, y, 3);
    height2.add(h * h);
    const double dx = (waves.height(x + 0.05, y, 3) - h) / 0.05, dy = (waves.height(x, y + 0.05, 3) - h) / 0.05;
    slope2.add(dx * dx + dy * dy);
  }
  EXPECT_NEAR(height2.mean(), waves.variance(), 4 * height2.stderr_of_mean());
  EXPECT_NEAR(slope2.mean(), slope_variance(s, longest, shortest), 4 * slope2.stderr_of_mean() + 0.01 * slope2.mean());
}

// One wave travels with its phase speed, with the wind; in shallow water at the root of g times depth.
TEST(Waves, MoveByDispersion) {
  SeaState s = sea(WaveSpectrum::pierson_moskowitz, 10);
  EXPECT_NEAR(wave_frequency(s, 0.1), std::sqrt(kGravity * 0.1), 1e-5);
  EXPECT_NEAR(wave_frequency(s, 370) / 370, std::sqrt(2 * kGravity / 370), 1e-9);  // the slowest: 0.23 m/s
  s.depth_m = 0.5;
  EXPECT_NEAR(wave_frequency(s, 0.01) / 0.01, std::sqrt(kGravity * 0.5), 1e-4);
  // The field is most like itself a moment later where the waves of the peak have carried it, downwind.
  const SeaState deep = sea(WaveSpectrum::pierson_moskowitz, 10);
  const Waves waves(deep, 0.2, 400, 1);
  const double speed = wave_frequency(deep, peak_wave_number(deep)) / peak_wave_number(deep), t = 0.5;
  double with = 0, against = 0;
  for (int i = 0; i < 2000; ++i) {
    const double x = 613.0 * i, y = 271.0 * (i % 41), h = waves.height(x, y, 0);
    const double dx = speed * t * std::cos(0.4), dy = speed * t * std::sin(0.4);
    with += h * waves.height(x + dx, y + dy, t), against += h * waves.height(x - dx, y - dy, t);
  }
  EXPECT_GT(with, 1.05 * against);
}

}  // namespace
}  // namespace suite::waves_test
