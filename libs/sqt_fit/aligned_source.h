// The data on a pyramid: what the encoder of the aligned method works from. Internal to libs/sqt_fit.
#pragma once
#include <mutex>

#include "sqt/step_rule.h"
#include "sqt_fit/aligned_fit.h"
#include "sqt_fit/lattice.h"

namespace suite::sqt {

struct AlignedSource::Impl {
  Function::Info function;
  AlignedLayout layout;
  AlignedTotals totals;
  struct Sheet {
    Lattice data;                // log2 averages; nodes in the order of Lattice
    std::vector<uint8_t> valid;  // [node][view]
    // Of divided nodes, in units of log2: transformed differences from the plane of the data itself, [3][width].
    std::vector<int32_t> detail_index;  // [node] -> row of details, -1 for leaves
    std::vector<float> details;
    std::vector<float> mean;  // [node][view][channel] of f itself over the cell, 1/sr
  };
  std::vector<Sheet> sheets;
  LogScale scale;  // that holds the averages
};

// Fills sheet.details with the differences of every divided node from the plane of the data, [3][view][channel].
void find_details(const AlignedLayout& layout, AlignedSource::Impl::Sheet& sheet);
// Transforms them over views and channels.
void transform_details(const AlignedLayout& layout, AlignedSource::Impl::Sheet& sheet);
// Differences [3][view][channel] of a family of the data from predictions of the four children, [4][view][channel].
// values: [node][view][channel], of the data or what a reduced tree should have.
void family_details(const AlignedLayout& layout, const AlignedSource::Impl::Sheet& sheet, size_t source,
                    std::span<const float> values, std::span<const float> predicted, std::span<float> details);
// Rows [view][channel]: views that are not known take the values of the nearest known view of the same azimuth.
void fill_unknown(const AlignedLayout& layout, std::span<const int> known, std::span<float> rows, size_t count);

}  // namespace suite::sqt
