// Planck's law from 0.2 to 1000 um and 1 to 10 000 K against long double, its integrals against quadrature and against
// sigma T^4 / pi, and its inverse.
#include <gtest/gtest.h>

#include <cfloat>
#include <cmath>
#include <vector>

#include "math/vec.h"
#include "spectral/planck.h"

namespace suite::planck_test {

namespace {

long double reference(long double wavelength_um, long double kelvin) {
  const long double h = 6.62607015e-34L, c = 299792458.0L, k = 1.380649e-23L, m = wavelength_um * 1e-6L;
  return 2 * h * c * c / (m * m * m * m * m) / std::expm1(h * c / (m * k * kelvin)) * 1e-6L;
}

// Integral over [low, high] by 8-point Gauss-Legendre on pieces equal in the logarithm of wavelength.
long double reference_integral(long double low, long double high, long double kelvin) {
  static const long double node[4] = {0.1834346424956498049394761L, 0.5255324099163289858177390L,
                                      0.7966664774136267395915539L, 0.9602898564975362316835609L};
  static const long double weight[4] = {0.3626837833783619829651504L, 0.3137066458778872873379622L,
                                        0.2223810344533744705443560L, 0.1012285362903762591525314L};
  constexpr int kPieces = 600;
  const long double step = std::log(high / low) / kPieces;
  long double sum = 0;
  for (int p = 0; p < kPieces; ++p)
    for (int i = 0; i < 8; ++i) {
      const long double u = (p + 0.5L + (i < 4 ? 0.5L : -0.5L) * node[i % 4]) * step, w = low * std::exp(u);
      sum += weight[i % 4] * reference(w, kelvin) * w;
    }
  return sum * step / 2;
}

const std::vector<double> kKelvins{1, 2.725, 10, 50, 200, 288.15, 300, 1000, 3000, 5772, 10000};

}  // namespace

TEST(Planck, HoldsItsDigitsEverywhere) {
  for (double w = 0.2; w <= 1000; w *= 1.01)
    for (const double t : kKelvins) {
      const long double exact = reference(w, t);
      const double got = planck_radiance(w, t);
      ASSERT_TRUE(std::isfinite(got) && got >= 0);
      if (exact < 1e-290L) {  // about to underflow: absolute
        EXPECT_NEAR(got, static_cast<double>(exact), 1e-290 * 1e-10) << w << " " << t;
      } else {
        // x = h c / (w k T) is rounded to half an ulp, which is x ulp in e^-x; the rest is a few ulp.
        const double x = 14387.768775 / (w * t);
        EXPECT_NEAR(static_cast<double>(got / exact), 1, (6 + 2 * x) * DBL_EPSILON) << w << " " << t;
      }
    }
  EXPECT_EQ(planck_radiance(0.2, 1), 0);
  EXPECT_EQ(planck_radiance(10, 0), 0);
  EXPECT_GT(planck_radiance(0.2, 100.5), 0);  // x = 715: e^-x alone has lost its digits, the radiance has not
}

TEST(Planck, RayleighJeansAndWienLimits) {
  // 2 c k T / w^4 (1 - x/2 + x^2/12); 2 h c^2 / w^5 e^-x.
  const double x = 14387.768775 / (1000 * 10000.0);
  const double rayleigh = 2 * kSpeedOfLight * kBoltzmann * 10000 / std::pow(1000e-6, 4) * 1e-6;
  EXPECT_NEAR(planck_radiance(1000, 10000) / (rayleigh * (1 - x / 2 + x * x / 12)), 1, 1e-10);
  EXPECT_NEAR(planck_radiance(1, 300) / (1.191042972e8 * std::exp(-14387.768775 / 300)), 1, 1e-8);
}

TEST(Planck, PublishedValues) {
  // Peak of 300 K near 9.66 um; 9.924 W/(m2 sr um) at 10 um.
  EXPECT_NEAR(planck_radiance(10, 300), 9.924, 5e-4);
  double best = 0, peak = 0;
  for (double w = 9; w < 10.5; w += 1e-4)
    if (const double b = planck_radiance(w, 300); b > best) best = b, peak = w;
  EXPECT_NEAR(peak, 2897.771955 / 300, 2e-4);
}

TEST(PlanckBand, WholeSpectrumIsStefanBoltzmann) {
  for (const double t : kKelvins) {
    const double exact = kStefanBoltzmann * t * t * t * t / kPi;
    EXPECT_NEAR(planck_band_radiance(0, 1e12, t) / exact, 1, 1e-12) << t;
    EXPECT_NEAR(planck_band_radiance(1e-3, 1e12, t) / exact, 1, 1e-12) << t;
  }
}

TEST(PlanckBand, AgreesWithQuadratureForNarrowAndWideBands) {
  for (const double t : kKelvins)
    for (const double low : {0.2, 0.4, 1.0, 3.0, 8.0, 30.0, 300.0})
      for (const double ratio : {1 + 1e-6, 1.001, 1.04, 1.06, 1.5, 3.0, 30.0}) {
        const double high = low * ratio;
        const long double exact = reference_integral(low, high, t);
        if (exact < 1e-280L) continue;
        const double x = 14387.768775 / (high * t);
        // The rounding of x costs x ulp, and of a narrow band's width (ulp of the edge over the width).
        const double bound = 1e-12 + 4 * x * DBL_EPSILON + DBL_EPSILON / (ratio - 1);
        EXPECT_NEAR(static_cast<double>(planck_band_radiance(low, high, t) / exact), 1, bound)
            << t << " K, " << low << " to " << high;
      }
}

TEST(PlanckBand, AdjacentBandsAddUp) {
  for (const double t : {50.0, 300.0, 5772.0}) {
    double sum = 0;
    for (int i = 0; i < 100; ++i) sum += planck_band_radiance(3 + 0.1 * i, 3 + 0.1 * (i + 1), t);
    EXPECT_NEAR(sum / planck_band_radiance(3, 13, t), 1, 2e-12);
  }
  EXPECT_EQ(planck_band_radiance(5, 5, 300), 0);
  EXPECT_EQ(planck_band_radiance(5, 4, 300), 0);
  EXPECT_EQ(planck_band_radiance(5, 6, 0), 0);
}

TEST(Planck, BrightnessTemperatureInverts) {
  for (const double w : {0.2, 1.0, 4.0, 11.0, 100.0, 1000.0})
    for (const double t : kKelvins) {
      const double radiance = planck_radiance(w, t);
      if (radiance < 1e-290) continue;
      EXPECT_NEAR(brightness_temperature(w, radiance) / t, 1, 1e-12) << w << " " << t;
    }
}

}  // namespace suite::planck_test
