// The laws that the builtin gases have in place of LOWTRAN's: what they are, and where.
#include "air/band_fits.h"

#include <gtest/gtest.h>

#include <cmath>

#include "air/lowtran.h"

namespace suite::band_fits_test {
namespace {

double through(size_t law, double s) {
  const std::span<const double> points = band_law(law);
  double sum = 0, weights = 0;
  for (size_t i = 0; i < kBandLawPoints; ++i) {
    sum += points[kBandLawPoints + i] * std::exp(-points[i] * s);
    weights += points[kBandLawPoints + i];
  }
  return sum / weights;
}

// Each lets half of the light through at s = 1, and a band's absorption grows more slowly than the amount, faster than
// nothing.
TEST(BandFits, LawsHalveAtOne) {
  for (int v = 500; v < 16000; v += 5)
    for (const Gas gas : {Gas::h2o, Gas::co2, Gas::ch4})
      if (const BandFit* fit = band_fit(gas, v)) {
        EXPECT_NEAR(through(fit->law, 1), 0.5, 0.001) << v;
        const double once = -std::log(through(fit->law, 0.01)), twice = -std::log(through(fit->law, 0.02));
        EXPECT_LT(twice, 2 * once) << v;
        EXPECT_GT(twice, 1.2 * once) << v;
      }
}

TEST(BandFits, HoldWhereTheyWereFitted) {
  EXPECT_EQ(band_fit(Gas::h2o, 2385), nullptr);
  ASSERT_NE(band_fit(Gas::h2o, 2390), nullptr);
  EXPECT_NE(band_fit(Gas::h2o, 2675), band_fit(Gas::h2o, 2680));
  EXPECT_EQ(band_fit(Gas::h2o, 2885), nullptr);
  EXPECT_EQ(band_fit(Gas::n2o, 2390), nullptr);
}

TEST(BandFits, ContinuumFactorsAreSmooth) {
  ContinuumFactors last = continuum_factors(0);
  for (double v = 5; v < 20000; v += 5) {
    const ContinuumFactors f = continuum_factors(v);
    for (const double ratio : {f.self_296 / last.self_296, f.self_260 / last.self_260, f.foreign / last.foreign})
      EXPECT_NEAR(std::log(ratio), 0, 0.1) << v;
    last = f;
  }
  EXPECT_EQ(continuum_factors(0).foreign, continuum_factors(400).foreign);
  EXPECT_EQ(continuum_factors(20000).self_296, continuum_factors(15000).self_296);
}

// 1 km of air with 1 g/cm2 of water at 2.11 um: LOWTRAN takes three times as much by lines as the builtin gases.
TEST(BandFits, WeakLinesTakeLessThanLowtransDo) {
  std::vector<AirLevel> levels(2);
  levels[0] = {0, 95000, 291, {}}, levels[1] = {1000, 95000, 291, {}};
  for (AirLevel& l : levels) l.share(Gas::h2o) = 0.0145;
  const auto lines = [&](const GasProvider& gases) {
    const GasPoints p = gases.absorbers(gases.bands(4740, 4741).front(), levels).at(1);
    double sum = 0;
    for (size_t g = 0; g < p.count(); ++g) sum += p.weight[g] * std::exp(-1000 * static_cast<double>(p.absorption[g]));
    return 1 - sum;
  };
  EXPECT_GT(lines(lowtran_gases()), 2 * lines(builtin_gases()));
  EXPECT_GT(lines(builtin_gases()), 0.002);
}

}  // namespace
}  // namespace suite::band_fits_test
