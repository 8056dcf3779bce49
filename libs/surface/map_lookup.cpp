#include "surface/map_lookup.h"

#include <algorithm>
#include <cmath>

#include "scene/curvature.h"

namespace suite {

namespace {

// Four pixels around a point and their weights; the same one four times under the nearest rule.
struct Taps {
  size_t pixel[4];
  float weight[4];
  int count = 0;
};

// A row or column that interpolation reaches for beyond the border of the raster.
long beside(long cell, uint32_t size, Drape::Extend rule) {
  if (rule == Drape::Extend::repeat)
    return (cell % static_cast<long>(size) + static_cast<long>(size)) % static_cast<long>(size);
  return std::clamp(cell, 0L, static_cast<long>(size) - 1);
}

bool find_taps(const PropertyMap& map, Vec2 at, bool linear, Taps& taps) {
  const Drape::Extend rule = map.drape.extend;
  const long column = extended(at.x, map.width, rule), row = extended(at.y, map.height, rule);
  if (column < 0 || row < 0) return false;
  if (!linear) {
    taps.pixel[0] = static_cast<size_t>(row) * map.width + static_cast<size_t>(column);
    taps.weight[0] = 1;
    taps.count = 1;
    return true;
  }
  // Positions relative to the pixel found, so that repeated and clamped places interpolate as the first one does.
  const bool inside_x = at.x >= 0 && at.x < map.width, inside_y = at.y >= 0 && at.y < map.height;
  const bool whole_x = rule == Drape::Extend::repeat || inside_x, whole_y = rule == Drape::Extend::repeat || inside_y;
  const double fx = whole_x ? at.x - std::floor(at.x) - 0.5 : 0, fy = whole_y ? at.y - std::floor(at.y) - 0.5 : 0;
  const long other_x = beside(column + (fx < 0 ? -1 : 1), map.width, rule),
             other_y = beside(row + (fy < 0 ? -1 : 1), map.height, rule);
  const auto wx = static_cast<float>(std::fabs(fx)), wy = static_cast<float>(std::fabs(fy));
  const auto pixel = [&](long r, long c) { return static_cast<size_t>(r) * map.width + static_cast<size_t>(c); };
  taps = {{pixel(row, column), pixel(row, other_x), pixel(other_y, column), pixel(other_y, other_x)},
          {(1 - wx) * (1 - wy), wx * (1 - wy), (1 - wx) * wy, wx * wy},
          4};
  return true;
}

float first_channel(const PropertyMap& map, const Taps& taps) {
  float sum = 0;
  for (int i = 0; i < taps.count; ++i) sum += taps.weight[i] * map.values[taps.pixel[i] * map.channels];
  return sum;
}

}  // namespace

Vec2 pixel_of(Projection projection, const Drape& drape, uint32_t width, uint32_t height, const MapPlace& place) {
  if (projection == Projection::uv) return {place.uv.x * width, (1 - place.uv.y) * height};
  const Vec3 p = drape.plane ? drape.plane->point(place.position) : place.position;
  return {(p.x - drape.origin_x) / drape.gsd_x, (drape.origin_y - p.y) / drape.gsd_y};
}

long extended(double position, uint32_t size, Drape::Extend rule) {
  const double cell = std::floor(position);
  if (cell >= 0 && cell < size) return static_cast<long>(cell);
  if (!(std::fabs(cell) < 1e15)) return -1;
  switch (rule) {
    case Drape::Extend::clamp:
      return cell < 0 ? 0 : static_cast<long>(size) - 1;
    case Drape::Extend::repeat: {
      const long r = static_cast<long>(std::fmod(cell, size));
      return r < 0 ? r + static_cast<long>(size) : r;
    }
    case Drape::Extend::none:
      return -1;
  }
  return -1;
}

uint32_t class_at(const ClassMap& map, const MapPlace& place) {
  const Vec2 at = pixel_of(map.projection, map.drape, map.width, map.height, place);
  const long column = extended(at.x, map.width, map.drape.extend), row = extended(at.y, map.height, map.drape.extend);
  if (column < 0 || row < 0) return kNone;
  return map.classes[static_cast<size_t>(row) * map.width + static_cast<size_t>(column)];
}

// False in a gap (NaN), too. Between pixel centres a gap is where the nearest pixel is one; other gaps count as the
// nearest pixel.
bool values_at(const PropertyMap& map, const MapPlace& place, std::span<float> out) {
  Taps taps;
  const bool linear = map.filter == PropertyMap::Filter::linear && map.kind != MapKind::curve_index;
  if (!find_taps(map, pixel_of(map.projection, map.drape, map.width, map.height, place), linear, taps)) return false;
  const auto gap = [&](int i) { return std::isnan(map.values[taps.pixel[i] * map.channels]); };
  if (gap(0)) return false;
  std::fill(out.begin(), out.end(), 0.0f);
  for (int i = 1; i < taps.count; ++i)
    if (gap(i)) taps.pixel[i] = taps.pixel[0];
  for (int i = 0; i < taps.count; ++i) {
    const float* value = &map.values[taps.pixel[i] * map.channels];
    for (size_t c = 0; c < out.size(); ++c) out[c] += taps.weight[i] * value[c];
  }
  return true;
}

std::optional<float> value_at(const PropertyMap& map, const MapPlace& place) {
  float value = 0;
  if (!values_at(map, place, {&value, 1})) return std::nullopt;
  return value;
}

Vec2 slope_at(const PropertyMap& map, const MapPlace& place) {
  const Vec2 at = pixel_of(map.projection, map.drape, map.width, map.height, place);
  Taps taps;
  if (!find_taps(map, at, true, taps)) return {};
  const float here = first_channel(map, taps);
  // At the rim of a map that does not extend the difference is one-sided.
  const auto step = [&](double dx, double dy) {
    const bool there = find_taps(map, {at.x + dx, at.y + dy}, true, taps);
    return there ? first_channel(map, taps) : here;
  };
  return {step(0.5, 0) - step(-0.5, 0), step(0, 0.5) - step(0, -0.5)};
}

}  // namespace suite
