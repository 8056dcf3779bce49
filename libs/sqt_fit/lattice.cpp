#include "sqt_fit/lattice.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"

namespace suite::sqt {

Lattice::Lattice(Region region, size_t width) : region_(region), width_(width), table_(1024, 0) {
  for (uint32_t i = 0; i < cell_count(kRootOrder); ++i) {
    const CellId id = CellId::of(kRootOrder, i);
    if (!region_.holds(id)) continue;
    insert(id, nodes_.size());
    nodes_.push_back({id});
  }
  value_.resize(nodes_.size() * width_);
  slope_.resize(2 * nodes_.size() * width_);
}

void Lattice::reserve(size_t nodes) {
  nodes_.reserve(nodes);
  value_.reserve(nodes * width_);
  slope_.reserve(2 * nodes * width_);
}

void Lattice::insert(CellId id, size_t index) {
  if (2 * nodes_.size() >= table_.size()) {
    std::vector<uint64_t> old(4 * table_.size(), 0);
    old.swap(table_);
    for (const uint64_t e : old)
      if (e) insert({static_cast<uint32_t>(e >> 32)}, (e & 0xFFFFFFFFu) - 1);
  }
  size_t at = (id.code * 0x9E3779B1u) & (table_.size() - 1);
  while (table_[at]) at = (at + 1) & (table_.size() - 1);
  table_[at] = (uint64_t{id.code} << 32) | (index + 1);
}

int32_t Lattice::find(CellId id) const {
  size_t at = (id.code * 0x9E3779B1u) & (table_.size() - 1);
  while (table_[at]) {
    if ((table_[at] >> 32) == id.code) return static_cast<int32_t>((table_[at] & 0xFFFFFFFFu) - 1);
    at = (at + 1) & (table_.size() - 1);
  }
  return -1;
}

void Lattice::divide(size_t i) {
  const CellId id = nodes_[i].id;
  nodes_[i].first_child = static_cast<int32_t>(nodes_.size());
  for (uint32_t k = 0; k < 4; ++k) {
    const CellId child = id.child(k);
    if (!region_.holds(child)) continue;
    insert(child, nodes_.size());
    nodes_.push_back({child});
    ++nodes_[i].child_count;
    nodes_[i].child_mask = static_cast<uint8_t>(nodes_[i].child_mask | (1u << k));
  }
  value_.resize(nodes_.size() * width_);
  slope_.resize(2 * nodes_.size() * width_);
}

void Lattice::predict(size_t i, uint32_t k, std::span<float> out) const {
  const float sx = k & 1 ? 0.25f : -0.25f, sy = k & 2 ? 0.25f : -0.25f;
  const float* v = &value_[i * width_];
  const float* gx = &slope_[2 * i * width_];
  const float* gy = gx + width_;
  for (size_t j = 0; j < width_; ++j) out[j] = v[j] + (sx * gx[j] + sy * gy[j]);
}

const float* Lattice::estimate(CellId id, std::span<float> room) const {
  if (!region_.holds(id)) {
    if (!region_.half_only) return nullptr;
    id = mirrored(id);
    if (!region_.holds(id)) return nullptr;
  }
  if (const int32_t i = find(id); i >= 0) return &value_[static_cast<size_t>(i) * width_];
  // Climb to the node that was not divided and take its plane at this cell's centre.
  const CellXY at = xy_of(id);
  CellId up = id;
  int32_t i = -1;
  while (i < 0 && up.order() > kRootOrder) {
    up = up.parent();
    i = find(up);
  }
  if (i < 0) return nullptr;
  const CellXY over = xy_of(up);
  const float n = static_cast<float>(1u << (id.order() - up.order()));
  const float dx = (static_cast<float>(at.x) + 0.5f) / n - static_cast<float>(over.x) - 0.5f;
  const float dy = (static_cast<float>(at.y) + 0.5f) / n - static_cast<float>(over.y) - 0.5f;
  const float* v = &value_[static_cast<size_t>(i) * width_];
  const float* gx = &slope_[2 * static_cast<size_t>(i) * width_];
  const float* gy = gx + width_;
  float* out = room.data();
  for (size_t j = 0; j < width_; ++j) out[j] = v[j] + (dx * gx[j] + dy * gy[j]);
  return out;
}

int Lattice::divided_around(size_t i) const {
  int n = 0;
  for (CellId id : edge_neighbours(nodes_[i].id)) {
    if (region_.half_only && !region_.holds(id)) id = mirrored(id);
    const int32_t j = find(id);
    n += j >= 0 && nodes_[static_cast<size_t>(j)].first_child >= 0;
  }
  return n;
}

void Lattice::compute_slopes(size_t begin, size_t end) {
  std::vector<float> low_room(width_), high_room(width_);
  for (size_t i = begin; i < end; ++i) {
    const auto around = edge_neighbours(nodes_[i].id);
    // An edge between faces may turn the coordinates, but "the neighbour across the -x edge" stays what it is.
    for (size_t axis = 0; axis < 2; ++axis) {
      const float* low = estimate(around[2 * axis], low_room);
      const float* high = estimate(around[2 * axis + 1], high_room);
      const float* v = &value_[i * width_];
      float* g = &slope_[(2 * i + axis) * width_];
      if (low && high) {
        for (size_t j = 0; j < width_; ++j) {
          const float a = v[j] - low[j], b = high[j] - v[j], mid = 0.5f * (a + b);
          const float smaller = std::fabs(a) < std::fabs(b) ? std::fabs(a) : std::fabs(b);
          const float size = std::fabs(mid) < 2 * smaller ? std::fabs(mid) : 2 * smaller;
          g[j] = a * b > 0 ? std::copysign(size, mid) : 0.0f;
        }
      } else if (low || high) {
        for (size_t j = 0; j < width_; ++j) g[j] = low ? v[j] - low[j] : high[j] - v[j];
      } else {
        std::fill_n(g, width_, 0.0f);
      }
    }
  }
}

}  // namespace suite::sqt
