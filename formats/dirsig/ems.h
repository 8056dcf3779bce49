// DIRSIG's spectral curves as far as the import must look into them: emissivities (.ems), extinctions (.ext, .abs) and
// two columns (.txt, .int).
#pragma once
#include <string>
#include <vector>

#include "formats/dirsig/item.h"

namespace suite::dirsig {

struct CurveFile {
  std::vector<double> weights;                            // of the angles 0 to 90 degrees; of .ems only
  bool even = true;                                       // all weights are 1
  bool moved = false;                                     // emissivities beyond 0 to 1 became 0 or 1
  std::vector<std::vector<double>> wavelength_um, value;  // of each curve, wavelengths ascending
  Item account;
};

// .ems: the number of curves, 91 weights, curves. Error, located.
CurveFile parse_ems(std::string_view text, const std::string& file);
// .ext and .abs: the number of curves, which is 1, and the curve.
CurveFile parse_ext(std::string_view text, const std::string& file, const char* unit);
// Two columns: micron and value; '#' begins a comment.
CurveFile parse_two_columns(std::string_view text, const std::string& file, const char* what);

}  // namespace suite::dirsig
