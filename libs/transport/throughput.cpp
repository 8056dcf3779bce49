#include "transport/throughput.h"

#include <algorithm>
#include <new>

namespace suite {

namespace {

constexpr size_t kVector = 8;

// y *= scale a.
void turn_by(float* __restrict y, float scale, const float* __restrict a, size_t n) {
  if (a)
    for (size_t k = 0; k < n; ++k) y[k] *= scale * a[k];
  else if (scale != 1)
    for (size_t k = 0; k < n; ++k) y[k] *= scale;
}

// L += scale a b T.
void add(float* __restrict L, float scale, const float* __restrict a, const float* __restrict b,
         const float* __restrict T, size_t n) {
  if (a && b)
    for (size_t k = 0; k < n; ++k) L[k] += scale * a[k] * b[k] * T[k];
  else if (const float* __restrict one = a ? a : b)
    for (size_t k = 0; k < n; ++k) L[k] += scale * one[k] * T[k];
  else
    for (size_t k = 0; k < n; ++k) L[k] += scale * T[k];
}

}  // namespace

SpectralThroughputs::Spectra SpectralThroughputs::spectra(size_t floats) {
  Spectra made(static_cast<float*>(std::aligned_alloc(64, (floats * sizeof(float) + 63) / 64 * 64)));
  if (!made) throw std::bad_alloc();
  return made;
}

SpectralThroughputs::SpectralThroughputs(size_t width, size_t bins, size_t targets)
    : bins_(bins),
      stride_(bins == 1 ? 1 : (bins + kVector - 1) / kVector * kVector),
      targets_(targets),
      chains_(width),
      steps_(width * kSteps),
      dense_(spectra(width * kDense * stride_)),
      throughput_(spectra(width * stride_)),
      light_(spectra(width * targets * stride_)) {}

void SpectralThroughputs::fold(uint32_t p) {
  Chain& c = chains_[p];
  float* const T = &throughput_[size_t{p} * stride_];
  float* const L = &light_[size_t{p} * targets_ * stride_];
  if (!c.folded) {
    std::fill_n(T, bins_, 1.0f);
    std::fill_n(L, targets_ * stride_, 0.0f);
    c.folded = true;
  }
  for (uint32_t i = 0; i < c.steps; ++i) {
    const Step& s = step(p, i);
    if (s.target == kTurn) {
      turn_by(T, s.scale, s.a, bins_);
      continue;
    }
    add(L + s.target * stride_, s.scale, s.a, s.b, T, bins_);
    if (s.second != kNone) add(L + s.second * stride_, s.scale, s.a, s.b, T, bins_);
  }
  c.steps = 0;
}

}  // namespace suite
