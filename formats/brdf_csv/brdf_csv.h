// Scattering data as plain CSV, one value a row. See FORMAT.md.
#pragma once
#include <string>
#include <string_view>

#include "sqt_fit/samples.h"

namespace suite {

// Error with line and column: unknown columns, angles out of range, wavelengths that differ between direction pairs.
sqt::Samples read_brdf_csv(const std::string& path);
sqt::Samples parse_brdf_csv(std::string_view text, const std::string& file_name);

// Where a table has its values, deg: every pair of an outgoing and an incident direction. At the pole one azimuth
// counts.
struct AngleGrid {
  std::vector<double> theta_o, phi_o, theta_i, phi_i;
  size_t pairs() const;
};
// The table of `function` over a grid, with the header that names its units. All digits: a reader has the function's
// own values at the angles it reads. Values that are not there are nan.
std::string brdf_csv_of(const sqt::Function& function, const AngleGrid& grid, const std::string& comment);

}  // namespace suite
