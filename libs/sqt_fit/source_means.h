// Means of the values beside means of their logarithms: what keeps narrow lobes in a pyramid of logarithms. Internal to
// libs/sqt_fit; the method is described in aligned.h.
#pragma once
#include "sqt_fit/aligned_source.h"

namespace suite::sqt {

// Fills sheet.mean from the leaves upwards.
void find_means(const AlignedLayout& layout, AlignedSource::Impl::Sheet& sheet);

// log2 of a node's values and of its means, averaged over channels; padded_row(views) of either.
struct NodeLevels {
  explicit NodeLevels(const AlignedLayout& layout);
  void look(const AlignedLayout& layout, const AlignedSource::Impl::Sheet& sheet, size_t node);
  std::vector<float> value, mean;
};

// Whether nodes have to state finer steps: one that holds a hundredth of the light is weighed two octaves too coarsely.
bool needs_finer_steps(const AlignedLayout& layout, const AlignedTotals& totals,
                       const std::vector<AlignedSource::Impl::Sheet>& sheets);

// Log2 values that the nodes of a reduced tree should have, [node][view][channel]: those that stay undivided such that
// the mean of 2^plane over them is that of the data, the others the average of their children.
std::vector<float> reduced_values(const AlignedLayout& layout, const AlignedSource::Impl::Sheet& sheet,
                                  const std::vector<uint8_t>& divided);

}  // namespace suite::sqt
