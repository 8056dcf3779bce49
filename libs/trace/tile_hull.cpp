#include "trace/tile_hull.h"

#include <algorithm>
#include <cmath>

#include "trace/arrange.h"

namespace suite {

namespace {

constexpr double kOfACell = 32;  // triangles or objects of a cell, at the least, on average

// As Box3, but grown by comparisons alone, which are instructions: fmin and fmax are calls.
struct Span3 {
  double low[3] = {INFINITY, INFINITY, INFINITY}, high[3] = {-INFINITY, -INFINITY, -INFINITY};
  void grow(const double (&from)[3], const double (&to)[3]) {
    for (int a = 0; a < 3; ++a) {
      low[a] = from[a] < low[a] ? from[a] : low[a];
      high[a] = to[a] > high[a] ? to[a] : high[a];
    }
  }
};

// Sorts boxes into a grid by their middles; a cell's box grows around what lies in it, beyond the cell's own sides.
class Grid {
 public:
  Grid(const Box3& within, uint32_t edge) : edge_(edge), cells_(size_t{edge} * edge) {
    const Vec3 size = within.size();
    const int thin = size.x <= size.y && size.x <= size.z ? 0 : size.y <= size.z ? 1 : 2;
    for (int k = 0; k < 2; ++k) {
      axis_[k] = (thin + 1 + k) % 3;
      low_[k] = within.low[axis_[k]];
      scale_[k] = edge / std::max(size[axis_[k]], 1e-300);
    }
  }
  void add(const Span3& box) { cells_[place(box, 1) * edge_ + place(box, 0)].grow(box.low, box.high); }
  std::span<const Span3> cells() const { return cells_; }

