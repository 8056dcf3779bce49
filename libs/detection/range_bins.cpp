#include "detection/range_bins.h"

#include <algorithm>
#include <cmath>

namespace suite {

RangeBins::RangeBins(const ResponseHead& head, double start, int scrambles)
    : head_(head), start_(start), scrambles_(scrambles) {
  SUITE_CHECK_LE(2, scrambles);
}

void RangeBins::add(uint32_t bin, int scramble, double photons, bool multiple, size_t tag,
                    std::span<const Part> parts) {
  SUITE_CHECK(scramble >= 0 && scramble < scrambles_ && tag < head_.channels.size() && tag != kMultiple);
  const size_t channels = head_.channels.size();
  Cell& cell = cells_[bin];
  if (cell.sums.empty()) cell.sums.assign(static_cast<size_t>(scrambles_) * channels, 0);
  ++cell.contributions;
  double* sums = cell.sums.data() + static_cast<size_t>(scramble) * channels;
  sums[multiple ? kMultiple : kSingle] += photons;
  if (tag) sums[tag] += photons;
  for (const Part& part : parts) sums[part.channel] += photons * part.share;
}

void RangeBins::deposit(int scramble, double arrival, double photons, bool multiple, size_t tag,
                        std::span<const Part> parts) {
  const double bins = static_cast<double>(head_.bins), x = (arrival - start_) / head_.bin;
  if (!(x >= 0 && x < bins)) {
    outside_ += photons / scrambles_;
    return;
  }
  // Its largest value is that of one path within the mean of the scrambles.
  largest_ = std::max(largest_, photons / scrambles_);
  const double from_first = std::clamp(x - 0.5, 0.0, bins - 1);
  const auto below = static_cast<uint32_t>(from_first);
  const double share = from_first - below;
  if (share < 1) add(below + 1, scramble, photons * (1 - share), multiple, tag, parts);
  if (share > 0) add(below + 2, scramble, photons * share, multiple, tag, parts);
}

void RangeBins::passive(int scramble, double photons, bool multiple, size_t tag, std::span<const Part> parts) {
  add(0, scramble, photons, multiple, tag, parts);
}

void RangeBins::end_row(ResponseBlock& block) {
  const double n = scrambles_;
  std::vector<double> each(static_cast<size_t>(scrambles_));
  for (const auto& [bin, cell] : cells_) {
    block.bin.push_back(bin);
    block.contributions.push_back(cell.contributions);
    for (size_t c = 0; c < head_.channels.size(); ++c) {
      double sum = 0, squares = 0;
      for (size_t s = 0; s < each.size(); ++s) sum += each[s] = cell.sums[s * head_.channels.size() + c];
      const double mean = sum / n;
      for (const double value : each) squares += (value - mean) * (value - mean);
      block.value.push_back(mean);
      block.variance.push_back(squares / (n * (n - 1)));
      block.skewness.push_back(static_cast<float>(skewness_of(each)));
    }
  }
  block.begin.push_back(block.bin.size());
  block.bound.push_back(largest_ > 0 ? 3 * largest_ : std::numeric_limits<double>::quiet_NaN());
  block.paths.push_back(paths_);
  cells_.clear();
  paths_ = 0, outside_ = 0, largest_ = 0;
}

}  // namespace suite
