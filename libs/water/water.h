// A body of natural water as a medium: what is in it, or what was measured in it.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "optics/medium.h"
#include "water/sea_water.h"

namespace suite {

// Inherent properties that were measured, curves over wavelength.
struct MeasuredWater {
  Curve absorption, scattering;      // 1/m, all of the water's, or without those of pure sea water
  std::optional<Curve> backscatter;  // 1/m, of all that scattering counts
  bool with_water = true;            // pure sea water is in all of them
};

struct WaterSpec {
  double temperature_c = 15, salinity_psu = 35;
  PureWater pure = PureWater::segelstein;
  std::optional<Curve> pure_absorption;  // 1/m; in place of the table
  double chlorophyll = 0;                // mg/m3
  bool case_1_dissolved = false;         // dissolved matter goes with chlorophyll; else:
  double dissolved_440 = 0;              // 1/m at 440 nm
  double dissolved_slope_per_nm = 0.014;
  double mineral = 0;  // g/m3
  double mineral_backscatter = 0.02;
  std::string particles = "fournier_forand";  // how the first kind scatters: fournier_forand, petzold, hg
  double backscatter = 0;                     // of fournier_forand; 0 = by chlorophyll, or by what was measured
  double g = 0.924;                           // of hg
  std::optional<MeasuredWater> measured;      // in place of chlorophyll, dissolved matter and minerals
};

// absorption, scattering, index and phase of the medium, on 2.5 nm from 0.2 to 0.8 um and on the rows of the table of
// pure water beyond (measured: on the rows of its curves as well), with an error outside. Error, located at `where`:
// what is out of range, measured beside constituents, measured scattering less than that of water by more than 1 %.
Medium water_medium(const WaterSpec& spec, const Where& where = {});

// What the medium leaves out or rests on, with sizes, one sentence each.
std::vector<std::string> water_notes(const WaterSpec& spec, const Medium& medium);

}  // namespace suite
