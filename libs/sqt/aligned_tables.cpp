#include "sqt/aligned_tables.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include "base/memory.h"
#include "base/parallel.h"

namespace suite::sqt {

namespace {

// Columns to rows.
void transpose(Int8 (&r)[8]) {
  const Int8 even{0, 8, 1, 9, 4, 12, 5, 13}, odd{2, 10, 3, 11, 6, 14, 7, 15};
  Int8 a[8], b[8];
  for (int i = 0; i < 8; i += 2) {
    a[i] = __builtin_shuffle(r[i], r[i + 1], even);     // columns 0 1 | 4 5 of two rows
    a[i + 1] = __builtin_shuffle(r[i], r[i + 1], odd);  // columns 2 3 | 6 7
  }
  const Int8 low{0, 1, 8, 9, 4, 5, 12, 13}, high{2, 3, 10, 11, 6, 7, 14, 15};
  for (int i = 0; i < 8; i += 4) {
    b[i] = __builtin_shuffle(a[i], a[i + 2], low);           // columns 0 | 4 of four rows
    b[i + 1] = __builtin_shuffle(a[i], a[i + 2], high);      // 1 | 5
    b[i + 2] = __builtin_shuffle(a[i + 1], a[i + 3], low);   // 2 | 6
    b[i + 3] = __builtin_shuffle(a[i + 1], a[i + 3], high);  // 3 | 7
  }
  const Int8 front{0, 1, 2, 3, 8, 9, 10, 11}, back{4, 5, 6, 7, 12, 13, 14, 15};
  for (int i = 0; i < 4; ++i) {
    r[i] = __builtin_shuffle(b[i], b[i + 4], front);
    r[i + 4] = __builtin_shuffle(b[i], b[i + 4], back);
  }
}

// [leaf][channel][view] to [leaf][view][channel], four numbers each.
void put_views_outside(const AlignedLayout& layout, size_t leaves, UnsetVector<int16_t>& plane) {
  const size_t width = layout.width(), views = layout.views(), channels = layout.channels;
  if (channels == 1) return;
  using Four = uint64_t;
  static_assert(sizeof(Four) == AlignedSheet::kStride * sizeof(int16_t));
  parallel_for(0, leaves, 256, [&](size_t begin, size_t end) {
    std::vector<Four> row(width), turned(width);
    for (size_t i = begin; i < end; ++i) {
      int16_t* const at = &plane[i * width * AlignedSheet::kStride];
      std::memcpy(row.data(), at, width * sizeof(Four));
      for (size_t v = 0; v < views; ++v)
        for (size_t c = 0; c < channels; ++c) turned[v * channels + c] = row[c * views + v];
      std::memcpy(at, turned.data(), width * sizeof(Four));
    }
  });
}

}  // namespace

AlignedTables::AlignedTables(const AlignedLayout& layout, std::vector<AlignedSheet> stored)
    : row_(padded_row(layout.width())) {
  const size_t width = layout.width();
  for (const AlignedSheet& s : stored) leaves_ += s.leaves.size();
  tiles_ = (leaves_ + kTile - 1) / kTile;
  put_in_order(stored);
  const std::vector<double> sum = sum_masses(stored);
  columns_.resize(row_);
  for (size_t j = 0; j < width; ++j) columns_[j].scale = sum[j] > 0 ? static_cast<float>(0x1.ff8p30 / sum[j]) : 0;
  cumulative_.reserve(tiles_ * row_ * kTile);
  expect_large(cumulative_.data(), cumulative_.capacity() * sizeof(int32_t));
  cumulative_.resize(tiles_ * row_ * kTile);
  tile_sum_.resize(row_ * (tiles_ + 1));
  parallel_for(0, row_ / 8, (row_ / 8 + 15) / 16, [&](size_t begin, size_t end) { accumulate(stored, begin, end); });
  for (Column& c : columns_) c.inverse_total = c.total ? 1 / static_cast<float>(c.total) : 0;
  size_t first = 0;
  for (AlignedSheet& s : stored) {
    Sheet& sheet = sheets_.emplace_back();
    sheet.tree = Tree(s.leaves);
    sheet.scale = s.scale;
    sheet.plane = std::move(s.plane);
    put_views_outside(layout, s.leaves.size(), sheet.plane);
    sheet.first = first;
    first += s.leaves.size();
    sheet.inverse_area = std::move(s.inverse_area);
  }
}

// Along a curve that fills the sphere: neighbours in u are neighbours in direction then, and points that are well
// spread in u are so on the sphere.
void AlignedTables::put_in_order(const std::vector<AlignedSheet>& stored) {
  std::vector<std::pair<uint32_t, uint32_t>> along;
  order_.reserve(leaves_);
  for (const AlignedSheet& s : stored) {
    const auto first = static_cast<uint32_t>(order_.size());
    along.clear();
    for (const CellId id : s.leaves)
      along.emplace_back(id.index() << 2 * (kMaxOrder - id.order()), first + static_cast<uint32_t>(along.size()));
    std::sort(along.begin(), along.end());
    for (const auto& [place, leaf] : along) order_.push_back(leaf);
  }
}

// Of every column. Tiles first, so that neither the number of leaves nor that of threads matters.
std::vector<double> AlignedTables::sum_masses(const std::vector<AlignedSheet>& stored) const {
  std::vector<double> sum(row_, 0.0);
  for (const AlignedSheet& s : stored) {
    const size_t leaves = s.leaves.size(), tiles = (leaves + kTile - 1) / kTile;
    std::vector<float> partial(tiles * row_, 0.0f);
    parallel_for(0, tiles, 16, [&](size_t begin, size_t end) {
      for (size_t i = begin * kTile; i < std::min(leaves, end * kTile); ++i) {
        float* to = &partial[i / kTile * row_];
        const uint16_t* mass = &s.mass[i * row_];
        for (size_t j = 0; j < row_; j += 8)
          store(to + j, load<EightFloats>(to + j) + mass_of(load<Ushort8>(mass + j)));
      }
    });
    for (size_t t = 0; t < tiles; ++t)
      for (size_t j = 0; j < row_; ++j) sum[j] += partial[t * row_ + j];
  }
  return sum;
}

// Whole masses of the columns [8 begin, 8 end) and their sums, tile by tile.
void AlignedTables::accumulate(const std::vector<AlignedSheet>& stored, size_t begin, size_t end) {
  std::vector<Int8> running(end - begin, Int8{});
  std::array<const uint16_t*, kTile> from{};  // the tile's masses; null behind the last leaf
  size_t sheet = 0, first = 0;                // that the leaf is of, and its first leaf
  for (size_t t = 0; t < tiles_; ++t) {
    for (size_t i = 0; i < kTile; ++i) {
      const size_t n = t * kTile + i;
      if (n < leaves_ && n - first == stored[sheet].leaves.size()) first += stored[sheet++].leaves.size();
      from[i] = n < leaves_ ? stored[sheet].mass.data() + (order_[n] - first) * row_ : nullptr;
    }
    for (size_t j = begin; j < end; ++j) {
      EightFloats scale;
      for (size_t lane = 0; lane < 8; ++lane) {
        scale[lane] = columns_[8 * j + lane].scale;
        tile_sum_[(8 * j + lane) * (tiles_ + 1) + t] = running[j - begin][lane];
      }
      Int8 sum = running[j - begin];
      int32_t* to = &cumulative_[(t * row_ + 8 * j) * kTile];
      for (size_t i = 0; i < kTile; i += 8) {
        Int8 rows[8];
        for (size_t k = 0; k < 8; ++k) {
          rows[k] = sum;  // behind the last leaf: the total
          if (from[i + k]) sum += __builtin_convertvector(mass_of(load<Ushort8>(from[i + k] + 8 * j)) * scale, Int8);
        }
        transpose(rows);
        for (size_t lane = 0; lane < 8; ++lane) store(to + lane * kTile + i, rows[lane]);
      }
      running[j - begin] = sum;
    }
  }
  for (size_t j = 8 * begin; j < 8 * end; ++j)
    tile_sum_[j * (tiles_ + 1) + tiles_] = columns_[j].total = running[j / 8 - begin][j % 8];
}

AlignedTables::Draw AlignedTables::draw(size_t column, double u) const {
  const double at = u * columns_[column].total;
  const int32_t target = static_cast<int32_t>(at);
  // The last tile whose sum does not exceed the target, then the last leaf in it.
  const int32_t* tiles = &tile_sum_[column * (tiles_ + 1)];
  size_t tile = 0, count = tiles_;
  while (count > 64) {
    const size_t half = count / 2;
    tile += tiles[tile + half] <= target ? half : 0;
    count -= half;
  }
  int below = 0;
  for (size_t i = 0; i < count; ++i) below += tiles[tile + i] <= target;
  tile += static_cast<size_t>(below - 1);
  const int32_t* sum = &cumulative_[(tile * row_ + column) * kTile];
  below = 0;
  for (size_t i = 0; i < kTile; ++i) below += sum[i] <= target;
  const size_t leaf = static_cast<size_t>(below - 1);
  const int32_t next = leaf + 1 < kTile ? sum[leaf + 1] : tiles[tile + 1];
  return {order_[tile * kTile + leaf], (at - sum[leaf]) / (next - sum[leaf])};
}

}  // namespace suite::sqt
