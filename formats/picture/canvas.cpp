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

namespace {

double distance_to_segment(Vec2 p, Vec2 a, Vec2 b) {
  const double dx = b.x - a.x, dy = b.y - a.y, square = dx * dx + dy * dy;
  const double t = square > 0 ? std::clamp(((p.x - a.x) * dx + (p.y - a.y) * dy) / square, 0.0, 1.0) : 0;
  return std::hypot(p.x - a.x - t * dx, p.y - a.y - t * dy);
}

bool dot(const uint8_t* glyph, int column, int row) {
  return column >= 0 && row >= 0 && column < 5 && row < 7 && ((glyph[column] >> row) & 1);
}

// Neighbouring dots of a glyph, joined: side by side always, across a corner where no dot fills it.
std::vector<std::pair<Vec2, Vec2>> strokes_of(const uint8_t* glyph) {
  std::vector<std::pair<Vec2, Vec2>> list;
  for (int c = 0; c < 5; ++c)
    for (int r = 0; r < 7; ++r) {
      if (!dot(glyph, c, r)) continue;
      const Vec2 at{c + 0.5, r + 0.5};
      bool joined = false;
      auto join = [&](int dc, int dr) {
        if (!dot(glyph, c + dc, r + dr)) return;
        joined = true;
        if (dc > 0 || (dc == 0 && dr > 0)) list.push_back({at, {at.x + dc, at.y + dr}});
      };
      for (const int step : {-1, 1}) join(step, 0), join(0, step);
      for (const int dc : {-1, 1})
        for (const int dr : {-1, 1})
          if (!dot(glyph, c + dc, r) && !dot(glyph, c, r + dr)) join(dc, dr);
      if (!joined) list.push_back({at, at});
    }
  return list;
}

}  // namespace

void Canvas::stroke(Vec2 a, Vec2 b, double width, Rgb color, double opacity) {
  if (!(std::min(a.x, b.x) > -width_ && std::max(a.x, b.x) < 2 * width_ && std::min(a.y, b.y) > -height_ &&
        std::max(a.y, b.y) < 2 * height_))
    return;
  const double reach = width / 2 + 1;
  for (int y = static_cast<int>(std::min(a.y, b.y) - reach); y <= std::max(a.y, b.y) + reach; ++y)
    for (int x = static_cast<int>(std::min(a.x, b.x) - reach); x <= std::max(a.x, b.x) + reach; ++x) {
      const double covered = std::clamp(width / 2 + 0.5 - distance_to_segment({x + 0.5, y + 0.5}, a, b), 0.0, 1.0);
      if (covered > 0) blend(x, y, color, opacity * covered);
    }
}

void Canvas::text(int x, int y, std::string_view text, Rgb color, int scale) {
  for (const char c : text) {
    const uint8_t* glyph = kFont[c >= 32 && c < 127 ? c - 32 : '?' - 32];
    if (scale == 1) {
      for (int column = 0; column < 5; ++column)
        for (int row = 0; row < 7; ++row)
          if (dot(glyph, column, row)) set(x + column, y + row, color);
    } else {
      const auto strokes = strokes_of(glyph);
      for (int j = 0; j < 8 * scale; ++j)
        for (int i = 0; i < 6 * scale; ++i) {
          double nearest = 10;
          for (const auto& [a, b] : strokes)
            nearest = std::min(nearest, distance_to_segment({(i + 0.5) / scale, (j + 0.5) / scale}, a, b));
          const double covered = std::clamp((0.42 - nearest) * scale + 0.5, 0.0, 1.0);
          if (covered > 0) blend(x + i, y + j, color, covered);
        }
    }
    x += 6 * scale;
  }
}

namespace {

// Between 16 stops in equal steps; grey for NaN.
Rgb between(const Rgb (&stops)[16], double t) {
  if (std::isnan(t)) return kGrey;
  const double at = std::clamp(t, 0.0, 1.0) * 15;
  const int i = std::min(14, static_cast<int>(at));
  auto mix = [&](uint8_t a, uint8_t b) { return static_cast<uint8_t>(std::lround(a + (b - a) * (at - i))); };
  return {mix(stops[i].r, stops[i + 1].r), mix(stops[i].g, stops[i + 1].g), mix(stops[i].b, stops[i + 1].b)};
}

}  // namespace

Rgb viridis(double t) {
  static constexpr Rgb stops[] = {{68, 1, 84},    {72, 26, 108},  {71, 47, 125},  {65, 68, 135},
                                  {57, 86, 140},  {49, 104, 142}, {42, 120, 142}, {35, 136, 142},
                                  {31, 152, 139}, {34, 168, 132}, {53, 183, 121}, {84, 197, 104},
                                  {122, 209, 81}, {165, 219, 54}, {210, 226, 27}, {253, 231, 37}};
  return between(stops, t);
}

Rgb inferno(double t) {
  static constexpr Rgb stops[] = {{0, 0, 4},      {12, 8, 38},    {36, 12, 79},   {66, 10, 104},
                                  {93, 18, 110},  {120, 28, 109}, {147, 38, 103}, {174, 48, 92},
                                  {199, 62, 76},  {221, 81, 58},  {237, 105, 37}, {248, 133, 15},
                                  {252, 165, 10}, {250, 198, 45}, {242, 230, 97}, {252, 255, 164}};
  return between(stops, t);
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
