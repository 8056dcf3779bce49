// Cuts through a bundle, drawn samples and single values as tables; a cut also as a plot; a sphere as a picture.
#pragma once
#include <string>
#include <vector>

#include "formats/picture/picture.h"
#include "sqt/bundle.h"

namespace suite {

// Principal plane at the view angles: CSV of theta_o_deg, theta_in_deg (positive on the side of the view direction,
// negative on the side of the mirror), f per channel.
std::string slice_csv(const sqt::Bundle& bundle, const std::vector<double>& view_deg);
// data: what was fitted, drawn as dots; may be null.
Canvas slice_plot(const sqt::Bundle& bundle, const std::vector<double>& view_deg, size_t channel,
                  const std::string& title, const sqt::Function* data);

// CSV of n directions drawn for `out` in one channel: x, y, z, pdf, weight = w / pdf (a failed draw is left out).
std::string sample_csv(const sqt::Bundle& bundle, Dir out, size_t channel, size_t n, uint64_t seed);

// f at any wavelength: linear between the channels, the nearest beyond them.
struct Answer {
  double f, w, pdf, total;  // pdf of the nearest channel
};
Answer answer(const sqt::Bundle& bundle, Dir out, Dir in, double wavelength_um);

// A sphere of the material under a sun from the upper left (half-angle 2 deg) and an even sky, seen from the front.
Canvas draw_sphere(const sqt::Bundle& bundle, int size);

}  // namespace suite
