// The colours of a picture in few classes, so that a map of it is one number a texel.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "spectral/display_colour.h"

namespace suite {

struct ColourClasses {
  std::vector<LinearRgb> colours;  // of each class: the mean of its texels, linear
  std::vector<uint16_t> number;    // of each texel: its class
  double rms = 0, worst = 0;       // how far texels are from their class in any channel, display values of 0 to 1
};

// display: three values of 0 to 1 a texel, as stored in pictures (sRGB). most: classes, 1 to 65535; there are as many
// as the picture has colours (told apart by 1/64 of a channel's range), if that is less. The same picture gives the
// same classes. Based on: P. Heckbert, "Color image quantization for frame buffer display", SIGGRAPH 1982 (median cut;
// here the class of the largest squared deviation is cut at its mean).
ColourClasses classify_colours(std::span<const float> display, size_t most);

}  // namespace suite
