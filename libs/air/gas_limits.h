// How far the gases of a provider are from a better reference, range by range.
#pragma once
#include <string>
#include <vector>

namespace suite {

// Errors of means over 0.03 um or 20 cm-1, whichever is wider; narrower bands see structure that the tables smooth.
struct GasLimit {
  double low_um = 0, high_um = 0;
  struct Error {
    double rms = 0, most = 0;
  };
  Error transmittance;                // of vertical and slanted paths
  double bias = 0;                    // mean error of the transmittance
  Error kelvin_down, kelvin_slanted;  // brightness temperature over a ground of 299 K; 0 where sunlight rules
  std::string cause;                  // a clause; may be empty

  // "from 3.4 to 4.15 um transmittance is off by 0.067 rms (mean -0.056), up to 0.18; ..."
  std::string text() const;
};

}  // namespace suite
