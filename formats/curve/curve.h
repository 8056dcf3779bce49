// Spectral curves from files: two-column text, CSV, ECOSTRESS library spectra, ENVI
// spectral libraries, DIRSIG emissivity files. See FORMAT.md.
#pragma once
#include <string>
#include <vector>

#include "spectral/curve.h"

namespace suite {

struct CurveOptions {
  Outside outside = Outside::error;
  int column = 0;        // 1 = first value column after the wavelength; 0 = the only one, or the first
  double scale = 1;      // factor on the values, after percent became shares
  std::string spectrum;  // of a library: a spectrum's name or its number from 1; empty = the first
};

// Reads one curve; wavelengths become micron, percent becomes shares. Error with file and line otherwise.
Curve read_curve(const std::string& path, const CurveOptions& options);

// All curves of a file: of a library in its order, else the one. Same Errors.
std::vector<Curve> read_curve_family(const std::string& path, const CurveOptions& options);

}  // namespace suite
