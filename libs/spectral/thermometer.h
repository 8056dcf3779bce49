// Brightness temperature of a band: the temperature of the blackbody whose radiance, averaged over the band's response,
// is the one given. (brightness_temperature of planck.h is that of a single wavelength.)
//
// Method: Gauss-Legendre over every piece of the response, tabulated over ln T in steps of 1/64; between the rows 1/T
// is a cubic of the radiance's logarithm with the exact slopes. Temperatures come back within 1e-8 of themselves
// (tests/unit/spectral/thermometer_test.cpp).
#pragma once
#include <vector>

#include "spectral/state.h"

namespace suite {

class BandThermometer {
 public:
  explicit BandThermometer(const Band& band);
  // W/(m2 sr um) of a blackbody, the mean over the response.
  double radiance(double kelvin) const;
  // Kelvin of a radiance in W/(m2 sr um), and the slope dT/dL in K per W/(m2 sr um). Both NaN for radiances that no
  // blackbody between lowest_k() and highest_k() sends, zero and negative ones among them.
  struct Reading {
    double kelvin, slope;
  };
  Reading read(double radiance) const;
  // 10 K (more where a radiance would be below 1e-250) and 20 000 K.
  double lowest_k() const { return 1 / rows_.front().inverse; }
  double highest_k() const { return 1 / rows_.back().inverse; }

 private:
  struct Node {
    double wavelength_um, weight;
  };
  struct Row {
    double logarithm, inverse, slope;  // ln L, 1/T, d(1/T)/d(ln L)
  };
  std::vector<Node> nodes_;
  std::vector<Row> rows_;
};

}  // namespace suite
