// Brightness temperatures of bands: they come back from the radiance of a blackbody, and are those of the exact band.
#include <gtest/gtest.h>

#include <cmath>

#include "spectral/planck.h"
#include "spectral/thermometer.h"

namespace suite::thermometer_test {
namespace {

TEST(Thermometer, TemperaturesComeBack) {
  const Band bands[] = {Band::gaussian("tir", 10.9, 0.6), Band::rectangular("wide", 11, 6),
                        Band::triangular("mwir", 4, 0.5), Band::gaussian("red", 0.65, 0.03),
                        Band::gaussian("microwave", 3000, 300)};
  for (const Band& b : bands) {
    const BandThermometer t(b);
    for (double kelvin = 1.01 * t.lowest_k(); kelvin < t.highest_k(); kelvin *= 1.0137)
      ASSERT_NEAR(t.read(t.radiance(kelvin)).kelvin / kelvin, 1, 1e-8) << b.name << " " << kelvin;
  }
}

// The exact radiance of rectangular bands is known by other means (series of the fractional function).
TEST(Thermometer, ARectangularBandIsExact) {
  for (const auto& [centre, width] : {std::pair{11.0, 6.0}, std::pair{4.0, 0.5}, std::pair{0.7, 0.2}}) {
    const BandThermometer t(Band::rectangular("band", centre, width));
    for (const double kelvin : {200.0, 300.0, 1200.0, 5772.0}) {
      const double exact = planck_band_radiance(centre - width / 2, centre + width / 2, kelvin) / width;
      EXPECT_NEAR(t.read(exact).kelvin / kelvin, 1, 1e-7) << centre << " " << kelvin;
    }
  }
}

// A narrow band has the temperature of its wavelength; a wide one has not, which is why there is a band's own.
TEST(Thermometer, NarrowBandsAreWavelengthsAndWideOnesAreNot) {
  const BandThermometer narrow(Band::rectangular("n", 11, 0.001)), wide(Band::rectangular("w", 11, 6));
  EXPECT_NEAR(narrow.read(planck_radiance(11, 300)).kelvin, 300, 1e-5);
  EXPECT_GT(std::fabs(brightness_temperature(11, wide.radiance(300)) - 300), 0.5);
}

TEST(Thermometer, TheSlopeIsTheDerivative) {
  const BandThermometer t(Band::gaussian("tir", 10.9, 0.6));
  for (const double kelvin : {80.0, 300.0, 2500.0}) {
    const double low = t.radiance(kelvin * (1 - 1e-4)), high = t.radiance(kelvin * (1 + 1e-4));
    EXPECT_NEAR(t.read(t.radiance(kelvin)).slope * (high - low) / (2e-4 * kelvin), 1, 1e-6) << kelvin;
  }
}

TEST(Thermometer, WhatNoBlackbodySendsIsNotANumber) {
  const BandThermometer t(Band::gaussian("tir", 10.9, 0.6));
  for (const double radiance : {0.0, -1.0, t.radiance(9), t.radiance(21000), double(NAN)}) {
    EXPECT_TRUE(std::isnan(t.read(radiance).kelvin)) << radiance;
    EXPECT_TRUE(std::isnan(t.read(radiance).slope)) << radiance;
  }
  EXPECT_NEAR(t.lowest_k(), 10, 1e-9);
  EXPECT_GT(BandThermometer(Band::gaussian("blue", 0.45, 0.05)).lowest_k(), 40);
}

}  // namespace
}  // namespace suite::thermometer_test
