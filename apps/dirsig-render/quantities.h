// Radiance as the quantity and in the units that were asked for.
#pragma once
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "facts.h"
#include "sensor/delivery.h"
#include "spectral/thermometer.h"

namespace suite {

// "radiance", for descriptions, and the unit of the numbers.
struct QuantityText {
  std::string name, unit;
};
QuantityText text_of(Quantity quantity, OutputSpec::Units units);

// Turns the numbers of one capture. Radiance: times what the units want. Reflectance: pi L / (E cos), E the band's mean
// of the sun's irradiance on a plane facing it and cos that of its zenith angle at the scene's origin, in the middle of
// the capture. Temperature: of the blackbody with that radiance over the band, its error by the slope there; NaN where
// there is none. Remote-sensing reflectance: over the downward irradiance that the pre-passes have found, with its
// error in that of each value. Columns with responses of their own are turned by these.
class Conversion {
 public:
  Conversion(const Delivery& delivery, Quantity quantity, OutputSpec::Units units, const Facts& facts);
  // values, errors: [pixel][value] of the delivery's result.
  void apply(std::span<double> values, std::span<double> errors) const;

 private:
  struct Part {
    size_t columns = 0;
    std::vector<double> factor;                 // of each band
    std::vector<double> relative_error;         // its relative standard error
    std::vector<BandThermometer> thermometers;  // of each band, or none
  };
  size_t per_pixel_ = 0, bands_ = 0, columns_ = 0;
  std::vector<Part> parts_;
};

}  // namespace suite
