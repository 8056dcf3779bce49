// What the halves of blocks of infrared's paths differ by, in what faces receive.
#include <algorithm>

#include "base/parallel.h"
#include "heat/exchange_paths.h"

namespace suite {

namespace {

// Paths that end at each face but start at others.
struct Arrivals {
  std::vector<size_t> begin;
  std::vector<uint32_t> slot;  // [face][arrival]
  explicit Arrivals(const ExchangePaths& paths) : begin(paths.faces() + 1, 0) {
    const size_t n = paths.faces(), each = size_t{paths.blocks} * paths.paths;
    const auto arrives = [&](size_t k) {
      return paths.ends[k] < n && paths.ends[k] != k / each && paths.weights[k] > 0;
    };
    for (size_t k = 0; k < paths.ends.size(); ++k)
      if (arrives(k)) ++begin[paths.ends[k] + 1];
    for (size_t f = 0; f < n; ++f) begin[f + 1] += begin[f];
    slot.resize(begin[n]);
    std::vector<size_t> next(begin.begin(), begin.end() - 1);
    for (size_t k = 0; k < paths.ends.size(); ++k)
      if (arrives(k)) slot[next[paths.ends[k]]++] = static_cast<uint32_t>(k);
  }
};

class Halves {
 public:
  Halves(const ExchangePaths& paths, std::span<const float> emitted, std::span<const float> received, size_t parts)
      : paths_(paths),
        emitted_(emitted),
        received_(received),
        parts_(parts),
        each_(size_t{paths.blocks} * paths.paths),
        arrivals_(paths),
        whole_(paths.faces()) {
    for (size_t f = 0; f < paths.faces(); ++f)
      for (size_t k = f * each_; k < (f + 1) * each_; ++k) whole_[f] += double{paths.weights[k]};
  }

  // [block][part]
  void of_face(uint32_t f, std::span<float> out) const {
    std::ranges::fill(out, 0.0f);
    const size_t n = paths_.faces();
    const bool both = paths_.always_there(f);
    double sum = 0;
    for (size_t k = f * each_; k < (f + 1) * each_; ++k) {
      if (!(paths_.weights[k] > 0)) continue;
      const uint32_t end = paths_.ends[k];
      const double share = double{paths_.weights[k]} / whole_[f] * (both && end < n && end != f ? trust(f, end) : 1);
      sum += share;
      add(k, f, end, share, out);
    }
    for (size_t i = arrivals_.begin[f]; both && i < arrivals_.begin[f + 1]; ++i) {
      const size_t k = arrivals_.slot[i];
      const auto from = static_cast<uint32_t>(k / each_);
      double share = double{paths_.weights[k]} / whole_[from] * trust(f, from);
      if (!paths_.always_there(from)) share *= double{paths_.presence.front()[from]};
      sum += share;
      add(k, f, from, share, out);
    }
    const float scale = sum > 0 ? static_cast<float>(paths_.blocks / sum) : 0;
    for (float& v : out) v *= scale;
  }

 private:
  // How much of what i exchanges with j its own paths tell, over what it emits.
  double trust(uint32_t i, uint32_t j) const {
    const double a = paths_.area[i] * paths_.emissivity[i], b = paths_.area[j] * paths_.emissivity[j];
    return a + b > 0 ? b / (a + b) : 0;
  }
  // A row of shares that sum to 1: more from one end is less from all. Ends beyond all are closed backs, known from
  // this end alone.
  void add(size_t k, uint32_t f, uint32_t end, double share, std::span<float> out) const {
    const size_t within = k % each_, block = within / paths_.paths;
    const auto by = static_cast<float>(within % paths_.paths < paths_.paths / 2 ? share : -share);
    const size_t ends = emitted_.size() / parts_;
    const float *from = &emitted_[(end < ends ? end : end - ends) * parts_], *mean = &received_[f * parts_];
    float* to = &out[block * parts_];
    for (size_t p = 0; p < parts_; ++p) to[p] += by * (from[p] - mean[p]);
  }

  const ExchangePaths& paths_;
  std::span<const float> emitted_, received_;
  size_t parts_, each_;
  Arrivals arrivals_;
  std::vector<double> whole_;  // weight of a face's paths
};

}  // namespace

void ExchangePaths::halves(std::span<const float> emitted, std::span<const float> received, size_t parts,
                           const std::function<void(size_t, std::span<const float>)>& put) const {
  SUITE_CHECK_EQ(received.size(), faces() * parts);
  const Halves of(*this, emitted, received, parts);
  parallel_for(0, faces(), 64, [&](size_t begin, size_t end) {
    std::vector<float> out(blocks * parts);
    for (size_t f = begin; f < end; ++f) of.of_face(static_cast<uint32_t>(f), out), put(f, out);
  });
}

}  // namespace suite
