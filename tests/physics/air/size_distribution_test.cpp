// Crowds of spheres: closed forms of their moments and limits, published aerosols and drops.
#include "air/size_distribution.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/error.h"
#include "math/vec.h"

namespace suite::size_distribution_test {
namespace {

TEST(SizeDistribution, HasTheMomentsOfItsKind) {
  // <r^k> of a log-normal distribution: median^k exp(k^2 s^2 / 2).
  const double median = 0.07, s = 0.5;
  const SizeDistribution normal = SizeDistribution::log_normal(median, std::exp(s));
  for (const double k : {2.0, 3.0, 4.0})
    EXPECT_NEAR(normal.moment(k) / (std::pow(median, k) * std::exp(k * k * s * s / 2)), 1, 1e-3) << k;
  EXPECT_NEAR(normal.effective_radius_um(), median * std::exp(2.5 * s * s), 1e-4 * median);
  for (const double variance : {0.02, 0.1, 0.2}) {
    const SizeDistribution gamma = SizeDistribution::gamma(10, variance);
    EXPECT_NEAR(gamma.effective_radius_um(), 10, 1e-3) << variance;
    EXPECT_NEAR(gamma.effective_variance(), variance, 1e-3 * variance);
    EXPECT_NEAR(gamma.moment(0), 1, 1e-12);
  }
  // r exp(-18 r): Gamma(4 + 1) / Gamma(3 + 1) / 18 by hand.
  EXPECT_NEAR(SizeDistribution::modified_gamma(1, 18, 1).effective_radius_um(), 4.0 / 18, 1e-5);
  const SizeDistribution junge = SizeDistribution::junge(3, 0.1, 10);
  EXPECT_NEAR(junge.effective_radius_um(), std::log(100.0) / (1 / 0.1 - 1 / 10.0), 1e-4);
  EXPECT_NEAR(junge.density(1) / junge.density(2), 16, 1e-12);
}

TEST(SizeDistribution, ScattersAsItsSixthMomentWhenSmall) {
  const SizeDistribution sizes = SizeDistribution::gamma(1e-3, 0.1);
  const double wavelength = 10, wavenumber = 2 * kPi / wavelength;
  const std::complex<double> m(1.5, 0.02), c = (m * m - 1.0) / (m * m + 2.0);
  const BulkOptics bulk = bulk_optics(sizes, m, wavelength);
  EXPECT_NEAR(bulk.scattering_um2 / (8 * kPi / 3 * std::pow(wavenumber, 4) * std::norm(c) * sizes.moment(6)), 1, 1e-3);
  EXPECT_NEAR(bulk.absorption_um2 / (4 * kPi * wavenumber * c.imag() * sizes.moment(3)), 1, 1e-4);
  EXPECT_NEAR(bulk.asymmetry, 0, 1e-5);
}

TEST(SizeDistribution, ShadesTwiceItsShadowWhenLarge) {
  const SizeDistribution sizes = SizeDistribution::gamma(500, 0.1);
  const BulkOptics bulk = bulk_optics(sizes, {1.33, 0.01}, 0.5, {}, 1e-3);
  const double shadow = kPi * sizes.moment(2), x = 2 * kPi * 500 / 0.5;
  EXPECT_NEAR(bulk.extinction_um2 / shadow, 2 + 1.99 * std::pow(x, -2.0 / 3), 3e-3);
}

TEST(SizeDistribution, PowerLawOfRadiiIsOneOfWavelengths) {
  // Between radii that do not matter, extinction goes as wavelength^(2 - exponent): Junge 1963.
  const SizeDistribution sizes = SizeDistribution::junge(3.3, 1e-3, 200);
  const double a = bulk_optics(sizes, {1.5, 0}, 0.5).extinction_um2, b = bulk_optics(sizes, {1.5, 0}, 1).extinction_um2;
  EXPECT_NEAR(std::log(a / b) / std::log(2.0), 1.3, 0.01);
}

TEST(SizeDistribution, KeepsAllLightWithoutAbsorption) {
  EXPECT_EQ(bulk_optics(SizeDistribution::gamma(5, 0.1), {1.33, 0}, 0.5, {}, 1e-3).albedo(), 1);
}

// Shettle & Fenn's rural aerosol at 0 % humidity by their sizes and indices; albedo, asymmetry and extinction over that
// at 0.55 um as in LOWTRAN 7's block data (RURE1, RURA1, RURG1).
TEST(SizeDistribution, GivesThePublishedRuralAerosol) {
  struct Case {
    double wavelength, n, k, extinction, albedo, asymmetry;
  };
  double green = 0;
  for (const Case& c : {Case{0.55, 1.53, 6.6e-3, 1, 0.9407, 0.6479}, {0.2, 1.53, 0.07, 2.09291, 0.67894, 0.7581}}) {
    const BulkOptics small =
                         bulk_optics(SizeDistribution::log_normal(0.027, std::pow(10, 0.35)), {c.n, c.k}, c.wavelength),
                     large =
                         bulk_optics(SizeDistribution::log_normal(0.43, std::pow(10, 0.4)), {c.n, c.k}, c.wavelength);
    const double share = 0.000125, extinction = (1 - share) * small.extinction_um2 + share * large.extinction_um2,
                 scattering = (1 - share) * small.scattering_um2 + share * large.scattering_um2;
    if (c.wavelength == 0.55) green = extinction;
    EXPECT_NEAR(extinction / green, c.extinction, 2e-3 * c.extinction) << c.wavelength;
    EXPECT_NEAR(scattering / extinction, c.albedo, 3e-4) << c.wavelength;
    EXPECT_NEAR(
        ((1 - share) * small.scattering_um2 * small.asymmetry + share * large.scattering_um2 * large.asymmetry) /
            scattering,
        c.asymmetry, 3e-4)
        << c.wavelength;
  }
}

// ECMWF's ecRad, mie_droplet_scattering.nc (gamma distribution of shape 2 over the diameter, variance 1/5), effective
// radius 10 um, 0.5508 um; index: Segelstein's. ecRad's own index is not recorded: 0.002 of it are 0.001 of the
// asymmetry.
TEST(SizeDistribution, GivesTheDropsOfEcRad) {
  const std::complex<double> water(1.33593, 2.46e-9);
  const BulkOptics bulk = bulk_optics(SizeDistribution::gamma(10, 0.2), water, 0.5508, {}, 3e-4);
  EXPECT_NEAR(bulk.mass_extinction(1000) / 157.214, 1, 2e-3);
  EXPECT_NEAR(bulk.asymmetry, 0.86218, 1.5e-3);
  // Negative control: 1 % of the radius is seen.
  const BulkOptics larger = bulk_optics(SizeDistribution::gamma(10.1, 0.2), water, 0.5508, {}, 3e-4);
  EXPECT_GT(std::abs(larger.mass_extinction(1000) / 157.214 - 1), 5e-3);
}

TEST(SizeDistribution, RefusesWhatIsNone) {
  EXPECT_THROW(SizeDistribution::log_normal(-0.1, 2), Error);
  EXPECT_THROW(SizeDistribution::log_normal(0.1, 1), Error);
  EXPECT_THROW(SizeDistribution::gamma(0, 0.1), Error);
  EXPECT_THROW(SizeDistribution::gamma(10, 0.5), Error);
  EXPECT_THROW(SizeDistribution::modified_gamma(1, -18, 1), Error);
  EXPECT_THROW(SizeDistribution::junge(3, 1, 0.5), Error);
  EXPECT_THROW(bulk_optics(SizeDistribution::gamma(10, 0.1), {1.33, -1}, 0.5), Error);
  EXPECT_THROW(bulk_optics(SizeDistribution::gamma(10, 0.1), {1.33, 0}, -0.5), Error);
}

}  // namespace
}  // namespace suite::size_distribution_test
