// How the light of a lamp is distributed over directions.
#pragma once
#include <cstddef>
#include <memory>
#include <vector>

#include "sqt/bundle.h"

namespace suite {

// Relative intensity over polar angle from the lamp's axis and azimuth around it: rows from 0 to 180 degrees inclusive,
// columns in equal steps from the x axis of the frame, periodic; bilinear. Or an SQT of quantity `intensity`, averaged
// over its channels, whose z axis is the lamp's axis. Of a luminaire's photometric file: candela.
struct IntensityTable {
  std::vector<double> value;
  size_t polars = 0, azimuths = 0;
  std::shared_ptr<const sqt::Bundle> sqt;
};

}  // namespace suite
