// Pictures of a bundle: its cells over their values, several slices in a sheet.
#pragma once
#include "formats/picture/picture.h"
#include "sqt/bundle.h"

namespace suite {

struct MapOptions {
  size_t channel = 0;
  size_t panels = 6;     // slices shown, spread over the views of the bundle
  int panel_size = 420;  // pixels
  bool edges = true;     // draw the borders of the cells
  double decades = 4;    // below the largest value shown
};

// Each panel is the hemisphere of incident directions in Lambert's azimuthal equal-area projection, seen from above: x
// of the surface frame to the right, y up. Data over the whole sphere get a second disk for the lower side. A cross
// marks the outgoing direction, a circle its mirror direction.
Canvas draw_map(const sqt::Bundle& bundle, const std::string& title, const MapOptions& options);

}  // namespace suite
