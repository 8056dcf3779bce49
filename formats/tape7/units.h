// Units of columns by their names.
#pragma once
#include <string>

namespace suite {

// unit: after values of W, cm and 1/cm were multiplied by the square of the wavenumber where by_square says so (1e4 cm2
// in a m2, and nu^2 / 1e4 wavenumbers in a micron).
struct Tape7Scale {
  const char* unit;
  bool by_square;
};
Tape7Scale tape7_scale(const std::string& column);

}  // namespace suite
