// Where the cells of a mesh touch: inside of triangles that are cut along the cuts, else along edges that triangles
// share. Corners at one place are one corner, whichever numbers they have. Edges that meet the middle of others, as
// careless meshes have them, touch nothing.
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <tuple>
#include <unordered_map>

#include "heat/mesh_cells.h"

namespace suite {

namespace {

constexpr double kOn = 1e-9;  // of coordinates on a triangle: on an edge

struct Corners {
  std::vector<uint32_t> number;  // by vertex of the mesh
  explicit Corners(const Mesh& mesh) {
    struct Hash {
      size_t operator()(const std::array<uint32_t, 3>& k) const {
        uint64_t h = 0;
        for (const uint32_t x : k) h = (h ^ x) * 0x9e3779b97f4a7c15u, h ^= h >> 29;
        return h;
      }
    };
    std::unordered_map<std::array<uint32_t, 3>, uint32_t, Hash> known;
    const size_t n = mesh.vertex_count();
    for (size_t v = 0; v < n; ++v) {
      std::array<uint32_t, 3> key;
      for (size_t k = 0; k < 3; ++k) key[k] = std::bit_cast<uint32_t>(mesh.positions[3 * v + k] + 0.0f);  // no -0
      number.push_back(known.emplace(key, static_cast<uint32_t>(v)).first->second);
    }
  }
};

// The edge of the triangle that both lie on: that after this corner; nothing inside.
std::optional<size_t> edge_of(Vec2 p, Vec2 q) {
  if (std::fabs(p.y) < kOn && std::fabs(q.y) < kOn) return 0;
  if (std::fabs(p.x + p.y - 1) < kOn && std::fabs(q.x + q.y - 1) < kOn) return 1;
  if (std::fabs(p.x) < kOn && std::fabs(q.x) < kOn) return 2;
  return {};
}

// Of a line between coordinates of a triangle: a x + b y = c with a unit direction, to within rounding.
std::array<int64_t, 3> line_of(Vec2 p, Vec2 q) {
  Vec2 along{q.x - p.x, q.y - p.y};
  const double l = std::hypot(along.x, along.y);
  const bool turn = std::fabs(along.x) > kOn * l ? along.x < 0 : along.y < 0;
  along.x /= turn ? -l : l, along.y /= turn ? -l : l;
  const double c = p.x * along.y - p.y * along.x;
  const auto rounded = [](double x) { return static_cast<int64_t>(std::floor(std::ldexp(x, 26) + 0.3819660113)); };
  return {rounded(along.x), rounded(along.y), rounded(c)};
}

}  // namespace

class MeshCells::Touching {
 public:
  Touching(const MeshCells& cells, const Affine3& to_world) : m_(cells), to_world_(to_world) {
    const Corners corner(m_.mesh_);
    SUITE_CHECK(m_.order_.size() < (1u << 29));
    edges_.reserve(3 * m_.order_.size());
    for (uint32_t c = 0; c < m_.size(); ++c)
      for (uint32_t k = m_.first_[c]; k < m_.end_[c]; ++k) add_piece(c, k, corner);
    std::stable_sort(inside_.begin(), inside_.end(), [](const Inside& a, const Inside& b) {
      return a.triangle != b.triangle ? a.triangle < b.triangle : a.line < b.line;
    });
    std::ranges::sort(edges_, [](const Edge& a, const Edge& b) {
      return std::tie(a.low, a.high, a.cell, a.at) < std::tie(b.low, b.high, b.cell, b.at);
    });
    lines(inside_, [](const Inside& a, const Inside& b) { return a.triangle == b.triangle && a.line == b.line; });
    lines(edges_, [](const Edge& a, const Edge& b) { return a.low == b.low && a.high == b.high; });
  }

  std::vector<CellContact> found() && {
    std::vector<CellMiddle> middles;
    for (uint32_t c = 0; c < m_.size(); ++c) middles.push_back(middle_of(c));
    return std::move(contacts_).found(middles);
  }

 private:
  struct Inside {  // a side within a triangle
    uint32_t cell, triangle;
    std::array<int64_t, 3> line;
    Vec2 p, q, tip;
  };
  // A side on an edge of the mesh: many, so kept short. at: 8 x the place of its triangle in the order of cells + 4 if
  // the edge's lower corner is its second + its number in the piece.
  struct Edge {
    uint32_t low, high, cell, at;
  };

  Vec3 world(uint32_t triangle, Vec2 p) const {
    const auto [a, b, c] = m_.corners(triangle);
    return to_world_.point(a + (b - a) * p.x + (c - a) * p.y);
  }

