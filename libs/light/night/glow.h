// Spectra of what shines by night: a smooth curve and emission lines, which are averaged over bins exactly, however
// narrow they are.
#pragma once
#include <vector>

#include "spectral/curve.h"

namespace suite {

// Wavelengths for which the night sky is known, um; it is black outside.
inline constexpr double kNightLow = 0.3, kNightHigh = 2.5;

struct GlowSpectrum {
  struct Line {
    double wavelength_um, power;  // integral over the line, in units of smooth x um
  };
  Curve smooth = Curve::constant(0);
  std::vector<Line> lines = {};  // of no width

  // Average over low <= wavelength < high, so that bins side by side count each line once. low < high.
  double mean(double low_um, double high_um) const;
  GlowSpectrum scaled(double factor) const;
  // Lumens of it as W/um: by day (CIE 1924) and by night (CIE 1951).
  double photopic() const;
  double scotopic() const;
};

}  // namespace suite
