// Leaves of a sheet as they come out of the walk: their planes, and how likely they are drawn. Internal to libs/sqt.
//
// Leaves coarser than order 4 are divided, the planes go on, so that cosine and stretch vary little within one. Masses
// (integral of 2^plane |cos| stretch over a leaf, by its middle) are kept as 16-bit logarithms whose bits are those of
// a floating-point number with nine bits behind the point; draws are exact whatever they are (aligned_tables.h).
#pragma once
#include <bit>

#include "sqt/aligned.h"
#include "sqt/region.h"
#include "sqt/view_lanes.h"

namespace suite::sqt {

class LeafTable {
 public:
  // sheet: filled by add. expected: number of leaves to make room for.
  LeafTable(const AlignedLayout& layout, LogScale scale, AlignedSheet& sheet, size_t expected);
  // A leaf and its middle; rows [channel][view] of values and slopes, filled up as CodedLattice does.
  void add(CellXY at, int order, const Center& center, const int16_t* value, const int16_t* slope_x,
           const int16_t* slope_y);

 private:
  struct OrderNumbers {
    float area, inverse_area, reach;
  };
  void add_whole(CellXY at, int order, const Center& center, const int16_t* value, const int16_t* slope_x,
                 const int16_t* slope_y);
  Short8 weights(size_t first, const std::array<Center, 4>& points, const OrderNumbers& n, bool twice) const;
  const AlignedLayout& layout_;
  LogScale scale_;
  AlignedSheet& sheet_;
  Region region_;
  size_t width_, row_;
  ViewLanes lanes_;
  std::vector<OrderNumbers> numbers_;  // [order]
  std::vector<int16_t> part_;          // room: a part's value and slopes
};

// What a mass's code stands for; 0 for code 0. Between 2^-51 and 2^51.
inline EightFloats mass_of(Ushort8 code) {
  const Uint8 wide = __builtin_convertvector(code, Uint8);
  return reinterpret_cast<EightFloats>(wide == 0 ? Uint8{} : (wide << 14) + (76u << 23));
}
inline float mass_of(uint16_t code) {
  return code == 0 ? 0.0f : std::bit_cast<float>((uint32_t{code} << 14) + (76u << 23));
}

}  // namespace suite::sqt
