// The paper's own construction of a spherical quad-tree and the bundle made of such trees.
//
// One tree per view direction and channel: samples are inserted at full order, averaged, empty cells aggregated into
// their parents, families of similar values consolidated. Values are constant over a leaf. Between view directions the
// shapes are blended linearly in the fixed frame of the surface; the shape is scaled to the total that the data had
// before reduction.
//
// Based on: Goodenough & Brown, section IV-D-4 (construction) and V-A (totals before reduction, magnitudes).
#pragma once
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "sqt/bundle.h"
#include "sqt/tree.h"

namespace suite::sqt {

// Scattered values over directions -> leaves. Not thread-safe.
class Builder {
 public:
  // order: of the full partition, 0..8. domain hemisphere: only cells that reach above the horizon exist.
  Builder(int order, Domain domain);
  // Insert a value (NaN and infinity are refused and counted; negative values are kept for averaging).
  void insert(Dir in, double value);
  size_t rejected() const { return rejected_; }
  struct Leaf {
    CellId id;
    float value;  // >= 0: negative averages become 0 and are counted
  };
  // Averages cells with several values and aggregates empty cells into their parents until every leaf has a value, then
  // consolidates families of four leaves whose values differ by at most `threshold` times the mean value of the slice
  // ("until the overall impact necessitates angular variation"; the paper gives no number). threshold < 0
  // keeps the full partition. No value at all gives one zero leaf per face.
  std::vector<Leaf> reduce(double threshold) const;
  size_t negative_leaves() const { return negative_; }

 private:
  int order_;
  Domain domain_;
  size_t rejected_ = 0;
  mutable size_t negative_ = 0;
  std::vector<double> sum_;
  std::vector<uint32_t> count_;
};

struct PaperData {
  Function::Info function;
  std::vector<Bundle::View> views;  // isotropic: phi = 0, theta ascending; else theta-major over phi_count
  size_t phi_count = 1;             // view azimuths per polar angle, uniform from 0
  std::vector<std::vector<Builder::Leaf>> slices;  // [view][channel] flattened; values are f, 1/sr
  std::vector<double> magnitude_um;                // ascending
  std::vector<float> magnitudes;                   // [view][magnitude] totals W before reduction
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

// Checks every invariant (sizes, ranges, disjoint leaves). Error naming the fault when the data are inconsistent.
std::shared_ptr<const Bundle> make_bundle(PaperData data);

}  // namespace suite::sqt
