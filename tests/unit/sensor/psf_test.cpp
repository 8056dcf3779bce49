// Point-spread functions by the light within a radius.
#include "sensor/psf.h"

#include <gtest/gtest.h>

#include <cmath>

namespace suite::psf_test {
namespace {

double radius(const PointSpread& psf, double share) {
  const Vec2 at = psf.sample(share, 0.3, 0.5);
  return std::hypot(at.x, at.y);
}

// Within r is 1 - exp(-r^2 / (2 sigma^2)) of the light.
TEST(PointSpread, GaussianHoldsItsShareWithinSigma) {
  const auto psf = gaussian_spread(3e-6);
  for (const double times : {0.5, 1.0, 2.0})
    EXPECT_NEAR(radius(*psf, 1 - std::exp(-times * times / 2)) / 3e-6, times, 1e-9);
}

// Light within the first dark ring of an annular aperture: D. J. Schroeder, Astronomical Optics, 2nd edition, 2000,
// table 10.2: ring at 1.22, 1.00 wavelengths x f-number, share 0.838, 0.479 for obscurations of 0, 0.5; told there to
// three digits.
TEST(PointSpread, AiryHoldsItsShareWithinTheFirstDarkRing) {
  const std::vector<Band> green{Band::rectangular("green", 0.5, 0.002)};
  const SpectralState state = make_state(green, 0.002, 0.5, 1);
  const double um = state.bins[0].center_um();
  const struct { double obscuration, ring, share; } rows[] = {{0, 1.2197, 0.838}, {0.5, 1.000, 0.479}};
  for (const auto& row : rows) {
    const auto psf = airy_spread(8, row.obscuration, 0.005, state);
    double low = 0, high = 1;
    for (int i = 0; i < 50; ++i) {
      const double middle = (low + high) / 2;
      (radius(*psf, middle) < row.ring * um * 1e-6 * 8 ? low : high) = middle;
    }
    EXPECT_NEAR(low * (1 - psf->cut()), row.share, 1.5e-3) << row.obscuration;
  }
}

}  // namespace
}  // namespace suite::psf_test
