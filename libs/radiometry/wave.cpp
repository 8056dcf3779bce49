#include "radiometry/wave.h"

#include <algorithm>
#include <new>

namespace suite {

Wave::Wave(size_t width, int max_nodes, size_t bins, bool media, bool missed)
    : bins_(bins),
      stride_((bins + 7) / 8 * 8),
      max_nodes_(max_nodes),
      paths_(width),
      nodes_(width * static_cast<size_t>(max_nodes)) {
  const size_t floats = (2 * width * static_cast<size_t>(max_nodes) + 3) * stride_;
  spectra_.reset(static_cast<float*>(std::aligned_alloc(64, (floats * sizeof(float) + 63) / 64 * 64)));
  if (!spectra_) throw std::bad_alloc();
  std::fill_n(spectra_.get(), floats, 0.0f);
  if (media) segments_.resize(2 * width * static_cast<size_t>(max_nodes + 1) * stride_);
  if (missed) missed_.resize(width * static_cast<size_t>(max_nodes) * stride_);
  if (missed && media) missed_on_way_.resize(width * static_cast<size_t>(max_nodes + 1) * stride_);
  rays.reserve(2 * width);
  hits.reserve(width);
  distance.reserve(2 * width);
  blocked.reserve(2 * width);
  owner.reserve(2 * width);
  light.reserve(2 * width);
  active.reserve(width);
}

}  // namespace suite
