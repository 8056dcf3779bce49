// Where a point lies on a raster, and what the raster says there. Hot: called at hits.
//
// Pixel coordinates: (0, 0) is the outer corner of the first pixel, column right, row down; pixel (i, j) covers [i,
// i+1) x [j, j+1) and its centre is at (i + 1/2, j + 1/2). A drape takes them from x and y (columns towards +x, rows
// towards -y); by UV column = u width, row = (1 - v) height, v running upwards as in OBJ files.
#pragma once
#include <optional>
#include <span>

#include "scene/scene.h"

namespace suite {

// A point of the surface as maps see it.
struct MapPlace {
  Vec3 position;  // m, ENU
  Vec2 uv;
  // As HeatedPlace has them, for temperatures that differ from part to part; left unknown where only maps are asked.
  Dir normal = {};
  uint32_t instance = kNone, triangle = kNone;
};

// Pixel coordinates of a place; may lie outside the raster.
Vec2 pixel_of(Projection projection, const Drape& drape, uint32_t width, uint32_t height, const MapPlace& place);

// Column or row of a map under its extension rule; -1 outside.
long extended(double position, uint32_t size, Drape::Extend rule);

// The class at a place, as an index into ClassMap::materials; kNone outside a map that does not extend.
uint32_t class_at(const ClassMap& map, const MapPlace& place);

// All channels at a place under the map's filter; false outside a map that does not extend. out: map.channels values.
bool values_at(const PropertyMap& map, const MapPlace& place, std::span<float> out);
// The first channel only.
std::optional<float> value_at(const PropertyMap& map, const MapPlace& place);

// Slope of the first channel in units per pixel to the right (x) and downwards (y): the difference of linearly
// interpolated values half a pixel to either side, which is continuous. Zero outside a map that does not extend.
Vec2 slope_at(const PropertyMap& map, const MapPlace& place);

}  // namespace suite