  Piece piece_at(uint32_t cell, uint32_t triangle) const {
    const bool whole = m_.end_[cell] - m_.first_[cell] > 1 || (m_.split_[triangle] <= 1 && m_.piece_[cell] == kNone);
    return whole ? Piece{Vec2{0, 0}, Vec2{1, 0}, Vec2{0, 1}} : m_.piece_of(cell);
  }

  void add_piece(uint32_t cell, uint32_t place, const Corners& corner) {
    const uint32_t triangle = m_.order_[place];
    const Piece piece = piece_at(cell, triangle);
    for (size_t k = 0; k < 3; ++k) {
      const Vec2 p = piece[k], q = piece[(k + 1) % 3], tip = piece[(k + 2) % 3];
      const std::optional<size_t> edge = edge_of(p, q);
      if (!edge) {
        inside_.push_back({cell, triangle, line_of(p, q), p, q, tip});
        continue;
      }
      const auto number = [&](size_t at) { return corner.number[m_.mesh_.indices[3 * size_t{triangle} + at % 3]]; };
      const uint32_t low = number(*edge), high = number(*edge + 1);
      const uint32_t turned = low > high ? 4 : 0;
      edges_.push_back({std::min(low, high), std::max(low, high), cell, 8 * place + turned + static_cast<uint32_t>(k)});
    }
  }

  // As the line is counted: from its lower number to its higher.
  CellSide side(uint32_t cell, uint32_t triangle, Vec2 p, Vec2 q, Vec2 tip, double from, double to) const {
    if (from > to) std::swap(p, q), std::swap(from, to);
    CellSide s{cell, from, to, world(triangle, p), world(triangle, q), {}};
    const Vec3 along = normalized(s.b - s.a), in = world(triangle, tip) - s.a;
    s.out = normalized(along * dot(in, along) - in);
    return s;
  }
  CellSide side(const Edge& e) const {
    const uint32_t triangle = m_.order_[e.at / 8], k = e.at % 4;
    const Piece piece = piece_at(e.cell, triangle);
    const Vec2 p = piece[k], q = piece[(k + 1) % 3], tip = piece[(k + 2) % 3];
    const size_t edge = *edge_of(p, q);
    const auto along = [&](Vec2 x) { return edge == 0 ? x.x : edge == 1 ? x.y : 1 - x.y; };
    const bool turned = e.at & 4;
    return side(e.cell, triangle, p, q, tip, turned ? 1 - along(p) : along(p), turned ? 1 - along(q) : along(q));
  }
  CellSide side(const Inside& i) const {
    // The longer of both coordinates of the line's direction.
    const bool by_x = std::llabs(i.line[0]) >= std::llabs(i.line[1]);
    return side(i.cell, i.triangle, i.p, i.q, i.tip, by_x ? i.p.x : i.p.y, by_x ? i.q.x : i.q.y);
  }

  template <class Kind, class Same>
  void lines(const std::vector<Kind>& all, const Same& same) {
    std::vector<CellSide> sides;
    for (size_t k = 0; k < all.size();) {
      const size_t begin = k;
      bool several = false;
      for (; k < all.size() && same(all[begin], all[k]); ++k) several = several || all[k].cell != all[begin].cell;
      if (!several) continue;
      sides.clear();
      for (size_t i = begin; i < k; ++i) sides.push_back(side(all[i]));
      contacts_.add_line(sides);
    }
  }

  CellMiddle middle_of(uint32_t cell) const {
    Vec3 sum{};
    double area = 0;
    for (uint32_t k = m_.first_[cell]; k < m_.end_[cell]; ++k) {
      const bool one = m_.end_[cell] - m_.first_[cell] == 1;
      const Piece piece = one ? m_.piece_of(cell) : Piece{Vec2{0, 0}, Vec2{1, 0}, Vec2{0, 1}};
      const uint32_t t = m_.order_[k];
      const Vec3 a = world(t, piece[0]), u = world(t, piece[1]) - a, v = world(t, piece[2]) - a, n = cross(u, v);
      const double twice = length(n);
      // The centre of the circle around it, where it lies inside.
      const double least = std::fmin(std::fmin(dot(u, v), dot(u, u - v)), dot(v, v - u));
      if (one && twice > 0 && least >= -1e-9 * (dot(u, u) + dot(v, v)))
        return {a + (cross(n, u) * dot(v, v) + cross(v, n) * dot(u, u)) / (2 * twice * twice), std::sqrt(twice / 2)};
      sum += (a + (u + v) / 3) * (twice / 2), area += twice / 2;
    }
    return {area > 0 ? sum / area : sum, std::sqrt(area)};
  }

  const MeshCells& m_;
  const Affine3& to_world_;
  std::vector<Inside> inside_;
  std::vector<Edge> edges_;
  CellContacts contacts_;
};

std::vector<CellContact> MeshCells::contacts(const Affine3& to_world) const {
  return Touching(*this, to_world).found();
}

}  // namespace suite
