// What pictures of one quantity share: a title above, a bar of colours at the right, the range that is shown.
#pragma once
#include <array>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "formats/picture/picture.h"
#include "formats/sim_text/sim_text.h"

namespace suite {

inline constexpr uint32_t kMostOfPicture = 15000;  // pixels on a side, which leaves room for a bar on a canvas
// Of larger ones every n-th pixel is shown.
uint32_t picture_stride(uint32_t columns, uint32_t rows);

// Black: a percentile of each pixel's darkest value, so that no more pixels lose a colour there; white: of its
// brightest. Pixels that are not finite do not count, nor those where nothing is and nothing shines. The two are
// `least_apart` apart, or at all. nothing: by pixel.
std::array<double, 2> picture_ends(std::span<const float> values, const std::vector<bool>& nothing,
                                   const PreviewSpec& spec, double least_apart);

// Where things are in a picture: without a bar nothing but the picture; with one a title above and the bar at the
// right, and what is small is enlarged so that both are legible.
struct BarLayout {
  BarLayout(int columns, int rows, bool bar);
  int enlarged, picture_width, width, height, scale = 1, top = 0;
};

struct BarLegend {
  std::vector<std::string> titles;   // the first that fits is written
  std::array<double, 2> ends;        // of the bar
  std::function<Rgb(double)> color;  // 0 to 1
  bool empty = false;                // somewhere is nothing, which is grey
};
void draw_legend(Canvas& canvas, const BarLayout& at, const BarLegend& legend);

}  // namespace suite
