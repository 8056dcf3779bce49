// Spectra that LOWTRAN and MODTRAN write: tape7, .tp7, .fl7; the grammar is in FORMAT.md.
// Based on: A. Berk and others, "MODTRAN4 user's manual", Air Force Research Laboratory, 1999, section on TAPE7; F. X.
// Kneizys and others, "Users guide to LOWTRAN 7", AFGL-TR-88-0177, 1988.
#pragma once
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/error.h"

namespace suite {

// IEMSCT 0 to 3.
enum class Tape7Mode { transmittance, thermal_radiance, radiance, irradiance };

struct Tape7Column {
  std::string name;            // as written; of two lines joined by '_' ("H2O_TRANS", "H2O_CONT")
  std::string unit;            // "1", "W/(m2 sr um)", "W/(m2 um)", "K"
  std::vector<double> values;  // one per wavenumber; NaN where the field is blank
};

// The line of sight as the cards before the spectra tell it (what the program computed, not only what was asked for).
struct Tape7Geometry {
  int path_type = 0;            // 1 horizontal, 2 between two heights, 3 to space, 4 limb
  double observer_height = 0;   // H1, m
  double end_height = 0;        // H2, m
  double zenith = 0;            // of the line of sight at H1, rad; of the Sun in mode irradiance
  std::optional<double> range;  // m
  std::optional<double> solar_zenith, relative_azimuth;  // at H1, rad; where the cards give them as such (IPARM 2)
};

struct Tape7Block {
  Tape7Mode mode = {};
  bool many_scatterings = false;  // IMULT
  std::optional<Tape7Geometry> geometry;
  std::vector<double> wavenumber;  // 1/cm, ascending
  std::vector<Tape7Column> columns;
  Where header;  // the line that names the columns
  int header_lines = 1;

  Where line_of(size_t row) const;
  const Tape7Column* find(std::string_view name) const;
  // A column without blanks. Error: not there (says what the mode holds), or blank, at its line.
  const Tape7Column& column(std::string_view name) const;
  // The transmittance of the path, whatever the mode calls it.
  const Tape7Column& transmittance() const;
  // What the path adds to light from behind it: PTH_THRML + SOL_SCAT, W/(m2 sr um). THRML_SCT and SING_SCAT are parts
  // of these and not added. Error in modes without radiance.
  std::vector<double> path_radiance() const;
  // Sun to the end of the path and back to its beginning, from the columns of the run itself (REF_SOL over TOA_SUN):
  // the product of two averages would be too small. Error where they are not written.
  std::vector<double> two_way_transmittance() const;
};

// All runs of a file or text, in its order. Error, located: no run at all, cut before the line -9999, a field that is
// no number or stands under no column, wavenumbers not ascending, a run whose header is not that of its mode.
std::vector<Tape7Block> read_tape7(const std::string& path);
std::vector<Tape7Block> parse_tape7(std::string_view text, const std::string& file_name);

}  // namespace suite
