// Photometric files of luminaires, IES LM-63 (1986 to 2019), type C. See FORMAT.md.
// Based on: ANSI/IES LM-63-02 (2008), "Standard file format for the electronic transfer of photometric data".
#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "light/intensity_table.h"

namespace suite {

struct IesLuminaire {
  std::string name;                          // [LUMINAIRE], else the file's name
  std::vector<double> vertical, horizontal;  // deg, ascending; vertical from straight down, horizontal as stored
  std::vector<double> candela;               // [horizontal][vertical], all factors applied
  double lamp_lumens = 0;                    // of all its lamps, as the file says; 0: absolute photometry
  double watts = 0;

  // Candela in a direction, deg: bilinear, the symmetry of the file applied; 0 at vertical angles without data.
  double at(double vertical, double horizontal) const;
  // Light of the whole luminaire, lm: exact for bilinear candela up to the rule's 1e-6.
  double lumens() const;
};

// Error with its line: not LM-63, types A and B, angles that do not ascend or do not span one of the standard's ranges,
// counts that do not fit, negative candela, TILT in a file of its own.
IesLuminaire read_ies(const std::string& path);
IesLuminaire parse_ies(std::string_view text, const std::string& file_name);

// Candela over the axis of a lamp (straight down) and the azimuth about it, on the coarsest even grid that has all of
// the file's angles, at most 0.25 deg fine. lost: relative difference of its lumens, 0 up to rounding when all angles
// lie on the grid.
IntensityTable intensity_table(const IesLuminaire& luminaire, double& lost);

}  // namespace suite
