// Pictures for people: an 8-bit RGB canvas with lines, polygons and labels, colour scales, and PNG output.
// Not for measurements (those go through formats/envi and formats/raster).
#pragma once
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "math/vec.h"

namespace suite {

struct Rgb {
  uint8_t r = 0, g = 0, b = 0;
  bool operator==(const Rgb&) const = default;
};
inline constexpr Rgb kWhite{255, 255, 255}, kBlack{0, 0, 0}, kGrey{128, 128, 128};

// Pixel (0, 0) is the upper left corner. Drawing outside the canvas is cut off.
class Canvas {
 public:
  Canvas(int width, int height, Rgb background = kWhite);  // each 1 to 16384
  int width() const { return width_; }
  int height() const { return height_; }
  Rgb pixel(int x, int y) const {
    return pixels_[static_cast<size_t>(y) * static_cast<size_t>(width_) + static_cast<size_t>(x)];
  }
  std::span<const Rgb> pixels() const { return pixels_; }

  void set(int x, int y, Rgb color);
  void blend(int x, int y, Rgb color, double opacity);
  void fill(int x, int y, int width, int height, Rgb color);
  void frame(int x, int y, int width, int height, Rgb color);  // outline, inside the rectangle
  void line(Vec2 a, Vec2 b, Rgb color, double opacity = 1);    // one pixel wide, anti-aliased
  // The same of any width in pixels, with round ends; on the canvas and up to a canvas around it.
  void stroke(Vec2 a, Vec2 b, double width, Rgb color, double opacity = 1);
  // ASCII in a 5 x 7 font enlarged `scale` times, its dots joined to smooth strokes from 2 on; (x, y) is the upper left
  // corner. Other characters show as '?'.
  void text(int x, int y, std::string_view text, Rgb color = kBlack, int scale = 1);
  static int text_width(std::string_view text, int scale = 1) { return static_cast<int>(text.size()) * 6 * scale; }
  static constexpr int text_height(int scale = 1) { return 8 * scale; }

 private:
  int width_, height_;
  std::vector<Rgb> pixels_;
};

// 0 dark violet ... 1 yellow, perceptually uniform (viridis; S. van der Walt & N. Smith, 2015, CC0). t is clamped, NaN
// is grey.
Rgb viridis(double t);
// 0 black ... 1 light yellow through red, likewise (inferno; the same authors, CC0).
Rgb inferno(double t);
// -1 blue ... 0 white ... +1 red; for differences.
Rgb diverging(double t);
// Linear light to 8-bit sRGB (IEC 61966-2-1); clamped.
uint8_t srgb(double linear);

// Vertical colour bar with labelled decades and ends from low to high (log scale; 0 < low < high), `title` above.
// scale: of the text.
void draw_log_bar(Canvas& canvas, int x, int y, int width, int height, double low, double high,
                  const std::string& title, int scale = 1);
// The same from low to high (< high) on a linear scale, with ticks at round values and any colours: color_of(0) at the
// bottom, color_of(1) at the top.
void draw_bar(Canvas& canvas, int x, int y, int width, int height, double low, double high,
              const std::function<Rgb(double)>& color_of, int scale = 1);
// Width of that bar's ticks and labels, beside its own.
int bar_labels_width(int scale = 1);
// Position of a value on the log scale, 0 to 1.
double log_position(double value, double low, double high);

// A line plot with axes, ticks, labels and a legend in the given rectangle of the canvas.
struct PlotLine {
  std::string name;
  Rgb color;
  std::vector<double> x, y;  // same length; NaN breaks the line
  bool dots = false;         // points instead of a line
};
struct PlotAxes {
  std::string title, x_label, y_label;
  double x_low = 0, x_high = 1, y_low = 0, y_high = 1;
  bool log_y = false;
  int scale = 1;  // of text, margins and line widths
};
void draw_plot(Canvas& canvas, int x, int y, int width, int height, const PlotAxes& axes,
               std::span<const PlotLine> lines);

// PNG, whole or not at all; `comment` goes into the file (the command line that made it). Error when it cannot be
// written.
void write_png(const std::string& path, const Canvas& canvas, const std::string& comment);
// Plain RGB rows from the top, for previews: size = 3 x width x height.
void write_png(const std::string& path, int width, int height, std::span<const uint8_t> rgb,
               const std::string& comment);

}  // namespace suite
