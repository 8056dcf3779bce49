// DIRSIG's FourCurve atmospheres (HDF5, version 1): four spectra for each of several solar zenith angles; the grammar
// is in FORMAT.md. Based on: DIRSIG's interface control document "FourCurve Atmosphere HDF", version 1.
#pragma once
#include <string>
#include <vector>

#include "air/path_table.h"

namespace suite {

struct FourCurve {
  std::string name;                   // of the condition
  std::vector<double> wavelength_um;  // ascending
  std::vector<double> solar_zenith;   // rad, ascending
  // Of each solar zenith angle, over wavelength.
  struct Spectra {
    std::vector<double> sun;            // irradiance that reaches the ground, W/(m2 um)
    std::vector<double> path_radiance;  // of a metre of path, W/(m2 sr um m)
    std::vector<double> extinction;     // 1/m
    std::vector<double> sky;            // hemispherical irradiance, W/(m2 um)
  };
  std::vector<Spectra> at;
};

// All conditions of a file, by name. Error, located: not such a file, datasets missing or of shapes that do not fit
// each other, angles outside 0 to 180 degrees or not ascending, values negative or no numbers.
std::vector<FourCurve> read_four_curve(const std::string& path);

// As a table over solar zenith angle and range, up to `longest` (m): the air is the same everywhere, so that
// transmittance is exp(-k r) and path radiance j / k (1 - exp(-k r)) of the extinction k and the radiance j of a metre.
// irradiance is the Sun's at the ground as the file has it.
PathTable four_curve_paths(const FourCurve& condition, double longest);

}  // namespace suite
