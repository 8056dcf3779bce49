// Wavelengths in messages.
#pragma once
#include <string>

#include "base/error.h"

namespace suite {

// Where bands and windows end, um: far beyond the thermal infrared, and below what the visible is in nanometres.
inline constexpr double kLongestWave = 100;

// "0.4 to 0.9 um"; of numbers above 100 it asks whether they are nanometres.
inline std::string wavelengths_text(double low_um, double high_um) {
  std::string text = low_um == high_um ? strf("%g um", low_um) : strf("%g to %g um", low_um, high_um);
  if (low_um > 100)
    text += low_um == high_um ? strf(" (in nanometres? then %g um)", low_um / 1000)
                              : strf(" (in nanometres? then %g to %g um)", low_um / 1000, high_um / 1000);
  return text;
}

}  // namespace suite
