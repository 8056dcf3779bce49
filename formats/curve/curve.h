// Spectral curves from files: two-column text, CSV, ECOSTRESS library spectra. See FORMAT.md.
#pragma once
#include <string>

#include "spectral/curve.h"

namespace suite {

struct CurveOptions {
  Outside outside = Outside::error;
  int column = 0;    // 1 = first value column after the wavelength; 0 = the only one, or the first
  double scale = 1;  // factor on the values, after percent became shares
};

// Reads one curve; wavelengths become micron, percent becomes shares. Error with file and line otherwise.
Curve read_curve(const std::string& path, const CurveOptions& options);

}  // namespace suite
