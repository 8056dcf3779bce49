// Colours and power of the lamps' spectra.
#include "spectral/lamp_spectra.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "spectral/photopic.h"
#include "spectral/planck.h"

namespace suite::test::lamp_spectra_test {
namespace {

// CIE 1931 colour matching functions as sums of Gaussians: C. Wyman, P. Sloan, P. Shirley, "Simple analytic
// approximations to the CIE XYZ color matching functions", J. Computer Graphics Techniques 2(2), 2013.
double lobe(double nm, double middle, double below, double above) {
  const double t = (nm - middle) * (nm < middle ? below : above);
  return std::exp(-0.5 * t * t);
}
template <class Spectrum>
std::array<double, 2> chromaticity(const Spectrum& s) {
  double x = 0, y = 0, z = 0;
  for (int n = 380; n <= 780; ++n) {
    const double v = s(1e-3 * n);
    x += v * (1.056 * lobe(n, 599.8, 0.0264, 0.0323) + 0.362 * lobe(n, 442.0, 0.0624, 0.0374) -
              0.065 * lobe(n, 501.1, 0.0490, 0.0382));
    y += v * (0.821 * lobe(n, 568.8, 0.0213, 0.0247) + 0.286 * lobe(n, 530.9, 0.0613, 0.0322));
    z += v * (1.217 * lobe(n, 437.0, 0.0845, 0.0278) + 0.681 * lobe(n, 459.0, 0.0385, 0.0725));
  }
  return {x / (x + y + z), y / (x + y + z)};
}
std::array<double, 2> colour_of(const std::string& lamp) {
  const Curve spectrum = lamp_spectrum(lamp);
  return chromaticity([&](double um) { return spectrum.at(um); });
}
// C. S. McCamy, "Correlated color temperature as an explicit function of chromaticity coordinates", 1992.
double temperature(const std::array<double, 2>& c) {
  const double n = (c[0] - 0.3320) / (0.1858 - c[1]);
  return ((449 * n + 3525) * n + 6823.3) * n + 5520.33;
}

TEST(LampSpectra, LedsLieOnPlancksLocus) {
  for (const int kelvin : {2700, 3000, 4000, 5000}) {
    const auto led = colour_of("led_" + std::to_string(kelvin)),
               black = chromaticity([&](double um) { return planck_radiance(um, kelvin); });
    EXPECT_NEAR(led[0], black[0], 0.002) << kelvin;
    EXPECT_NEAR(led[1], black[1], 0.002) << kelvin;
    EXPECT_NEAR(temperature(led), kelvin, 0.02 * kelvin);
  }
  EXPECT_GT(std::fabs(colour_of("led_2700")[0] - colour_of("led_3000")[0]), 0.01);
}

TEST(LampSpectra, DischargeLampsHaveTheirColours) {
  EXPECT_NEAR(temperature(colour_of("sodium")), 1950, 100);
  EXPECT_NEAR(temperature(colour_of("metal_halide")), 3600, 300);
  EXPECT_NEAR(temperature(colour_of("mercury")), 3800, 300);
}

// One watt each, and lumens a watt of visible light below the eye's 683.
TEST(LampSpectra, SendOneWatt) {
  ASSERT_EQ(lamp_names().size(), 7u);
  for (const std::string& name : lamp_names()) {
    const Curve spectrum = lamp_spectrum(name);
    EXPECT_NEAR(spectrum.integral(0.35, 0.85), 1, 1e-12) << name;
    EXPECT_GE(spectrum.min(), 0) << name;
    EXPECT_GT(photopic(spectrum), 250) << name;
    EXPECT_LT(photopic(spectrum), 500) << name;
  }
}

}  // namespace
}  // namespace suite::test::lamp_spectra_test
