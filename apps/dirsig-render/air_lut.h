// --air-lut: tables for atmospheric correction.
#pragma once
#include "formats/sim_text/sim_text.h"
#include "options.h"

namespace suite {

// Makes the table that the grid's text (--air-lut FILE) asks for, of the simulation's air and the bands of its sensor,
// and writes FOLDER/air_lut.nc and air_lut.csv. States of the air that an earlier run has left in
// FOLDER/air_lut_states are taken over. Returns the exit code.
int run_air_lut(const RenderOptions& o, const Simulation& sim);

}  // namespace suite
