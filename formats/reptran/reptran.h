// REPTRAN's tables of absorption at representative wavelengths, as libRadtran has them. See FORMAT.md.
#pragma once
#include <string>
#include <vector>

#include "air/representative.h"

namespace suite {

struct ReadReptran {
  RepresentativeTable table;
  std::vector<std::string> notes;  // gases whose table is not there
};

// path: the file of the bands, "reptran_thermal_coarse.cdf"; tables of gases are looked for beside it,
// "reptran_thermal_coarse.lookup.H2O.cdf". Error, naming the file: no netCDF-3, variables missing or of another shape,
// a table that is none (check_representative), no gas at all.
ReadReptran read_reptran(const std::string& path);

}  // namespace suite
