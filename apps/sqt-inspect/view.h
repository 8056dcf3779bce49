// A page with the lobes of a fitted scattering function and the cells they are made of, to turn.
#pragma once
#include <string>

#include "sqt/bundle.h"

namespace suite {

// Writes the HTML file `page`, which needs nothing else: of each stored view direction and channel every cell with its
// corners, values and mass. When that would take more than some 20 MB, every n-th view direction is there alone, which
// a note and the page tell. Error: page not writable.
void write_lobe_view(const sqt::Bundle& bundle, const std::string& page);

}  // namespace suite
