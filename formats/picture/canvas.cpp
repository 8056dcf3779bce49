#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "formats/picture/font.h"
#include "formats/picture/picture.h"

namespace suite {

Canvas::Canvas(int width, int height, Rgb background) : width_(width), height_(height) {
  SUITE_CHECK(width >= 1 && width <= 16384 && height >= 1 && height <= 16384);
  pixels_.assign(static_cast<size_t>(width) * static_cast<size_t>(height), background);
}

void Canvas::set(int x, int y, Rgb color) {
  if (x >= 0 && y >= 0 && x < width_ && y < height_)
    pixels_[static_cast<size_t>(y) * static_cast<size_t>(width_) + static_cast<size_t>(x)] = color;
}

void Canvas::blend(int x, int y, Rgb color, double opacity) {
  if (x < 0 || y < 0 || x >= width_ || y >= height_) return;
  const Rgb old = pixel(x, y);
  auto mix = [&](uint8_t a, uint8_t b) { return static_cast<uint8_t>(std::lround(a + (b - a) * opacity)); };
  set(x, y, {mix(old.r, color.r), mix(old.g, color.g), mix(old.b, color.b)});
}

void Canvas::fill(int x, int y, int width, int height, Rgb color) {
  for (int j = std::max(0, y); j < std::min(height_, y + height); ++j)
    for (int i = std::max(0, x); i < std::min(width_, x + width); ++i) set(i, j, color);
}

void Canvas::frame(int x, int y, int width, int height, Rgb color) {
  fill(x, y, width, 1, color);
  fill(x, y + height - 1, width, 1, color);
  fill(x, y, 1, height, color);
  fill(x + width - 1, y, 1, height, color);
}

// One pixel per step along the longer axis, shared between the two nearest across (Xiaolin Wu, 1991).
void Canvas::line(Vec2 a, Vec2 b, Rgb color, double opacity) {
  const bool steep = std::fabs(b.y - a.y) > std::fabs(b.x - a.x);
  if (steep) a = {a.y, a.x}, b = {b.y, b.x};
  if (a.x > b.x) std::swap(a, b);
  const double limit = steep ? height_ : width_;
  if (!(b.x >= 0 && a.x <= limit)) return;
  const double slope = b.x > a.x ? (b.y - a.y) / (b.x - a.x) : 0;
  const int first = static_cast<int>(std::lround(std::max(a.x, 0.0))),
            last = static_cast<int>(std::lround(std::min(b.x, limit)));
  for (int i = first; i <= last; ++i) {
    const double y = a.y + slope * (std::clamp<double>(i, a.x, b.x) - a.x), low = std::floor(y), share = y - low;
    if (!(low > -2 && low < 20000)) continue;
    const int j = static_cast<int>(low);
    steep ? blend(j, i, color, opacity * (1 - share)) : blend(i, j, color, opacity * (1 - share));
    steep ? blend(j + 1, i, color, opacity * share) : blend(i, j + 1, color, opacity * share);
  }
}

void Canvas::text(int x, int y, std::string_view text, Rgb color, int scale) {
  for (const char c : text) {
    const uint8_t* glyph = kFont[c >= 32 && c < 127 ? c - 32 : '?' - 32];
    for (int column = 0; column < 5; ++column)
      for (int row = 0; row < 7; ++row)
        if ((glyph[column] >> row) & 1) fill(x + column * scale, y + row * scale, scale, scale, color);
    x += 6 * scale;
  }
}

Rgb viridis(double t) {
  static constexpr Rgb stops[] = {{68, 1, 84},    {72, 26, 108},  {71, 47, 125},  {65, 68, 135},
                                  {57, 86, 140},  {49, 104, 142}, {42, 120, 142}, {35, 136, 142},
                                  {31, 152, 139}, {34, 168, 132}, {53, 183, 121}, {84, 197, 104},
                                  {122, 209, 81}, {165, 219, 54}, {210, 226, 27}, {253, 231, 37}};
  if (std::isnan(t)) return kGrey;
  const double at = std::clamp(t, 0.0, 1.0) * 15;
  const int i = std::min(14, static_cast<int>(at));
  auto mix = [&](uint8_t a, uint8_t b) { return static_cast<uint8_t>(std::lround(a + (b - a) * (at - i))); };
  return {mix(stops[i].r, stops[i + 1].r), mix(stops[i].g, stops[i + 1].g), mix(stops[i].b, stops[i + 1].b)};
}

Rgb diverging(double t) {
  if (std::isnan(t)) return kGrey;
  t = std::clamp(t, -1.0, 1.0);
  const double s = std::fabs(t);
  const Rgb end = t < 0 ? Rgb{33, 102, 172} : Rgb{178, 24, 43};
  auto mix = [&](uint8_t b) { return static_cast<uint8_t>(std::lround(255 + (b - 255) * s)); };
  return {mix(end.r), mix(end.g), mix(end.b)};
}

uint8_t srgb(double linear) {
  const double x = std::clamp(linear, 0.0, 1.0);
  const double y = x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1 / 2.4) - 0.055;
  return static_cast<uint8_t>(std::lround(255 * y));
}

}  // namespace suite
