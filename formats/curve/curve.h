// Spectral curves from files: two-column text, CSV, ECOSTRESS library spectra, ENVI
// spectral libraries, DIRSIG emissivity files. See FORMAT.md.
#pragma once
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "spectral/curve.h"

namespace suite {

class Params;

struct NamedCurve {
  std::string name;  // may be empty
  Curve curve;
};

struct CurveOptions {
  Outside outside = Outside::error;
  int column = 0;        // 1 = first value column after the wavelength; 0 = the only one, or the first
  double scale = 1;      // factor on the values, after percent became shares
  std::string spectrum;  // of a library: a spectrum's name or its number from 1; empty = the first
  // Called with what is left out of a curve; may be empty.
  std::function<void(const std::string& path, const std::string& what)> on_warning = {};
};

// Reads one curve; wavelengths become micron, percent becomes shares. Error with file and line otherwise.
Curve read_curve(const std::string& path, const CurveOptions& options);

// All curves of a file: of a library in its order, else the one. Same Errors.
std::vector<Curve> read_curve_family(const std::string& path, const CurveOptions& options);

// The spectral responses of several bands from one table: a header line that names the columns, the first of them the
// wavelength with its unit, then rows; or from netCDF-4 or HDF5. See FORMAT.md. Error with file and line.
std::vector<NamedCurve> read_responses(const std::string& path);

// One curve from several that follow each other in wavelength: the rows of each up to where the next one takes over,
// linear between the last and the first. at_um: where, one less than parts; empty = the middle of what neighbours
// share, or of a gap no wider than twice the step of the rows beside it. where: of each part. Error: order, gaps,
// constants, parts with a rule outside their range.
Curve join_curves(std::span<const Curve> parts, std::span<const double> at_um, Outside outside,
                  std::span<const Where> where);
// The same from a list of curves, or from {join: [CURVE, ...], at_um: [N, ...], outside: RULE}. Located Errors.
Curve read_joined(const Params& p, const std::function<Curve(const Params&)>& read_one);
// Key `outside` of a map; error when absent.
Outside read_outside(const Params& map);

}  // namespace suite
