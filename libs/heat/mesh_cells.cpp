#include "heat/mesh_cells.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <utility>

#include "base/parallel.h"

namespace suite {

namespace {

constexpr double kFold = 0.3;     // of a normal's component: more from one facet to the next is a fold
constexpr int kMostSplit = 1000;  // of a side: a million cells of one triangle

// Parts of a triangle cut s x s: rows by u, in a row upright and turned ones in turn.
uint32_t part_of(int s, double u, double v) {
  const int i = std::clamp(static_cast<int>(u * s), 0, s - 1), j = std::clamp(static_cast<int>(v * s), 0, s - 1 - i);
  const bool turned = (u * s - i) + (v * s - j) > 1 && j < s - 1 - i;
  const int before = s * s - (s - i) * (s - i);
  return static_cast<uint32_t>(before + 2 * j + (turned ? 1 : 0));
}

struct SubTriangle {
  int i, j;
  bool turned;
};
SubTriangle part_at(int s, int number) {
  int i = 0;
  for (int row = 2 * s - 1; number >= row; ++i, row -= 2) number -= row;
  return {i, number / 2, number % 2 == 1};
}

}  // namespace

std::array<Vec3, 3> MeshCells::corners(uint32_t triangle) const {
  std::array<Vec3, 3> out;
  for (size_t c = 0; c < 3; ++c) {
    const float* f = &mesh_.positions[3 * size_t{mesh_.indices[3 * size_t{triangle} + c]}];
    out[c] = mesh_.origin + Vec3{f[0], f[1], f[2]};
  }
  return out;
}

MeshCells::MeshCells(const Mesh& mesh, const std::vector<uint32_t>& material_of_part, double wanted)
    : mesh_(mesh), cell_(mesh.triangle_count(), kNone), split_(mesh.triangle_count(), 0) {
  SUITE_CHECK_EQ(material_of_part.size(), mesh.parts.size());
  std::vector<std::vector<Facet>> by_material;
  std::vector<uint32_t> known;
  for (size_t p = 0; p < mesh.parts.size(); ++p) {
    if (material_of_part[p] == kNone) continue;
    auto at = std::find(known.begin(), known.end(), material_of_part[p]);
    if (at == known.end()) {
      known.push_back(material_of_part[p]), by_material.emplace_back();
      at = known.end() - 1;
    }
    std::vector<Facet>& facets = by_material[static_cast<size_t>(at - known.begin())];
    for (uint32_t k = 0; k < mesh.parts[p].triangle_count; ++k) {
      const uint32_t t = mesh.parts[p].first_triangle + k;
      const auto [a, b, c] = corners(t);
      const Vec3 n = cross(b - a, c - a);
      const double twice = length(n);
      if (!(twice > 0)) continue;
      facets.push_back({(a + b + c) / 3, n / twice, twice / 2, t});
      total_ += twice / 2;
    }
  }
  const double target = total_ / std::max(wanted, 1.0);
  for (size_t m = 0; m < known.size(); ++m) {
    std::vector<Facet>& facets = by_material[m];
    for (const Facet& f : facets)
      if (f.area > 1.5 * target) cut(f, target, known[m]);
    std::erase_if(facets, [&](const Facet& f) { return f.area > 1.5 * target; });
    gather(facets, 0, facets.size(), target, known[m]);
  }
}

void MeshCells::add_cell(double area, uint32_t material) {
  first_.push_back(end_.empty() ? 0 : end_.back());
  end_.push_back(static_cast<uint32_t>(order_.size()));
  piece_.push_back(kNone);
  areas_.push_back(area);
  materials_.push_back(material);
}

void MeshCells::cut(const Facet& facet, double target, uint32_t material) {
  const int s = std::clamp(static_cast<int>(std::lround(std::sqrt(facet.area / target))), 1, kMostSplit);
  cell_[facet.triangle] = static_cast<uint32_t>(areas_.size());
  split_[facet.triangle] = static_cast<uint16_t>(s);
  const double part = facet.area / s / s;
  for (int k = 0; k < s * s; ++k) {
    order_.push_back(facet.triangle);
    until_.push_back(part);
    part_.push_back(static_cast<uint32_t>(k));
    add_cell(part, material);
  }
}

// Halves by area along the longest extent of place, or of direction where that is longer: all that are to be halved at
// once, as they have nothing in common.
void MeshCells::gather(std::vector<Facet>& facets, size_t begin, size_t end, double target, uint32_t material) {
  struct Range {
    size_t begin, end, middle;
  };
  std::vector<Range> open, next;
  std::vector<std::array<size_t, 2>> whole;
  if (begin < end) open.push_back({begin, end, begin});
  while (!open.empty()) {
    parallel_for(0, open.size(), 1, [&](size_t first, size_t last) {
      for (size_t k = first; k < last; ++k) {
        Range& part = open[k];
        double area = 0;
        for (size_t i = part.begin; i < part.end; ++i) area += facets[i].area;
        if (part.end - part.begin > 1 && area > 1.5 * target) part.middle = divide(facets, part.begin, part.end, area);
      }
    });
    for (const Range& part : open) {
      if (part.middle == part.begin) {
        whole.push_back({part.begin, part.end});
        continue;
      }
      next.push_back({part.begin, part.middle, part.begin});
      next.push_back({part.middle, part.end, part.middle});
    }
    open.swap(next), next.clear();
  }
  std::ranges::sort(whole);
  for (const auto& [first, last] : whole) {
    double sum = 0;
    for (size_t i = first; i < last; ++i) {
      cell_[facets[i].triangle] = static_cast<uint32_t>(areas_.size());
      split_[facets[i].triangle] = 1;
      order_.push_back(facets[i].triangle);
      until_.push_back(sum += facets[i].area);
    }
    part_.push_back(0);
    add_cell(sum, material);
  }
}

namespace {

struct Ordered {
  double key;
  uint32_t triangle, at;
  bool operator<(const Ordered& o) const { return key != o.key ? key < o.key : triangle < o.triangle; }
};

// As std::sort, in passes over the bytes of the keys: many are sorted several times faster.
void sort_by_bytes(std::vector<Ordered>& order) {
  constexpr size_t kMany = 4096, kByte = 256;
  if (order.size() < kMany) return std::sort(order.begin(), order.end());
  const auto bits = [](double key) {
    const auto b = std::bit_cast<uint64_t>(key + 0.0);  // -0 as 0
    return b >> 63 ? ~b : b | uint64_t{1} << 63;
  };
  std::array<std::array<size_t, kByte>, 8> counts{};
  for (const Ordered& o : order)
    for (size_t k = 0; k < 8; ++k) ++counts[k][bits(o.key) >> (8 * k) & 255];
  std::vector<Ordered> other(order.size());
  for (size_t k = 0; k < 8; ++k) {
    if (std::ranges::find(counts[k], order.size()) != counts[k].end()) continue;  // all alike
    size_t sum = 0;
    for (size_t& count : counts[k]) sum += std::exchange(count, sum);
    for (const Ordered& o : order) other[counts[k][bits(o.key) >> (8 * k) & 255]++] = o;
    order.swap(other);
  }
  for (size_t k = 0; k < order.size();) {
    size_t end = k + 1;
    while (end < order.size() && order[end].key == order[k].key) ++end;
    const auto first = order.begin() + static_cast<std::ptrdiff_t>(k);
    if (end - k > 1) std::sort(first, order.begin() + static_cast<std::ptrdiff_t>(end));
    k = end;
  }
}

}  // namespace

// Sorts by what is compared alone, which is less to move, and then the facets.
template <class Iterator, class Key>
void MeshCells::put_in_order(Iterator from, Iterator to, const Key& key) {
  std::vector<Ordered> order;
  order.reserve(static_cast<size_t>(to - from));
  for (auto f = from; f != to; ++f) order.push_back({key(*f), f->triangle, static_cast<uint32_t>(f - from)});
  sort_by_bytes(order);
  const std::vector<Facet> before(from, to);
  for (const Ordered& place : order) *from++ = before[place.at];
}

// Puts facets in order and says where the second half begins.
size_t MeshCells::divide(std::vector<Facet>& facets, size_t begin, size_t end, double area) {
  Box3 place, facing;
  for (size_t i = begin; i < end; ++i) place.grow(facets[i].centre), facing.grow(facets[i].normal);
  const Vec3 size = place.size(), turn = facing.size();
  // A right angle counts for more than the width of what is cut.
  const double width = std::max({size.x, size.y, size.z});
  int axis = 0;
  double longest = -1;
  for (int k = 0; k < 6; ++k)
    if (const double extent = k < 3 ? size[k] : 1.5 * width * turn[k - 3]; extent > longest) longest = extent, axis = k;
  const auto key = [&](const Facet& f) { return axis < 3 ? f.centre[axis] : f.normal[axis - 3]; };
  const auto from = facets.begin() + static_cast<std::ptrdiff_t>(begin),
             to = facets.begin() + static_cast<std::ptrdiff_t>(end);
  put_in_order(from, to, key);
  // In the middle, but through folds where there are any.
  double before = 0, widest = axis < 3 ? INFINITY : kFold;
  size_t middle = begin + 1, fold = 0;
  for (size_t i = begin + 1; i < end; ++i) {
    before += facets[i - 1].area;
    if (before - facets[i - 1].area / 2 < area / 2) middle = i;
    if (const double jump = key(facets[i]) - key(facets[i - 1]);
        jump > widest && before > 0.1 * area && before < 0.9 * area)
      widest = jump, fold = i;
  }
  return fold > 0 ? fold : middle;
}

void MeshCells::split(uint32_t cell) { end_[cell] - first_[cell] == 1 ? cut_piece(cell) : halve(cell); }

MeshCells::Piece MeshCells::piece_of(size_t cell) const {
  if (piece_[cell] != kNone) return pieces_[piece_[cell]];
  const int s = std::max<int>(1, split_[order_[first_[cell]]]);
  const SubTriangle p = part_at(s, static_cast<int>(part_[cell]));
  const auto at = [&](int i, int j) { return Vec2{double{1} * (p.i + i) / s, double{1} * (p.j + j) / s}; };
  return p.turned ? Piece{at(1, 1), at(0, 1), at(1, 0)} : Piece{at(0, 0), at(1, 0), at(0, 1)};
}

void MeshCells::cut_piece(uint32_t cell) {
  const uint32_t triangle = order_[first_[cell]], other = static_cast<uint32_t>(size());
  const Piece piece = piece_of(cell);
  const auto [a, b, c] = corners(triangle);
  const auto place = [&](Vec2 p) { return (b - a) * p.x + (c - a) * p.y; };
  size_t side = 0;
  double longest = -1;
  for (size_t k = 0; k < 3; ++k)
    if (const double l = length(place(piece[(k + 1) % 3]) - place(piece[k])); l > longest) longest = l, side = k;
  const Vec2 p = piece[side], q = piece[(side + 1) % 3], tip = piece[(side + 2) % 3],
             middle{(p.x + q.x) / 2, (p.y + q.y) / 2};
  const bool left = (tip.x - middle.x) * (p.y - middle.y) - (tip.y - middle.y) * (p.x - middle.x) >= 0;
  left ? cuts_.add(cell, middle, tip, other) : cuts_.add(cell, tip, middle, other);
  const double area = areas_[cell] / 2;
  if (piece_[cell] == kNone) piece_[cell] = static_cast<uint32_t>(pieces_.size()), pieces_.emplace_back();
  pieces_[piece_[cell]] = {p, middle, tip};
  areas_[cell] = until_[first_[cell]] = area;
  first_.push_back(static_cast<uint32_t>(order_.size())), order_.push_back(triangle), until_.push_back(area);
  end_.push_back(static_cast<uint32_t>(order_.size()));
  piece_.push_back(static_cast<uint32_t>(pieces_.size())), pieces_.push_back({middle, q, tip});
  part_.push_back(part_[cell]), areas_.push_back(area), materials_.push_back(materials_[cell]);
}

void MeshCells::halve(uint32_t cell) {
  const auto other = static_cast<uint32_t>(size());
  std::vector<Facet> facets;
  for (uint32_t k = first_[cell]; k < end_[cell]; ++k) {
    const auto [a, b, c] = corners(order_[k]);
    const Vec3 n = cross(b - a, c - a);
    facets.push_back({(a + b + c) / 3, n / length(n), length(n) / 2, order_[k]});
  }
  const size_t middle = divide(facets, 0, facets.size(), areas_[cell]);
  double sum = 0, first_half = 0;
  for (size_t k = 0; k < facets.size(); ++k) {
    if (k == middle) first_half = sum, sum = 0;
    order_[first_[cell] + k] = facets[k].triangle;
    until_[first_[cell] + k] = sum += facets[k].area;
    if (k >= middle) cell_[facets[k].triangle] = other;
  }
  first_.push_back(first_[cell] + static_cast<uint32_t>(middle)), end_.push_back(end_[cell]);
  end_[cell] = first_.back();
  areas_[cell] = first_half;
  piece_.push_back(kNone), part_.push_back(0), areas_.push_back(sum), materials_.push_back(materials_[cell]);
}

MeshCells::Point MeshCells::point(size_t cell, double x, double y, double z) const {
  const auto begin = until_.begin() + first_[cell], end = until_.begin() + end_[cell];
  const auto at = std::min(std::upper_bound(begin, end, x * *(end - 1)), end - 1);
  const uint32_t triangle = order_[static_cast<size_t>(at - until_.begin())];
  const double root = std::sqrt(y);
  return within(cell, triangle, 1 - root, z * root);
}

MeshCells::Point MeshCells::within(size_t cell, uint32_t triangle, double u, double v) const {
  if (piece_[cell] != kNone) {
    const auto& [a, b, c] = pieces_[piece_[cell]];
    return {triangle, a.x + u * (b.x - a.x) + v * (c.x - a.x), a.y + u * (b.y - a.y) + v * (c.y - a.y)};
  }
  const int s = split_[triangle];
  if (s <= 1) return {triangle, u, v};
  const SubTriangle part = part_at(s, static_cast<int>(part_[cell]));
  return part.turned ? Point{triangle, (part.i + 1 - u) / s, (part.j + 1 - v) / s}
                     : Point{triangle, (part.i + u) / s, (part.j + v) / s};
}

uint32_t MeshCells::cell_of(uint32_t triangle, Vec3 local) const {
  if (whole(triangle)) return cell_[triangle];
  const auto [a, b, c] = corners(triangle);
  const Vec3 e1 = b - a, e2 = c - a, p = local - a;
  const double d11 = dot(e1, e1), d12 = dot(e1, e2), d22 = dot(e2, e2), p1 = dot(p, e1), p2 = dot(p, e2);
  const double scale = 1 / (d11 * d22 - d12 * d12);
  const double u = std::clamp((d22 * p1 - d12 * p2) * scale, 0.0, 1.0);
  const double v = std::clamp((d11 * p2 - d12 * p1) * scale, 0.0, 1.0 - u);
  return cuts_.find(cell_[triangle] + (split_[triangle] > 1 ? part_of(split_[triangle], u, v) : 0), {u, v});
}

}  // namespace suite
