#include "bar_picture.h"

#include <algorithm>
#include <cmath>

namespace suite {

namespace {

constexpr int kLegible = 400;

float percentile(std::vector<float>& values, double percent) {
  const auto at = values.begin() + std::lround(percent / 100 * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

}  // namespace

uint32_t picture_stride(uint32_t columns, uint32_t rows) {
  return std::max({1u, (columns + kMostOfPicture - 1) / kMostOfPicture, (rows + kMostOfPicture - 1) / kMostOfPicture});
}

std::array<double, 2> picture_ends(std::span<const float> values, const std::vector<bool>& nothing,
                                   const PreviewSpec& spec, double least_apart) {
  if (spec.range) return *spec.range;
  const size_t bands = values.size() / std::max(size_t{1}, nothing.size());
  std::vector<float> darkest, brightest;
  for (size_t i = 0; i < nothing.size(); ++i) {
    const float* v = &values[i * bands];
    const auto [low, high] = std::minmax_element(v, v + bands);
    if (!std::isfinite(*low) || !std::isfinite(*high) || (nothing[i] && *low == 0 && *high == 0)) continue;
    darkest.push_back(*low), brightest.push_back(*high);
  }
  if (darkest.empty()) return {0, 1};
  const double low = percentile(darkest, spec.low_percent), high = percentile(brightest, spec.high_percent);
  if (high - low >= least_apart && high > low) return {low, high};
  if (least_apart > 0) return {(low + high - least_apart) / 2, (low + high + least_apart) / 2};
  return high > 0 ? std::array<double, 2>{0, high} : std::array<double, 2>{0, 1};
}

BarLayout::BarLayout(int columns, int rows, bool bar) {
  enlarged = bar ? std::max(1, std::min((kLegible + rows - 1) / rows, 2 * kLegible / columns)) : 1;
  picture_width = width = columns * enlarged, height = rows * enlarged;
  if (!bar) return;
  scale = std::clamp((std::min(width, height) + 140) / 280, 1, 5);
  top = 2 * Canvas::text_height(scale);
  height = top + std::max(height, 100 * scale);
  width += 16 * scale + bar_labels_width(scale);
}

void draw_legend(Canvas& canvas, const BarLayout& at, const BarLegend& legend) {
  const int s = at.scale, line = Canvas::text_height(s), x = at.picture_width + 6 * s;
  for (const std::string& title : legend.titles)
    if (Canvas::text_width(title, s) <= at.width) {
      canvas.text(2 * s, (at.top - line) / 2, title, kBlack, s);
      break;
    }
  const int bottom = std::min(at.height - (legend.empty ? 3 * line : line / 2), at.top + 60 * line);
  draw_bar(canvas, x, at.top + line / 2, 10 * s, bottom - at.top - line / 2, legend.ends[0], legend.ends[1],
           legend.color, s);
  if (!legend.empty) return;
  canvas.fill(x, bottom + line, 10 * s, line, kGrey);
  canvas.frame(x, bottom + line, 10 * s, line, kBlack);
  canvas.text(x + 17 * s, bottom + line, "nothing", kBlack, s);
}

}  // namespace suite
