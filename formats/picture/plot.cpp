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

std::string end_label(double value) {
  return value >= 1e4 ? strf("%.1e", value) : value >= 10 ? strf("%.0f", value) : strf("%.2g", value);
}

// A line or points inside the axes; px and py give pixels of values.
template <class X, class Y>
void draw_line(Canvas& canvas, const PlotLine& line, const PlotAxes& axes, const X& px, const Y& py) {
  const double top = py(axes.y_high), bottom = py(axes.y_low);
  for (size_t i = 0; i < line.x.size(); ++i) {
    const Vec2 b{px(line.x[i]), py(line.y[i])};
    if (line.dots) {
      if (b.y >= top && b.y <= bottom) canvas.stroke(b, b, 2.2 * axes.scale, line.color);
      continue;
    }
    if (i == 0) continue;
    const Vec2 a{px(line.x[i - 1]), py(line.y[i - 1])};
    if (std::isnan(a.y) || std::isnan(b.y) || (a.y > bottom && b.y > bottom) || (a.y < top && b.y < top)) continue;
    const Vec2 from{a.x, std::clamp(a.y, top, bottom)}, to{b.x, std::clamp(b.y, top, bottom)};
    axes.scale == 1 ? canvas.line(from, to, line.color) : canvas.stroke(from, to, 0.8 * axes.scale, line.color);
  }
}

}  // namespace

double log_position(double value, double low, double high) {
  if (std::isnan(value)) return value;
  return std::clamp(std::log(std::max(value, low) / low) / std::log(high / low), 0.0, 1.0);
}

void draw_log_bar(Canvas& canvas, int x, int y, int width, int height, double low, double high,
                  const std::string& title, int scale) {
  SUITE_CHECK(low > 0 && low < high);
  const int tick = 4 * scale, text = 7 * scale, up = 3 * scale;
  canvas.text(x, y - 3 * Canvas::text_height(scale), title, kBlack, scale);
  for (int j = 0; j < height; ++j) canvas.fill(x, y + j, width, 1, viridis(1 - (j + 0.5) / height));
  canvas.frame(x, y, width, height, kBlack);
  auto position = [&](double v) {
    return y + height - 1 - static_cast<int>(std::lround(log_position(v, low, high) * (height - 1)));
  };
  for (int e = static_cast<int>(std::floor(std::log10(low))); std::pow(10.0, e) <= high; ++e)
    for (int digit = 1; digit < 10; ++digit) {
      const double value = digit * std::pow(10.0, e);
      if (value < low * (1 - 1e-9) || value > high * (1 + 1e-9)) continue;
      const int at = position(value);
      canvas.fill(x + width, at, digit == 1 ? tick : tick / 2, scale, kBlack);
      // The ends have labels of their own.
      if (digit == 1 && std::min(at - y, y + height - at) > Canvas::text_height(scale))
        canvas.text(x + width + text, at - up, power_label(e), kBlack, scale);
    }
  for (const double value : {low, high})
    canvas.text(x + width + text, position(value) - up, end_label(value), kBlack, scale);
}

int bar_labels_width(int scale) { return 7 * scale + Canvas::text_width("-1.25e-05", scale); }

void draw_bar(Canvas& canvas, int x, int y, int width, int height, double low, double high,
              const std::function<Rgb(double)>& color_of, int scale) {
  SUITE_CHECK(low < high && height > 1);
  for (int j = 0; j < height; ++j) canvas.fill(x, y + j, width, 1, color_of(1 - (j + 0.5) / height));
  canvas.frame(x, y, width, height, kBlack);
  const double step = nice_step(high - low, std::max(2, height / (4 * Canvas::text_height(scale))));
  for (double k = std::ceil(low / step - 1e-9); k * step <= high + 1e-9 * step; ++k) {
    const int at = y + height - 1 - static_cast<int>(std::lround((k * step - low) / (high - low) * (height - 1)));
    canvas.fill(x + width, at, 4 * scale, scale, kBlack);
    canvas.text(x + width + 7 * scale, at - 3 * scale, strf("%.6g", k == 0 ? 0.0 : k * step), kBlack, scale);
  }
}

void draw_plot(Canvas& canvas, int x, int y, int width, int height, const PlotAxes& axes,
               std::span<const PlotLine> lines) {
  const int s = axes.scale;
  const int left = x + 62 * s, right = x + width - 12 * s, top = y + 28 * s, bottom = y + height - 34 * s;
  const double y_low = axes.log_y ? std::log10(axes.y_low) : axes.y_low,
               y_high = axes.log_y ? std::log10(axes.y_high) : axes.y_high;
  SUITE_CHECK(axes.x_low < axes.x_high && y_low < y_high && right > left && bottom > top);
  auto px = [&](double v) { return left + (v - axes.x_low) / (axes.x_high - axes.x_low) * (right - left); };
  auto py = [&](double v) { return bottom - (v - y_low) / (y_high - y_low) * (bottom - top); };
  auto text = [&](int at_x, int at_y, const std::string& t) { canvas.text(at_x, at_y, t, kBlack, s); };
  text((left + right - Canvas::text_width(axes.title, s)) / 2, y + 4 * s, axes.title);
  text((left + right - Canvas::text_width(axes.x_label, s)) / 2, y + height - 12 * s, axes.x_label);
  text(x + 2 * s, y + 16 * s, axes.y_label);

  const double step = nice_step(axes.x_high - axes.x_low, 8);
  for (double v = std::ceil(axes.x_low / step) * step; v <= axes.x_high + 1e-9 * step; v += step) {
    const std::string label = strf("%g", std::fabs(v) < 1e-9 * step ? 0.0 : v);
    const int at = static_cast<int>(std::lround(px(v)));
    canvas.fill(at, top, 1, bottom - top, kFaint);
    text(at - Canvas::text_width(label, s) / 2, bottom + 6 * s, label);
  }
  const double y_step = axes.log_y ? std::max(1.0, std::ceil((y_high - y_low) / 10)) : nice_step(y_high - y_low, 6);
  for (double v = std::ceil(y_low / y_step - 1e-9) * y_step; v <= y_high + 1e-9 * y_step; v += y_step) {
    const std::string label =
        axes.log_y ? power_label(static_cast<int>(std::lround(v))) : strf("%g", std::fabs(v) < 1e-9 * y_step ? 0.0 : v);
    const int at = static_cast<int>(std::lround(py(v)));
    canvas.fill(left, at, right - left, 1, kFaint);
    text(left - 5 * s - Canvas::text_width(label, s), at - 3 * s, label);
  }
  canvas.frame(left, top, right - left + 1, bottom - top + 1, kBlack);

  int legend = top + 6 * s;
  for (const PlotLine& line : lines) {
    draw_line(canvas, line, axes, px, [&](double v) { return py(axes.log_y ? std::log10(std::max(v, 1e-300)) : v); });
    const int at = right - 20 * s - Canvas::text_width(line.name, s);
    if (line.dots)
      for (const int k : {15, 9, 3})
        canvas.stroke({at - k * s * 1.0, legend + 4.0 * s}, {at - k * s * 1.0, legend + 4.0 * s}, 2.2 * s, line.color);
    else
      canvas.fill(at - 16 * s, legend + 3 * s, 14 * s, 2 * s, line.color);
    text(at, legend, line.name);
    legend += 11 * s;
  }
}

}  // namespace suite
