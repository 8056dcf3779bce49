// The quick look at polarisation: hue the angle, saturation the degree, brightness the intensity, of the band in the
// middle.
#pragma once
#include <string>
#include <vector>

#include "formats/picture/picture.h"
#include "sensor/delivery.h"

namespace suite {

// angle_deg: [0, 180) once around the hues, 0 red, 60 green, 120 blue; degree and light from 0 to 1.
Rgb polarisation_color(double angle_deg, double degree, double light);

// Of an image while its rows come in. The degree is the debiased one; where the angle is undefined it is grey.
class PolarisationPicture {
 public:
  PolarisationPicture(uint32_t columns, uint32_t rows) : columns_(columns), rows_(rows) {}
  void append(const CaptureResult& next_rows, const Product& polarisation);
  void write(const std::string& path) const;  // when all rows are there

 private:
  uint32_t columns_, rows_;
  std::string band_;
  std::vector<float> values_;  // [pixel][angle, degree, intensity]
};

}  // namespace suite
