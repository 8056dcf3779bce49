// Pictures of a bundle: its cells over their values, several slices in a sheet.
#pragma once
#include <vector>

#include "formats/picture/picture.h"
#include "sqt/bundle.h"

namespace suite {

struct MapOptions {
  size_t channel = 0;
  size_t panels = 6;             // slices shown, spread over the views of the bundle up to 80 deg
  std::vector<double> view_deg;  // not empty: instead, the slices nearest to these angles
  double zoom_deg = 0;           // > 0: only directions within this angle of the mirror direction, at most 90
  int panel_size = 512;          // pixels
  bool edges = true;             // draw the borders of the cells
  double decades = 6;            // shown at most, below the largest value
};

// Each panel is the hemisphere of incident directions in Lambert's azimuthal equal-area projection, seen from above: x
// of the surface frame to the right, y up; zoomed, the cap around the mirror direction (of the transmitted side:
// straight on), the plane of incidence still level, what lies beyond the horizon white. Data over the whole sphere get
// a second disk for the lower side. A cross marks the outgoing direction, a circle its mirror direction; dotted rings
// are degrees from the centre. One colour scale for all panels: up to the largest value at polar angles up to 80 deg,
// beyond which data rise without bound. UsageError: a sheet of more than 16384 pixels either way.
Canvas draw_map(const sqt::Bundle& bundle, const std::string& title, const MapOptions& options);

}  // namespace suite
