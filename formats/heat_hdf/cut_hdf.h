// In both kinds of files: what the elements were made with, so that the same can be made on another day.
#pragma once
#include "formats/hdf5/h5.h"
#include "heat/day_sun.h"

namespace suite {

void put_cut(h5::Writer& w, const HeatCut& cut);
// Error, naming the file: what cannot be.
HeatCut take_cut(h5::Reader& r);

}  // namespace suite
