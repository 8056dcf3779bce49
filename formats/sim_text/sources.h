// The sources of a simulation text: sun, moon, sky, lamps, atmosphere, earth.
#pragma once
#include "base/params.h"
#include "radiometry/sources/environment.h"

namespace suite {

// A number, a file name, or a map {file, column, scale, outside} / {wavelength_um: [...], value: [...], outside}.
Curve read_curve_value(const Params& p);

// Reads the keys of `root` that describe sources. Located Error for anything wrong.
SourceSpecs read_sources(const Params& root);

}  // namespace suite
