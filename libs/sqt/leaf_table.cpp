#include "sqt/leaf_table.h"

#include <algorithm>
#include <cmath>

#include "base/memory.h"
#include "sqt/cell_centers.h"

namespace suite::sqt {

namespace {

// Leaves are divided at least to this order.
constexpr int kSampleOrder = 4;
// Cells up to this order are weighed by the middles of their quarters, smaller ones by their own: with 4, weights of
// samples near the horizon grew to ten.
constexpr int kQuarteredOrder = 5;
// A cell within reach of the horizon keeps this much of its mass when cut away, so that neighbouring views can draw it.
constexpr float kHorizonFloor = 1e-3f;
// Logarithms of masses: nine bits behind the point; codes are larger by kBias. A weight of nothing.
constexpr int kBits = 9, kBias = 31744, kLeastWeight = -15360, kNothing = kLeastWeight - 1;
constexpr size_t kSlack = 4 * 16;  // numbers written behind the last row

// 2^f - 1 - f and its inverse on [0, 1), in units of 2^-9: 0.344 f (1 - f).
Ushort16 bend(Ushort16 f) { return (((f * (511 - f)) >> 8) * 88) >> 9; }

// Code of a mass: its plane's value, how much the slopes raise the mean of 2^plane, and the weight. Each of x and y
// adds log2 of sinh(a) / a with a = slope ln 2 / 2, close to 0.026 slope^2 up to the eight octaves that count.
Ushort16 code_of(Short16 value, Short16 x, Short16 y, Short16 weight, int fraction_bits) {
  auto raise = [&](Short16 slope) {
    const Short16 s = slope >> static_cast<int16_t>(fraction_bits - 5), a = s < 0 ? -s : s;
    const Ushort16 size = reinterpret_cast<Ushort16>(a > 255 ? Short16{} + 255 : a);
    return (((size * size) >> 8) * 213) >> 6;
  };
  const Ushort16 log = reinterpret_cast<Ushort16>((value >> static_cast<int16_t>(fraction_bits - kBits)) + weight) +
                       raise(x) + raise(y) + kBias;
  const Ushort16 code = log - bend(log & 511);
  return weight == kNothing ? Ushort16{} : code;
}

// Four rows to columns of four: sixteen of them.
void interleave(Short16 a, Short16 b, Short16 c, Short16 d, int16_t* to) {
  const Short16 low{0, 16, 1, 17, 2, 18, 3, 19, 8, 24, 9, 25, 10, 26, 11, 27},
      high{4, 20, 5, 21, 6, 22, 7, 23, 12, 28, 13, 29, 14, 30, 15, 31};
  const Int8 ab_low = reinterpret_cast<Int8>(__builtin_shuffle(a, b, low)),
             ab_high = reinterpret_cast<Int8>(__builtin_shuffle(a, b, high)),
             cd_low = reinterpret_cast<Int8>(__builtin_shuffle(c, d, low)),
             cd_high = reinterpret_cast<Int8>(__builtin_shuffle(c, d, high));
  const Int8 even{0, 8, 1, 9, 4, 12, 5, 13}, odd{2, 10, 3, 11, 6, 14, 7, 15};
  const Int8 e = __builtin_shuffle(ab_low, cd_low, even), f = __builtin_shuffle(ab_low, cd_low, odd),
             g = __builtin_shuffle(ab_high, cd_high, even), h = __builtin_shuffle(ab_high, cd_high, odd);
  const Int8 front{0, 1, 2, 3, 8, 9, 10, 11}, back{4, 5, 6, 7, 12, 13, 14, 15};
  store(to, __builtin_shuffle(e, f, front)), store(to + 16, __builtin_shuffle(g, h, front));
  store(to + 32, __builtin_shuffle(e, f, back)), store(to + 48, __builtin_shuffle(g, h, back));
}

// Middles of a cell's quarters.
std::array<Center, 4> quarters(CellXY at, int order) {
  CellLanes lanes;
  for (uint32_t k = 0; k < 4; ++k) lanes.set(k, {at.face, 2 * at.x + (k & 1), 2 * at.y + (k >> 1)});
  EightFloats x, y, z;
  centers_of(lanes, order + 1, x, y, z);
  std::array<Center, 4> d;
  for (size_t k = 0; k < 4; ++k) d[k] = {x[k], y[k], z[k]};
  return d;
}

}  // namespace

LeafTable::LeafTable(const AlignedLayout& layout, LogScale scale, AlignedSheet& sheet, size_t expected)
    : layout_(layout),
      scale_(scale),
      sheet_(sheet),
      region_{layout.upper_only, layout.half_stored},
      width_(layout.width()),
      row_(padded_row(width_)),
      lanes_(layout),
      part_(3 * row_ + 16) {
  sheet_.scale = scale;
  for (int order = 0; order <= kMaxOrder; ++order) {
    const double area = cell_solid_angle(order);
    // As far below the horizon as a point may be while a part of its leaf is above: the cosine changes by at most twice
    // the angle, and a leaf reaches about 0.8 of its width from its middle.
    numbers_.push_back(
        {static_cast<float>(area), static_cast<float>(1 / area), static_cast<float>(2 * std::sqrt(area))});
  }
  size_t coarse = 0;  // parts that coarse leaves may have
  for (uint32_t i = 0; i < cell_count(kSampleOrder); ++i) coarse += region_.holds(CellId::of(kSampleOrder, i));
  sheet_.leaves.reserve(expected + coarse);
  sheet_.inverse_area.reserve(expected + coarse);
  sheet_.plane.reserve((expected + coarse) * width_ * AlignedSheet::kStride + kSlack);
  sheet_.mass.reserve((expected + coarse) * row_);
  // Looked up at random: with small pages most look-ups miss the processor's table of them, too.
  expect_large(sheet_.plane.data(), sheet_.plane.capacity() * sizeof(int16_t));
}

void LeafTable::add(CellXY at, int order, const Center& center, const int16_t* value, const int16_t* slope_x,
                    const int16_t* slope_y) {
  ++sheet_.stored;
  if (order >= kSampleOrder) return add_whole(at, order, center, value, slope_x, slope_y);
  const int extra = kSampleOrder - order, side = 1 << extra;
  for (int v = 0; v < side; ++v)
    for (int u = 0; u < side; ++u) {
      const CellXY part{at.face, (at.x << extra) + static_cast<uint32_t>(u),
                        (at.y << extra) + static_cast<uint32_t>(v)};
      if (!region_.holds(part, kSampleOrder)) continue;  // across the symmetry plane or below the horizon
      const int x = 2 * u + 1 - side, y = 2 * v + 1 - side;
      for (size_t j = 0; j < row_; ++j) {
        const int n = value[j] + ((x * slope_x[j] + y * slope_y[j]) >> (extra + 1));
        part_[j] = static_cast<int16_t>(std::clamp(n, -LogScale::kMost, LogScale::kMost));
        part_[row_ + j] = static_cast<int16_t>(slope_x[j] >> extra);
        part_[2 * row_ + j] = static_cast<int16_t>(slope_y[j] >> extra);
      }
      CellLanes lanes;
      lanes.set(0, part);
      EightFloats px, py, pz;
      centers_of(lanes, kSampleOrder, px, py, pz);
      add_whole(part, kSampleOrder, {px[0], py[0], pz[0]}, part_.data(), &part_[row_], &part_[2 * row_]);
    }
}

void LeafTable::add_whole(CellXY at, int order, const Center& center, const int16_t* value, const int16_t* slope_x,
                          const int16_t* slope_y) {
  const size_t views = layout_.views(), n = sheet_.leaves.size();
  const bool twice = layout_.half_stored && !on_mirror(at);
  const OrderNumbers& numbers = numbers_[static_cast<size_t>(order)];
  sheet_.leaves.push_back(cell_at(order, at));
  sheet_.inverse_area.push_back(twice ? 0.5f * numbers.inverse_area : numbers.inverse_area);
  sheet_.plane.resize((n + 1) * width_ * AlignedSheet::kStride + kSlack);
  sheet_.mass.resize((n + 1) * row_ + 16);
  std::array<Center, 4> points{center};
  if (order <= kQuarteredOrder) points = quarters(at, order);
  // Sixteen views at a time, the last first: what goes beyond a channel is written over by the next, or by its earlier
  // views.
  for (size_t v = padded_row(views); v > 0;) {
    v -= 16;
    const Short16 weight =
        __builtin_shufflevector(weights(v, points, numbers, twice), weights(v + 8, points, numbers, twice), 0, 1, 2, 3,
                                4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
    for (size_t j = v; j < width_; j += views) {
      const Short16 mid = load<Short16>(value + j), x = load<Short16>(slope_x + j), y = load<Short16>(slope_y + j);
      const Ushort16 code = code_of(mid, x, y, weight, scale_.fraction_bits);
      store(&sheet_.mass[n * row_ + j], code);
      interleave(mid, x, y, reinterpret_cast<Short16>(code), &sheet_.plane[(n * width_ + j) * AlignedSheet::kStride]);
    }
  }
}

// Logarithms of the integrals of |cos| stretch (or 1) over a leaf for eight views, kept above a floor near the horizon.
// By its middle, or by the middles of its quarters.
inline Short8 LeafTable::weights(size_t first, const std::array<Center, 4>& points, const OrderNumbers& n,
                                 bool twice) const {
  EightFloats weight{};
  const bool single = &n > &numbers_[kQuarteredOrder];
  for (size_t k = 0; k < (single ? 1 : 4); ++k) {
    EightFloats stretch, cosine;
    lanes_.at(first, points[k], stretch, cosine);
    const EightFloats seen = layout_.upper_only ? cosine : cosine < 0 ? -cosine : cosine;
    EightFloats share = (single ? n.area : 0.25f * n.area) * stretch;
    if (layout_.cosine_weighted) share *= seen > kHorizonFloor ? seen : EightFloats{} + kHorizonFloor;
    if (layout_.upper_only) share = cosine < -n.reach ? EightFloats{} : share;
    weight += share;
  }
  Int8 log = (reinterpret_cast<Int8>(weight) >> (23 - kBits)) - ((127 - (twice ? 1 : 0)) << kBits);
  const Int8 f = log & 511;
  log += (((f * (511 - f)) >> 8) * 88) >> 9;  // as bend
  log = log < kLeastWeight ? Int8{} + kLeastWeight : log;
  return __builtin_convertvector(weight > 0 ? log : Int8{} + kNothing, Short8);
}

}  // namespace suite::sqt
