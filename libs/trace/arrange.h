// Sorting objects into tiles by their places. Internal.
#pragma once
#include <algorithm>
#include <cfloat>
#include <cmath>
#include <map>
#include <tuple>

#include "trace/embree_internal.h"

namespace suite {

inline constexpr double kTileSize = 2048;  // m: float positions inside are good to 0.1 mm

inline Box3 enlarged(Box3 box, double by) {
  box.low -= {by, by, by};
  box.high += {by, by, by};
  return box;
}

// Parts a cell so that each part has one heavy object, such as a tile of a terrain, and what stands nearest to it.
inline std::vector<std::vector<uint32_t>> parted(std::vector<uint32_t> members, std::span<const Box3> boxes,
                                                 const auto& heavy) {
  std::vector<uint32_t> heavies;
  std::copy_if(members.begin(), members.end(), std::back_inserter(heavies), heavy);
  if (heavies.size() < 2) return {std::move(members)};
  std::vector<std::vector<uint32_t>> parts(heavies.size());
  for (const uint32_t i : members) {
    const auto distance = [&](uint32_t h) { return length(boxes[h].center() - boxes[i].center()); };
    const auto nearest = std::min_element(heavies.begin(), heavies.end(),
                                          [&](uint32_t a, uint32_t b) { return distance(a) < distance(b); });
    const auto own = std::find(heavies.begin(), heavies.end(), i);
    parts[static_cast<size_t>((own != heavies.end() ? own : nearest) - heavies.begin())].push_back(i);
  }
  return parts;
}

// One tile for what spans a few kilometres, a grid by centres otherwise; what is larger than a cell gets its own, and
// so does what is heavy. members: indices into boxes (ENU, not empty). fill(tile, members) gets the tile with its
// bounds and their middle as origin; it may choose another origin.
template <class Heavy, class Fill>
void arrange(TileSet& set, std::span<const uint32_t> members, std::span<const Box3> boxes, const Heavy& heavy,
             const Fill& fill) {
  const auto widest = [](Vec3 size) { return std::max({size.x, size.y, size.z}); };
  const auto add = [&](std::span<const uint32_t> own) {
    Tile& tile = *set.tiles.emplace_back(std::make_unique<Tile>());
    for (const uint32_t i : own) tile.bounds.grow(boxes[i]);
    tile.origin = tile.bounds.center();
    fill(tile, own);
    const Vec3 low = tile.bounds.low - tile.origin, high = tile.bounds.high - tile.origin;
    for (int a = 0; a < 3; ++a) tile.scale = std::max({tile.scale, std::fabs(low[a]), std::fabs(high[a])});
    // Rays are advanced to these bounds. Embree's coherent packets miss surfaces that lie within some ulp of where
    // their rays begin (seen with 3.13.5 and a sheet in the upper face of a tile), so they begin well before.
    tile.bounds = enlarged(tile.bounds, tile.slack() + tile.scale / 1024);
  };
  Box3 all;
  for (const uint32_t i : members) all.grow(boxes[i]);
  if (members.empty()) return;
  if (widest(all.size()) <= 2 * kTileSize) return add(members);
  std::map<std::tuple<long, long, long, long>, std::vector<uint32_t>> cells;
  for (const uint32_t i : members) {
    const Vec3 c = boxes[i].center();
    if (widest(boxes[i].size()) > 2 * kTileSize)
      cells[{0, 0, 0, 1 + static_cast<long>(i)}].push_back(i);
    else
      cells[{std::lround(c.x / kTileSize), std::lround(c.y / kTileSize), std::lround(c.z / kTileSize), 0}].push_back(i);
  }
  for (auto& [key, cell] : cells)
    for (const std::vector<uint32_t>& own : parted(std::move(cell), boxes, heavy)) add(own);
}

}  // namespace suite