 private:
  size_t place(const Span3& box, int k) const {
    const double at = (0.5 * (box.low[axis_[k]] + box.high[axis_[k]]) - low_[k]) * scale_[k];
    return static_cast<size_t>(std::clamp(at, 0.0, edge_ - 1.0));
  }
  const uint32_t edge_;
  int axis_[2];
  double low_[2], scale_[2];
  std::vector<Span3> cells_;
};

// Each triangle's box, in the frame that to_frame leads to.
void add_triangles(Grid& grid, const Mesh& mesh, const auto& to_frame) {
  const float* const positions = mesh.positions.data();
  const uint32_t* corner = mesh.indices.data();
  for (size_t t = 0; t < mesh.triangle_count(); ++t) {
    Span3 box;
    for (int c = 0; c < 3; ++c) {
      const float* p = &positions[3 * size_t{*corner++}];
      const Vec3 at = to_frame(Vec3{p[0], p[1], p[2]});
      const double point[3] = {at.x, at.y, at.z};
      box.grow(point, point);
    }
    grid.add(box);
  }
}

// Of what is placed once, such as the tiles of a terrain, the triangles say more than the box around all.
bool by_triangles(const PlacedSet& set, const PlacedObject& o, const World& world) {
  return !set.moving && !set.groups && o.mesh != kNone && world.meshes[o.mesh].uses == 1;
}

void add_set(Grid& grid, const PlacedSet& set, const World& world, Vec3 origin) {
  for (size_t k = 0; k < set.objects.size(); ++k) {
    const PlacedObject& o = set.frame->objects[set.objects[k]];
    if (by_triangles(set, o, world)) {
      const Mesh& mesh = world.scene->meshes[o.mesh];
      add_triangles(grid, mesh, [&](Vec3 p) { return o.place->point(mesh.origin + p) - origin; });
      continue;
    }
    Box3 whole;
    for (size_t t = 0; t < set.times; ++t) whole.grow(set.boxes[k * set.times + t]);
    const Vec3 low = whole.low - origin, high = whole.high - origin;
    grid.add({{low.x, low.y, low.z}, {high.x, high.y, high.z}});
  }
}

TileHull::Cell rounded(const Span3& box, double slack) {
  TileHull::Cell cell{{1, 1, 1}, {-1, -1, -1}};
  if (!(box.low[0] <= box.high[0])) return cell;
  for (size_t a = 0; a < 3; ++a) {
    cell.low[a] = std::nextafter(static_cast<float>(box.low[a] - slack), -INFINITY);
    cell.high[a] = std::nextafter(static_cast<float>(box.high[a] + slack), INFINITY);
  }
  return cell;
}

TileHull::Cell around(const TileHull::Cell& a, const TileHull::Cell& b) {
  if (a.empty() || b.empty()) return a.empty() ? b : a;
  TileHull::Cell all;
  for (size_t k = 0; k < 3; ++k)
    all.low[k] = std::min(a.low[k], b.low[k]), all.high[k] = std::max(a.high[k], b.high[k]);
  return all;
}

// What is put into the grid of a tile.
size_t items_of(const Tile& tile, const World& world) {
  const auto triangles = [&](const PlacedObject& o) { return world.scene->meshes[o.mesh].triangle_count(); };
  size_t items = 0;
  for (const uint32_t object : tile.direct) items += triangles(world.flat.objects[object]);
  for (const auto& set : tile.sets)
    for (const uint32_t i : set->objects) {
      const PlacedObject& o = set->frame->objects[i];
      items += by_triangles(*set, o, world) ? triangles(o) : 1;
    }
  return items;
}

// Where the level whose grid has `edge` cells along a side begins: 0, 1, 5, 21, ...
constexpr size_t first_of(uint32_t edge) { return (size_t{edge} * edge - 1) / 3; }

}  // namespace

void TileHull::make(const Tile& tile, const World& world) {
  if (made()) return;
  origin_ = tile.origin;
  const auto items = static_cast<double>(items_of(tile, world));
  while (edge_ < kMostEdge && edge_ * edge_ * kOfACell < items) edge_ *= 2;
  Grid grid({tile.bounds.low - origin_, tile.bounds.high - origin_}, edge_);
  for (const uint32_t object : tile.direct)
    add_triangles(grid, world.scene->meshes[world.flat.objects[object].mesh], [](Vec3 p) { return p; });
  for (const auto& set : tile.sets) add_set(grid, *set, world, origin_);
  levels_.resize(first_of(2 * edge_));
  // Twice the slack: once for where float puts the geometry, once for where it puts the rays and their ends.
  for (size_t k = 0; k < grid.cells().size(); ++k)
    levels_[first_of(edge_) + k] = rounded(grid.cells()[k], 2 * tile.slack());
  for (uint32_t edge = edge_ / 2; edge > 0; edge /= 2)
    for (uint32_t row = 0; row < edge; ++row)
      for (uint32_t column = 0; column < edge; ++column) {
        const Cell* below = &levels_[first_of(2 * edge) + size_t{2 * row} * 2 * edge + 2 * column];
        levels_[first_of(edge) + size_t{row} * edge + column] =
            around(around(below[0], below[1]), around(below[2 * edge], below[2 * edge + 1]));
      }
  made_.store(true, std::memory_order_release);
}

bool TileHull::meets(const Ray& ray, double t_max) const {
  struct Place {
    uint32_t edge, row, column;
  };
  Place open[4 * 16];  // four children a level, and never more than 16 levels
  size_t count = 1;
  open[0] = {1, 0, 0};
  const Vec3 from = ray.origin - origin_, inverse = inverse_of(ray.direction);
  while (count > 0) {
    const Place at = open[--count];
    const Cell& cell = levels_[first_of(at.edge) + size_t{at.row} * at.edge + at.column];
    double enter = 0, leave = 0;
    if (cell.empty() || !clip({{cell.low[0], cell.low[1], cell.low[2]}, {cell.high[0], cell.high[1], cell.high[2]}},
                              from, inverse, t_max, enter, leave))
      continue;
    if (at.edge == edge_) return true;
    for (uint32_t k = 0; k < 4; ++k) open[count++] = {2 * at.edge, 2 * at.row + k / 2, 2 * at.column + k % 2};
  }
  return false;
}

std::vector<const TileHull*> hulls_of(const Tracer& tracer) {
  std::vector<const TileHull*> hulls;
  const auto add = [&](const TileSet& set) {
    for (const auto& tile : set.tiles)
      if (tile->hull.made()) hulls.push_back(&tile->hull);
  };
  add(tracer.world_->tiles);
  if (tracer.moving_) add(tracer.moving_->tiles);
  return hulls;
}

}  // namespace suite
