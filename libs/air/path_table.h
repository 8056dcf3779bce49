// Paths through the air as another program computed them: several runs combined to a table over view zenith, range,
// height, azimuth or whatever they differ in; likewise the sky over zenith and azimuth and the Sun at the ground over
// its zenith angle.
//
// Between runs: optical depth (and the logarithm of two-way transmittance and irradiance) is linear in each coordinate,
// and so is the source S / (1 - T) of path radiance, so that a homogeneous path is right at every range. Where runs
// have no transmittance (a sky), radiance itself is linear. Depths of band averages do not grow linearly with range:
// the table is as good as its runs are dense. Nothing is extrapolated. A range axis begins by itself with range 0,
// where nothing dims or shines. Transmittances of two tables must not be multiplied (averages over bands are no
// products): a path there and back uses the runs' own two-way column.
#pragma once
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "base/error.h"

namespace suite {

struct PathAxis {
  std::string name, unit;     // "view zenith angle", "rad"
  double shown_per_unit = 1;  // for messages: shown in `shown_unit`
  std::string shown_unit;     // "degrees"; empty = unit
  bool from_zero = false;     // a range, m: at 0 transmittance is 1 and radiance 0
};

// One value per wavelength; empty where the runs do not have it.
struct PathSpectra {
  std::vector<double> transmittance;  // 0..1
  std::vector<double> radiance;       // that the air of the path adds, W/(m2 sr um)
  std::vector<double> two_way;        // transmittance from the Sun to the path's end and back along it, 0..1
  std::vector<double> irradiance;     // of the direct Sun at the path's beginning, on a plane facing it, W/(m2 um)
};

struct PathRun {
  std::vector<double> at;  // a coordinate per axis
  PathSpectra spectra;
  Where where;  // it comes from, for messages
};

class PathTable {
 public:
  // Runs stand on a full grid, in any order. Error: no run, a place of the grid without a run or with two, quantities
  // that only some runs have, spectra of the wrong length, transmittances outside 0..1, negative or unknown values,
  // wavelengths not ascending.
  PathTable(std::vector<PathAxis> axes, std::vector<double> wavelength_um, std::vector<PathRun> runs);

  const std::vector<double>& wavelength_um() const { return wavelength_um_; }
  const std::vector<PathAxis>& axes() const { return axes_; }
  // What the runs cover: least and largest coordinate.
  std::pair<double, double> covered(size_t axis) const { return {ticks_[axis].front(), ticks_[axis].back()}; }
  // The path at a place; its two-way transmittance is empty below the least range of the runs, where they do not tell
  // the Sun's way to the path's end. Error: a coordinate outside what is covered.
  void at(std::span<const double> place, PathSpectra& path) const;
  // The table of averages over intervals [low, high] of wavelength, um, ascending. Error: an interval not covered.
  PathTable averaged(std::span<const std::pair<double, double>> intervals) const;

 private:
  size_t node_of(const PathRun& run) const;
  void check(const PathRun& run) const;
  void add_zero_ranges();
  std::string shown(size_t axis, double value) const;
  std::string place(std::span<const double> at) const;

  std::vector<PathAxis> axes_;
  std::vector<double> wavelength_um_;
  std::vector<std::vector<double>> ticks_;  // of each axis, ascending
  std::vector<PathRun> nodes_;              // the last axis runs fastest
};

}  // namespace suite
