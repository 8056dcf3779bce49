// Runs of tape7 files put together to a table of paths.
#pragma once
#include <span>

#include "air/path_table.h"
#include "formats/tape7/tape7.h"

namespace suite {

// What runs may differ in, told by their cards: rad and m.
enum class Tape7Axis { view_zenith, range, observer_height, end_height, solar_zenith, relative_azimuth };

// What the cards of a run, which has a geometry, say of it.
std::optional<double> tape7_value(const Tape7Block& run, Tape7Axis axis);

// Each run with its transmittance, with path radiance where its mode has it, with its own two-way transmittance and the
// Sun's irradiance at H1 where they are written. In mode irradiance the zenith angle is the Sun's, and the axis
// solar_zenith its name. Error, located: a run without geometry or without an axis' value on its cards, runs of
// different modes or wavenumbers, runs that differ in what is no axis, and as for PathTable.
PathTable tape7_path_table(std::span<const Tape7Block> runs, std::span<const Tape7Axis> axes);

}  // namespace suite
