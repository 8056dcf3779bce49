// Colour bars and line plots on a canvas.
#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "formats/picture/picture.h"

namespace suite {

namespace {

constexpr Rgb kFaint{225, 225, 225};

// A step of 1, 2 or 5 times a power of ten that divides the range into about `wanted` parts.
double nice_step(double range, int wanted) {
  const double raw = range / wanted, power = std::pow(10, std::floor(std::log10(raw)));
  const double digit = raw / power;
  return power * (digit < 1.5 ? 1 : digit < 3.5 ? 2 : digit < 7.5 ? 5 : 10);
}

std::string power_label(int exponent) {
  return exponent >= -2 && exponent <= 3 ? strf("%g", std::pow(10.0, exponent)) : strf("1e%d", exponent);
}

}  // namespace

double log_position(double value, double low, double high) {
  if (std::isnan(value)) return value;
  return std::clamp(std::log(std::max(value, low) / low) / std::log(high / low), 0.0, 1.0);
}

void draw_log_bar(Canvas& canvas, int x, int y, int width, int height, double low, double high,
                  const std::string& title) {
  SUITE_CHECK(low > 0 && low < high);
  canvas.text(x, y - 2 * Canvas::text_height() - 2, title);
  for (int j = 0; j < height; ++j) canvas.fill(x, y + j, width, 1, viridis(1 - (j + 0.5) / height));
  canvas.frame(x, y, width, height, kBlack);
  for (int e = static_cast<int>(std::ceil(std::log10(low) - 1e-9));
       e <= static_cast<int>(std::floor(std::log10(high) + 1e-9)); ++e) {
    const int at =
        y + height - 1 - static_cast<int>(std::lround(log_position(std::pow(10.0, e), low, high) * (height - 1)));
    canvas.fill(x + width, at, 4, 1, kBlack);
    canvas.text(x + width + 7, at - 3, power_label(e));
  }
  canvas.text(x + width + 7, y - 5, strf("%.3g", high));
}

void draw_plot(Canvas& canvas, int x, int y, int width, int height, const PlotAxes& axes,
               std::span<const PlotLine> lines) {
  const int left = x + 62, right = x + width - 12, top = y + 26, bottom = y + height - 34;
  const double y_low = axes.log_y ? std::log10(axes.y_low) : axes.y_low,
               y_high = axes.log_y ? std::log10(axes.y_high) : axes.y_high;
  SUITE_CHECK(axes.x_low < axes.x_high && y_low < y_high && right > left && bottom > top);
  auto px = [&](double v) { return left + (v - axes.x_low) / (axes.x_high - axes.x_low) * (right - left); };
  auto py = [&](double v) { return bottom - (v - y_low) / (y_high - y_low) * (bottom - top); };
  canvas.text((left + right - Canvas::text_width(axes.title)) / 2, y + 6, axes.title);
  canvas.text((left + right - Canvas::text_width(axes.x_label)) / 2, y + height - 12, axes.x_label);
  canvas.text(x + 2, y + 14, axes.y_label);

  const double step = nice_step(axes.x_high - axes.x_low, 8);
  for (double v = std::ceil(axes.x_low / step) * step; v <= axes.x_high + 1e-9 * step; v += step) {
    const std::string label = strf("%g", std::fabs(v) < 1e-9 * step ? 0.0 : v);
    const int at = static_cast<int>(std::lround(px(v)));
    canvas.fill(at, top, 1, bottom - top, kFaint);
    canvas.text(at - Canvas::text_width(label) / 2, bottom + 6, label);
  }
  const double y_step = axes.log_y ? std::max(1.0, std::ceil((y_high - y_low) / 10)) : nice_step(y_high - y_low, 6);
  for (double v = std::ceil(y_low / y_step - 1e-9) * y_step; v <= y_high + 1e-9 * y_step; v += y_step) {
    const std::string label =
        axes.log_y ? power_label(static_cast<int>(std::lround(v))) : strf("%g", std::fabs(v) < 1e-9 * y_step ? 0.0 : v);
    const int at = static_cast<int>(std::lround(py(v)));
    canvas.fill(left, at, right - left, 1, kFaint);
    canvas.text(left - 5 - Canvas::text_width(label), at - 3, label);
  }
  canvas.frame(left, top, right - left + 1, bottom - top + 1, kBlack);

  int legend = top + 6;
  for (const PlotLine& line : lines) {
    for (size_t i = 1; i < line.x.size(); ++i) {
      const double a = axes.log_y ? std::log10(std::max(line.y[i - 1], 1e-300)) : line.y[i - 1],
                   b = axes.log_y ? std::log10(std::max(line.y[i], 1e-300)) : line.y[i];
      if (std::isnan(a) || std::isnan(b) || (a < y_low && b < y_low) || (a > y_high && b > y_high)) continue;
      canvas.line({px(line.x[i - 1]), std::clamp(py(a), double(top), double(bottom))},
                  {px(line.x[i]), std::clamp(py(b), double(top), double(bottom))}, line.color);
    }
    canvas.fill(right - 20 - Canvas::text_width(line.name) - 16, legend + 3, 14, 2, line.color);
    canvas.text(right - 20 - Canvas::text_width(line.name), legend, line.name);
    legend += 11;
  }
}

}  // namespace suite
