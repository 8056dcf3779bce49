// What the runtime of the aligned method looks up: leaves with their planes and probabilities, cumulative masses to
// draw from. Built once from decoded trees. Internal to libs/sqt; the method is described in aligned.h.
//
// Leaf, view and channel share four numbers (value, two slopes, probability), so that eval and pdf touch the same
// lines of cache. Probabilities are differences of the cumulative masses, which are integers: pdf is what sample does.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "sqt/aligned.h"
#include "sqt/tree.h"

namespace suite::sqt {

class AlignedTables {
 public:
  struct Sheet {
    Tree tree;
    std::vector<float> plane;         // [leaf][view][channel]{value, slope x, slope y, probability}
    std::vector<float> inverse_area;  // 1/sr of one leaf, its mirror image counted in
    size_t first = 0;                 // index of the first leaf among all sheets
  };
  AlignedTables() = default;
  AlignedTables(const AlignedLayout& layout, std::vector<AlignedSheet> sheets);

  const std::vector<Sheet>& sheets() const { return sheets_; }
  size_t leaves() const { return leaves_; }

  // Drawing a leaf of a column (view x channels + channel).
  struct Draw {
    size_t leaf;    // among all sheets
    double within;  // where in the leaf's share `target` fell, [0, 1)
  };
  bool empty(size_t column) const { return empty_[column]; }
  Draw draw(size_t column, double u) const {  // u in [0, 1); the column is not empty
    const uint32_t* sum = &cumulative_[column * leaves_];
    const uint32_t* guide = &guide_[column * (kGuide + 1)];
    const uint32_t target = static_cast<uint32_t>(u * 0x1p32);
    size_t low = guide[target >> kGuideShift], count = guide[(target >> kGuideShift) + 1] + 1 - low;
    while (count > 1) {  // the last leaf whose sum does not exceed the target
      const size_t half = count / 2;
      low += sum[low + half] <= target ? half : 0;
      count -= half;
    }
    const double mass = (low + 1 < leaves_ ? static_cast<double>(sum[low + 1]) : 0x1p32) - sum[low];
    return {low, (u * 0x1p32 - sum[low]) / mass};
  }

 private:
  static constexpr int kGuideShift = 23;
  static constexpr size_t kGuide = size_t{1} << (32 - kGuideShift);
  void weigh(const AlignedLayout& layout, std::vector<double>& sum);
  void accumulate(size_t width, std::span<const double> sum);
  std::vector<Sheet> sheets_;
  size_t leaves_ = 0;
  std::vector<uint32_t> cumulative_;  // [column][leaf]: mass of the leaves before, in units of 2^-32
  std::vector<uint32_t> guide_;       // [column]: the leaf in which each 1/512 begins
  std::vector<uint8_t> empty_;        // [column]: nothing scatters
};

}  // namespace suite::sqt
