// The transform of a node's differences over views and channels, of the aligned method. Internal to libs/sqt and
// libs/sqt_fit.
#pragma once
#include <span>
#include <vector>

#include "sqt/aligned.h"

namespace suite::sqt {

// Orthonormal cosine transform over channels and view angles, Fourier over view azimuths.
class BlockTransform {
 public:
  explicit BlockTransform(const AlignedLayout& layout);
  // values [view][channel] -> coefficients [channel frequency][view frequency]; layout.width() of either.
  void forward(std::span<const float> values, std::span<float> coefficients) const;
  // What levels [channel frequency][view frequency] times `step` stand for, rounded: [channel][view]. counts: how many
  // levels of each channel frequency count, those behind are 0. False when there are none; then nothing is written.
  bool inverse(const int32_t* levels, const uint16_t* counts, float step, int16_t* values) const;
  // "How high" a view frequency is, for contexts: polar plus azimuthal wave number.
  int height(size_t view_frequency) const { return height_[view_frequency]; }

 private:
  size_t views_, channels_, stride_;
  std::vector<float> view_;     // [frequency][stride]
  std::vector<float> channel_;  // [frequency][channel]
  std::vector<int> height_;
  mutable std::vector<float> mixed_;  // room for inverse, which one thread at a time calls
};

}  // namespace suite::sqt
