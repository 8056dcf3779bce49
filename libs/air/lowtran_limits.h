// How far the builtin gases and LOWTRAN 7 are from MODTRAN and REPTRAN, range by range.
#pragma once
#include <vector>

#include "air/gas_limits.h"

namespace suite {

enum class WaterOf { builtin, mt_ckd };  // whose continuum goes with the lines

// Measured by tests/bench/air_paths/compare --paths 9999: all 1818 paths down to sea level, 46 of them vertical, from 2
// m to 24.5 km, of MODTRAN 5.2.1 (database of pybsm 0.16.1: midlatitude summer, rural aerosol of 23 and 5 km, ground
// ranges up to ten times the height; with `--continuum` of MT_CKD 4 for the other continuum), so the aerosol's errors
// count as well. From 14 to 18.7 um: 3.4 K rms is a reported comparison with line-by-line spectra of CKDMIP that no
// test here repeats, and its 7 K at most is an allowance of twice that; measured here, without water, are 1.7 K rms
// and 3.0 K at most against REPTRAN (tests/physics/light/air_bands_test.cpp), which the report says. What stands in the
// way of more: the paths of MODTRAN end at 14 um, REPTRAN's table of water and lists of water's lines below 1500 cm-1
// are not at hand, spectra of CKDMIP neither. Each rms is the larger of that of all paths and that of the vertical
// ones. Ranges within 0.02 rms and 1 K rms are left out.
std::vector<GasLimit> limits_of_builtin(WaterOf continuum);
// Of LOWTRAN 7 as it was published.
std::vector<GasLimit> limits_of_lowtran();

}  // namespace suite
