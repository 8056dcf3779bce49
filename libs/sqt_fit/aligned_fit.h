// Fitting by the aligned method (sqt/aligned.h): asking a function on a pyramid of cells, coding that at a quality.
#pragma once
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "sqt/aligned.h"

namespace suite::sqt {

// The data on a pyramid of cells, asked once; coded many times at different qualities.
class AlignedSource {
 public:
  struct Options {
    std::optional<LobeFrame> frame;  // none: as lobe_detection.h finds it
    size_t views = 0;                // 0: as many as view_error asks for
    double view_error = 0.015;       // interpolation error allowed between views, log2 units
    size_t most_views = 25;          // whatever view_error asks
    size_t azimuths = 0;             // of anisotropic surfaces; 0: as many as view_error asks for
    double fold_error = 1;           // bilateral data are stored once when that costs at most this cosine-weighted l1
    int base_order = 6;              // every cell of this order is asked; less when views x channels are very many
    int max_order = 10;              // further only where it matters
    bool order_fixed = false;        // max_order is what was asked for: never more
    double detail = 2e-6;            // share of the whole a cell's variation must have to be divided further
  };
  AlignedSource(const Function& function, const Options& options, const std::function<void(double)>& progress = {});
  ~AlignedSource();
  const Function::Info& function() const;
  const AlignedLayout& layout() const;  // quality 0
  const AlignedTotals& totals() const;  // log2_scale empty: it depends on what was decoded
  struct Impl;
  const Impl& impl() const { return *impl_; }

 private:
  std::unique_ptr<Impl> impl_;
};

// Codes the trees at a quality (> 0; smaller is better and larger). The payload holds trees only.
// decoded: receives what decode_sheets would return, when not null.
std::vector<std::byte> encode_sheets(const AlignedSource& source, double quality,
                                     std::vector<AlignedSheet>* decoded = nullptr);
// log2 of the scale that gives decoded sheets the totals of the data.
std::vector<float> fit_scale(const AlignedLayout& layout, const Function::Info& function,
                             const std::vector<AlignedSheet>& sheets, const AlignedTotals& totals);

// Codes totals and scale. The numbers are rounded in place to what a decoder sees (relative steps of 1/2000).
std::vector<std::byte> encode_totals(AlignedTotals& totals, size_t channels);
// A whole fit at a quality: trees, totals, scale.
struct AlignedFit {
  AlignedData data;
  std::vector<std::byte> totals_bytes, sheets_bytes;
};
AlignedFit encode_aligned(const AlignedSource& source, double quality);

}  // namespace suite::sqt
