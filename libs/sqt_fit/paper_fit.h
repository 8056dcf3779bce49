// The paper's own construction of a spherical quad-tree; see sqt/paper.h.
#pragma once
#include <functional>
#include <vector>

#include "sqt/paper.h"

namespace suite::sqt {

// Scattered values over directions -> leaves. Not thread-safe.
class Builder {
 public:
  // order: of the full partition, 0..8. domain hemisphere: only cells that reach above the horizon exist.
  Builder(int order, Domain domain);
  // Insert a value (NaN and infinity are refused and counted; negative values are kept for averaging).
  void insert(Dir in, double value);
  size_t rejected() const { return rejected_; }
  // Averages cells with several values and aggregates empty cells into their parents until every leaf has a value, then
  // consolidates families of four leaves whose values differ by at most `threshold` times the mean value of the slice
  // ("until the overall impact necessitates angular variation"; the paper gives no number). threshold < 0
  // keeps the full partition. No value at all gives one zero leaf per face.
  std::vector<PaperLeaf> reduce(double threshold) const;
  size_t negative_leaves() const { return negative_; }

 private:
  int order_;
  Domain domain_;
  size_t rejected_ = 0;
  mutable size_t negative_ = 0;
  std::vector<double> sum_;
  std::vector<uint32_t> count_;
};

struct PaperOptions {
  int order = 6;
  size_t views = 24;
  double threshold = 0.1;
  int samples_per_cell_side = 4;  // the data are asked on a regular subdivision of every cell of the full partition
};
// Asks the function densely in every slice. progress(fraction of the whole just done) may be null.
PaperData fit_paper(const Function& function, const PaperOptions& options,
                    const std::function<void(double)>& progress = {});

}  // namespace suite::sqt
