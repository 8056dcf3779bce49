// Spectra that libRadtran's uvspec writes. Which columns an output has stands only in the input file of its run: both
// are read together; the grammar is in FORMAT.md. Based on: B. Mayer and others, "libRadtran user's guide", edition for
// version 2.0.2, 2017, section 3.1.5 and the options output_user, output_quantity, output_process, source, umu, phi,
// phi0.
#pragma once
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "air/path_table.h"

namespace suite {

struct LibradtranColumn {
  std::string name;             // as asked for: "edir", "uu"
  std::string unit;             // "W/(m2 um)", "W/(m2 sr um)", "K", "1"; empty: as libRadtran writes it
  int view = -1, azimuth = -1;  // of "uu": indices of the run's angles; of "u0u" of its view angle
  std::vector<double> values;   // [level][wavelength]
};

struct LibradtranRun {
  bool thermal = false;
  std::vector<double> wavelength_um;     // ascending
  size_t levels = 1;                     // output altitudes (zout), in their order
  std::optional<double> solar_zenith;    // rad
  std::vector<double> view_zenith;       // of the direction of sight, rad: acos(-umu)
  std::vector<double> relative_azimuth;  // of the direction of sight from the Sun's azimuth, rad: phi - phi0, 0 to 2 pi
  std::vector<LibradtranColumn> columns;
  Where where;  // the output

  // A column without angles. Error: it was not asked for.
  const LibradtranColumn& column(std::string_view name) const;
};

// The power in which a solar source file is given: libRadtran does not know it; its own files are in mW.
enum class LibradtranPower { milliwatt, watt };

// Error, located in the file at fault: an input that asks for what is no spectrum (sums, bands, netCDF), for no
// wavelength, or includes another file; an output with other columns, cut within a wavelength, with angles other than
// those of the input, or wavelengths not ascending.
LibradtranRun read_libradtran(const std::string& input_path, const std::string& output_path,
                              LibradtranPower power = LibradtranPower::milliwatt);
LibradtranRun parse_libradtran(std::string_view input, const std::string& input_name, std::string_view output,
                               const std::string& output_name, LibradtranPower power = LibradtranPower::milliwatt);

// The radiances of a run at a level as a table over zenith angle and relative azimuth of the directions that look up
// (a sky) or down; and, where "edir" is there, the direct Sun's irradiance on a plane facing it. Error: no radiances in
// such directions, or not in W.
PathTable libradtran_sky(const LibradtranRun& run, size_t level, bool up);

}  // namespace suite
