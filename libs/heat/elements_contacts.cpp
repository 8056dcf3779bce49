// Which elements touch: cells of meshes along their triangles' edges (mesh_contacts.cpp), those of exact surfaces along
// the lines of their faces' coordinates, and across the faces' borders where another face, or the other end of the same
// one, goes on.
#include <algorithm>
#include <array>
#include <cmath>

#include "heat/cell_contacts.h"
#include "heat/elements.h"

namespace suite {

class Elements::GridTouching {
 public:
  GridTouching(const Grid& grid, const Affine3& to_world)
      : grid_(grid), to_world_(to_world), to_local_(to_world.inverse()) {
    for (uint32_t c = 0; c < grid_.cells.size(); ++c) {
      const Grid::Cell& cell = grid_.cells[c];
      const Vec2 middle{(cell.low.x + cell.high.x) / 2, (cell.low.y + cell.high.y) / 2};
      const double scale = size_of(to_world_);
      middles_.push_back({world(cell.face, middle), std::sqrt(grid_.area(c) * scale)});
    }
    std::vector<Line> lines;
    for (uint32_t c = 0; c < grid_.cells.size(); ++c)
      for (int k = 0; k < 4; ++k)
        if (const Side side = side_of(c, k); side.still > 0 && side.still < 1)
          lines.push_back({{grid_.cells[c].face, k / 2, std::llround(std::ldexp(side.still, 40))}, c, k});
        else
          add_border(c, side);
    std::ranges::stable_sort(lines, {}, &Line::key);
    std::vector<CellSide> sides;
    for (size_t k = 0; k < lines.size();) {
      const std::array<int64_t, 3> key = lines[k].key;
      sides.clear();
      for (; k < lines.size() && lines[k].key == key; ++k)
        each_part(lines[k].cell, side_of(lines[k].cell, lines[k].which),
                  [&](const CellSide& s) { sides.push_back(s); });
      contacts_.add_line(sides);
    }
  }
  std::vector<CellContact> found() && { return std::move(contacts_).found(middles_); }

 private:
  static constexpr size_t kParts = 8;  // of a side: chords; on a border each is asked what lies behind it
  struct Side {                        // in the coordinates of its face
    double still, low, up;
    bool by_x;  // the coordinate that changes
    Vec2 at(double x) const { return by_x ? Vec2{x, still} : Vec2{still, x}; }
  };
  struct Line {
    std::array<int64_t, 3> key;  // face, coordinate that stands still, its value
    uint32_t cell;
    int which;
  };

  Vec3 world(size_t face, Vec2 p) const { return to_world_.point(grid_.faces.point(face, p.x, p.y).position); }

  // 0, 1: low and high x; 2, 3: low and high y.
  Side side_of(uint32_t c, int which) const {
    const auto& [face, low, high] = grid_.cells[c];
    return which < 2 ? Side{which == 0 ? low.x : high.x, low.y, high.y, false}
                     : Side{which == 2 ? low.y : high.y, low.x, high.x, true};
  }

  template <class Use>
  void each_part(uint32_t c, const Side& side, const Use& use) const {
    const size_t face = grid_.cells[c].face;
    for (size_t k = 0; k < kParts; ++k) {
      const auto share = [&](double parts) { return side.low + (side.up - side.low) * parts / kParts; };
      CellSide s{c, share(static_cast<double>(k)), share(static_cast<double>(k) + 1), {}, {}, {}};
      s.a = world(face, side.at(s.from)), s.b = world(face, side.at(s.to));
      const Vec3 along = s.b - s.a, in = middles_[c].place - (s.a + s.b) / 2;
      const double l = length(along);
      if (!(l > 1e-9 * middles_[c].size)) continue;  // at a pole
      const Vec3 across = in - along * (dot(in, along) / (l * l));
      if (!(length(across) > 0)) continue;
      s.out = across / -length(across);
      use(s);
    }
  }

  void add_border(uint32_t c, const Side& side) {
    each_part(c, side, [&](const CellSide& s) { add_behind(s, grid_.cells[c].face, side.at((s.from + s.to) / 2)); });
  }

  // A little further than the face goes: beside it, or on the next face around an edge.
  void add_behind(const CellSide& s, size_t face, Vec2 place) {
    const PrimitiveFaces::Point on = grid_.faces.point(face, place.x, place.y);
    const Vec3 p = to_world_.point(on.position), normal = normalized(to_world_.normal(on.normal));
    const double step = 1e-6 * middles_[s.cell].size;
    for (const Vec3 way : {s.out, -normal, s.out - normal}) {
      const Vec3 beside = to_local_.point(p + way * step);
      const PrimitiveFaces::Place behind = grid_.faces.place(beside);
      const uint32_t other = grid_.cell_at(behind);
      const Vec3 off = world(behind.face, {behind.a, behind.b}) - (p + way * step);
      if (other == s.cell || length(off) > 2 * step) continue;
      contacts_.add(s, other);
      return;
    }
  }

  const Grid& grid_;
  const Affine3& to_world_;
  Affine3 to_local_;
  std::vector<CellMiddle> middles_;
  CellContacts contacts_;
};

std::vector<ElementContact> Elements::contacts() const {
  std::vector<ElementContact> out;
  for (const Group& group : groups_) {
    const Affine3& place = slots_[group.first_slot].to_world;
    const std::vector<CellContact> cells =
        group.mesh ? group.mesh->contacts(place) : GridTouching(grids_[group.grid], place).found();
    for (const CellContact& c : cells) {
      const uint32_t a = group.first_cell + c.a, b = group.first_cell + c.b;
      for (uint32_t e = first_element_[a]; e < first_element_[a + 1]; ++e)
        for (uint32_t f = first_element_[b]; f < first_element_[b + 1]; ++f)
          out.push_back({e, f, c.ratio * elements_[e].share * elements_[f].share * group.slots});
    }
  }
  return out;
}

}  // namespace suite
