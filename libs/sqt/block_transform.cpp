#include "sqt/block_transform.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "sqt/portable_math.h"

namespace suite::sqt {

namespace {

// Orthonormal DCT-II matrix, [frequency][index].
std::vector<double> cosine_matrix(size_t n) {
  std::vector<double> m(n * n);
  for (size_t k = 0; k < n; ++k)
    for (size_t i = 0; i < n; ++i)
      m[k * n + i] = std::sqrt((k ? 2.0 : 1.0) / static_cast<double>(n)) *
                     portable_cos_pi(static_cast<long long>(k * (2 * i + 1)), static_cast<long long>(2 * n));
  return m;
}

// Orthonormal real Fourier matrix for a periodic index: 1, cos 1, sin 1, cos 2, ...
std::vector<double> fourier_matrix(size_t n) {
  std::vector<double> m(n * n);
  for (size_t k = 0; k < n; ++k) {
    const long long wave = static_cast<long long>((k + 1) / 2), count = static_cast<long long>(n);
    const bool plain = k == 0 || (n % 2 == 0 && k == n - 1);
    for (size_t i = 0; i < n; ++i) {
      const long long turn = 4 * wave * static_cast<long long>(i);  // of 2 pi / (4 n) each
      const double value =
          (plain || k % 2) ? portable_cos_pi(turn, 2 * count) : portable_cos_pi(turn - count, 2 * count);
      m[k * n + i] = value * std::sqrt((plain ? 1.0 : 2.0) / static_cast<double>(n));
    }
  }
  return m;
}

}  // namespace

BlockTransform::BlockTransform(const AlignedLayout& layout)
    : views_(layout.views()), channels_(layout.channels), stride_((views_ + 31) / 32 * 32) {
  const size_t nt = layout.theta.size(), np = layout.phi_count;
  const std::vector<double> t = cosine_matrix(nt), p = fourier_matrix(np);
  if (layout.spectra.empty()) {
    const std::vector<double> c = cosine_matrix(channels_);
    channel_.assign(c.begin(), c.end());
  } else {
    channel_.resize(channels_ * channels_, 0.0f);
    for (size_t j = 0; j < layout.spectra.size(); ++j)
      channel_[j] = static_cast<float>(layout.spectra[j]) / AlignedLayout::kSpectrumUnit;
  }
  // View frequencies in the order of their height.
  std::vector<std::pair<int, size_t>> order;
  for (size_t k = 0; k < views_; ++k) order.push_back({static_cast<int>(k / np + (k % np + 1) / 2), k});
  std::stable_sort(order.begin(), order.end(), [](auto& a, auto& b) { return a.first < b.first; });
  view_.resize(views_ * stride_, 0.0f);
  for (size_t n = 0; n < views_; ++n) {
    const auto [height, k] = order[n];
    height_.push_back(height);
    for (size_t i = 0; i < nt; ++i)
      for (size_t j = 0; j < np; ++j)
        view_[n * stride_ + i * np + j] = static_cast<float>(t[(k / np) * nt + i] * p[(k % np) * np + j]);
  }
  mixed_.resize(channels_ * stride_);
}

void BlockTransform::forward(std::span<const float> values, std::span<float> out) const {
  std::vector<float> mixed(views_ * channels_);  // [channel frequency][view]
  for (size_t c = 0; c < channels_; ++c)
    for (size_t v = 0; v < views_; ++v) {
      float sum = 0;
      for (size_t i = 0; i < channels_; ++i) sum += channel_[c * channels_ + i] * values[v * channels_ + i];
      mixed[c * views_ + v] = sum;
    }
  for (size_t c = 0; c < channels_; ++c)
    for (size_t k = 0; k < views_; ++k) {
      float sum = 0;
      for (size_t v = 0; v < views_; ++v) sum += view_[k * stride_ + v] * mixed[c * views_ + v];
      out[c * views_ + k] = sum;
    }
}

bool BlockTransform::inverse(const int32_t* levels, const uint16_t* counts, float step, int16_t* values) const {
  size_t channels = channels_;
  while (channels > 0 && counts[channels - 1] == 0) --channels;
  if (!channels) return false;
  for (size_t c = 0; c < channels; ++c) {
    float* to = &mixed_[c * stride_];
    for (size_t v = 0; v < stride_; v += 32) {
      EightFloats sum[4] = {};
      for (size_t k = 0; k < counts[c]; ++k) {
        const float a = static_cast<float>(levels[c * views_ + k]) * step;
        const float* basis = &view_[k * stride_ + v];
        for (size_t part = 0; part < 4; ++part) sum[part] += a * load<EightFloats>(basis + 8 * part);
      }
      for (size_t part = 0; part < 4; ++part) store(to + v + 8 * part, sum[part]);
    }
  }
  // Adding 1.5 * 2^23 leaves the nearest whole number in the low bits.
  constexpr float kRound = 12582912.0f;
  for (size_t i = 0; i < channels_; ++i)
    for (size_t v = 0; v < views_; v += 8) {
      EightFloats sum = channel_[i] * load<EightFloats>(&mixed_[v]);
      for (size_t c = 1; c < channels; ++c)
        sum += channel_[c * channels_ + i] * load<EightFloats>(&mixed_[c * stride_ + v]);
      const EightFloats most = EightFloats{} + static_cast<float>(LogScale::kMost), least = -most;
      sum = sum > most ? most : sum;
      sum = sum < least ? least : sum;
      const Short8 whole =
          __builtin_convertvector(reinterpret_cast<Int8>(sum + kRound) - std::bit_cast<int32_t>(kRound), Short8);
      // The next channel, or the room behind the row, takes what goes beyond.
      store(values + i * views_ + v, whole);
    }
  return true;
}

}  // namespace suite::sqt
