// Scattered measurements, before they are interpolated (scattered.h).
#pragma once
#include <vector>

#include "sqt/function.h"

namespace suite::sqt {

// Scattered measurements (goniometer tables, raw sample text): value per channel for each pair.
struct Samples {
  Function::Info info;
  std::vector<Dir> out, in;   // same length n
  std::vector<double> value;  // n x channels, row-major; NaN = invalid
};

}  // namespace suite::sqt
