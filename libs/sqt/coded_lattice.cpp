#include "sqt/coded_lattice.h"

#include <algorithm>
#include <bit>

namespace suite::sqt {

CodedLattice::CodedLattice(Region region, size_t width) : region_(region), row_(padded_row(width)), room_(2 * row_) {
  for (uint32_t i = 0; i < cell_count(kRootOrder); ++i) {
    const CellId id = CellId::of(kRootOrder, i);
    if (!region_.holds(id)) continue;
    Node root;
    root.at = xy_of(id);
    root.order = kRootOrder;
    nodes_.push_back(root);
  }
  values_.resize(nodes_.size() * row_ + 16);
  slopes_.resize(2 * nodes_.size() * row_ + 16);
  // Roots have no level above: whom they touch is looked for.
  for (Node& node : nodes_) {
    const auto around = edge_neighbours(node.id());
    for (size_t e = 0; e < 4; ++e) {
      const CellId there = region_.half_only && !region_.holds(around[e]) ? mirrored(around[e]) : around[e];
      for (size_t j = 0; j < nodes_.size(); ++j)
        if (nodes_[j].id() == there) node.link[e].node = static_cast<int32_t>(j);
    }
  }
}

void CodedLattice::reserve(size_t nodes) {
  nodes_.reserve(nodes);
  values_.reserve(nodes * row_);
  slopes_.reserve(2 * nodes * row_);
}

void CodedLattice::divide(size_t i, const int16_t* const details[3]) {
  const size_t first = nodes_.size();
  Node parent = nodes_[i];
  parent.first_child = static_cast<int32_t>(first);
  for (uint32_t k = 0; k < 4; ++k) {
    Node child;
    child.at = {parent.at.face, 2 * parent.at.x + (k & 1), 2 * parent.at.y + (k >> 1)};
    child.order = parent.order + 1;
    child.parent = static_cast<int32_t>(i);
    if (!region_.holds(child.at, child.order)) continue;
    nodes_.push_back(child);
    ++parent.child_count;
    parent.child_mask = static_cast<uint8_t>(parent.child_mask | (1u << k));
  }
  nodes_[i] = parent;
  values_.resize(nodes_.size() * row_ + 16);
  slopes_.resize(2 * nodes_.size() * row_ + 16);
  int16_t* to[4] = {};
  size_t next = first;
  for (uint32_t k = 0; k < 4; ++k)
    if (parent.child_mask & (1u << k)) to[k] = value(next++);
  const int16_t *v = value(i), *gx = slope(i, 0), *gy = slope(i, 1);
  // Sums may wrap round on the way; what is within bounds comes out right.
  const Short16 most = Short16{} + int16_t{LogScale::kMost}, least = -most;
  for (size_t j = 0; j < row_; j += 16) {
    const Ushort16 mid = load<Ushort16>(v + j);
    Ushort16 x = reinterpret_cast<Ushort16>(load<Short16>(gx + j) >> 2),
             y = reinterpret_cast<Ushort16>(load<Short16>(gy + j) >> 2), xy{};
    if (details[0]) x += load<Ushort16>(details[0] + j);
    if (details[1]) y += load<Ushort16>(details[1] + j);
    if (details[2]) xy = load<Ushort16>(details[2] + j);
    const Ushort16 child[4] = {mid - x - y + xy, mid + x - y - xy, mid - x + y - xy, mid + x + y + xy};
    for (size_t k = 0; k < 4; ++k) {
      if (!to[k]) continue;
      Short16 c = reinterpret_cast<Short16>(child[k]);
      c = c > most ? most : c;
      store(to[k] + j, c < least ? least : c);
    }
  }
}

int CodedLattice::predicted(size_t i, uint32_t k, size_t column) const {
  const int x = slope(i, 0)[column] >> 2, y = slope(i, 1)[column] >> 2;
  return value(i)[column] + (k & 1 ? x : -x) + (k & 2 ? y : -y);
}

CodedLattice::Link CodedLattice::find_link(const Node& node, size_t edge) const {
  const uint32_t last = (1u << node.order) - 1;
  CellXY there = node.at;
  uint32_t& moving = edge < 2 ? there.x : there.y;
  if (edge & 1 ? moving < last : moving > 0)
    moving += edge & 1 ? 1 : -1u;
  else
    there = neighbour(node.at, node.order, edge);
  if (!region_.holds(there, node.order)) {
    if (!region_.half_only) return {};
    there = mirrored(there);
    if (!region_.holds(there, node.order)) return {};
  }
  // Under the same parent (its own mirror image), or under what the parent's link leads to.
  const Node& parent = nodes_[static_cast<size_t>(node.parent)];
  const bool inside = there.face == parent.at.face && there.x >> 1 == parent.at.x && there.y >> 1 == parent.at.y;
  const int32_t above = inside ? node.parent : parent.link[edge].node;
  if (above < 0) return {};
  const Node& cover = nodes_[static_cast<size_t>(above)];
  if (cover.order == parent.order && cover.first_child >= 0) {
    const uint32_t k = (there.x & 1) | ((there.y & 1) << 1);
    if (!(cover.child_mask & (1u << k))) return {};
    return {cover.first_child + std::popcount(cover.child_mask & ((1u << k) - 1)), 0, 0};
  }
  const int n = 1 << (node.order - cover.order);
  return {above, static_cast<int16_t>(2 * static_cast<int>(there.x) + 1 - n * (2 * static_cast<int>(cover.at.x) + 1)),
          static_cast<int16_t>(2 * static_cast<int>(there.y) + 1 - n * (2 * static_cast<int>(cover.at.y) + 1))};
}

void CodedLattice::link(size_t begin, size_t end) {
  for (size_t i = begin; i < end; ++i) {
    Node& node = nodes_[i];
    const Node& parent = nodes_[static_cast<size_t>(node.parent)];
    const uint32_t k = (node.at.x & 1) | ((node.at.y & 1) << 1);
    for (uint32_t e = 0; e < 4; ++e) {
      // The usual case first: a sister across the parent's middle.
      const uint32_t bit = e < 2 ? 1 : 2, sister = k ^ bit;
      if (((k & bit) != 0) != ((e & 1) != 0) && (parent.child_mask & (1u << sister)))
        node.link[e] = {parent.first_child + std::popcount(parent.child_mask & ((1u << sister) - 1)), 0, 0};
      else
        node.link[e] = find_link(node, e);
    }
  }
}

int CodedLattice::divided_around(size_t i) const {
  int n = 0;
  for (const Link& l : nodes_[i].link) {
    if (l.node < 0) continue;
    const Node& there = nodes_[static_cast<size_t>(l.node)];
    n += there.order == nodes_[i].order && there.first_child >= 0;
  }
  return n;
}

// Values at the cell across an edge; null where the region ends.
const int16_t* CodedLattice::across(const Node& node, size_t edge, int16_t* room) const {
  const Link& l = node.link[edge];
  if (l.node < 0) return nullptr;
  const size_t i = static_cast<size_t>(l.node);
  const int between = node.order - nodes_[i].order;
  const int16_t* v = value(i);
  if (between == 0) return v;
  const int16_t *gx = slope(i, 0), *gy = slope(i, 1);
  const Short16 most = Short16{} + int16_t{LogScale::kMost}, least = -most;
  if (between == 1) {  // a quarter of the slopes to either side, as below without leaving 16 bits
    for (size_t j = 0; j < row_; j += 16) {
      Short16 a = load<Short16>(gx + j), b = load<Short16>(gy + j);
      a = l.x < 0 ? -a : a, b = l.y < 0 ? -b : b;
      Short16 c = load<Short16>(v + j) + (((a >> 1) + (b >> 1) + (a & b & 1)) >> 1);
      c = c > most ? most : c;
      store(room + j, c < least ? least : c);
    }
    return room;
  }
  const int x = l.x, y = l.y;
  for (size_t j = 0; j < row_; j += 8) {
    const auto wide = [j](const int16_t* from) { return __builtin_convertvector(load<Short8>(from + j), Int8); };
    Int8 c = wide(v) + ((x * wide(gx) + y * wide(gy)) >> (between + 1));
    c = c > LogScale::kMost ? Int8{} + LogScale::kMost : c;
    c = c < -LogScale::kMost ? Int8{} - LogScale::kMost : c;
    store(room + j, __builtin_convertvector(c, Short8));
  }
  return room;
}

void CodedLattice::find_slopes(size_t i) {
  for (size_t axis = 0; axis < 2; ++axis) {
    const int16_t* low = across(nodes_[i], 2 * axis, room_.data());
    const int16_t* high = across(nodes_[i], 2 * axis + 1, room_.data() + row_);
    const int16_t* v = value(i);
    int16_t* g = slope_row(i, axis);
    if (!low && !high) {
      std::fill_n(g, row_, int16_t{0});
      continue;
    }
    for (size_t j = 0; j < row_; j += 16) {
      const Short16 mid = load<Short16>(v + j);
      if (low && high) {
        const Short16 a = mid - load<Short16>(low + j), b = load<Short16>(high + j) - mid;
        const Short16 up = a < 0 ? -a : a, down = b < 0 ? -b : b, least = up < down ? up : down;
        const Short16 mean = (up >> 1) + (down >> 1) + (up & down & 1);
        // min(mean, 2 least) without leaving 16 bits
        const Short16 twice = reinterpret_cast<Short16>(reinterpret_cast<Ushort16>(least) << 1);
        const Short16 size = (mean >> 1) < least ? mean : twice;
        const Short16 both = a ^ b;
        store(g + j, both < 0 ? Short16{} : a < 0 ? -size : size);
      } else {
        store(g + j, low ? mid - load<Short16>(low + j) : load<Short16>(high + j) - mid);
      }
    }
  }
}

}  // namespace suite::sqt
