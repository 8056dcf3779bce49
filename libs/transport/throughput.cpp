#include "transport/throughput.h"

#include <algorithm>
#include <new>
#include <utility>

namespace suite {

namespace {

constexpr size_t kVector = 8;

// Calls work with what gives the values of a spectrum, or with ones where there is none.
template <class Work>
void with(const float* spectrum, const Work& work) {
  if (spectrum)
    work([spectrum](size_t k) { return spectrum[k]; });
  else
    work([](size_t) { return 1.0f; });
}

// T <- scale a T; ones: T is not yet anything, and counts as ones.
void turn_by(float* __restrict T, bool ones, float scale, const float* __restrict spectrum, size_t n) {
  if (!ones && !spectrum && scale == 1) return;
  with(spectrum, [=](auto a) {
    if (ones)
      for (size_t k = 0; k < n; ++k) T[k] = scale * a(k);
    else
      for (size_t k = 0; k < n; ++k) T[k] *= scale * a(k);
  });
}

// L <- L + scale a b T; none: L is not yet anything, and counts as 0. T: null = ones.
void add(float* __restrict L, bool none, float scale, const float* a, const float* b, const float* T, size_t n) {
  with(a, [=](auto A) {
    with(b, [=](auto B) {
      with(T, [=](auto t) {
        if (none)
          for (size_t k = 0; k < n; ++k) L[k] = scale * A(k) * B(k) * t(k);
        else
          for (size_t k = 0; k < n; ++k) L[k] += scale * A(k) * B(k) * t(k);
      });
    });
  });
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

// What is not yet anything is written by the first step that makes it something.
void SpectralThroughputs::fold(uint32_t p) {
  Chain& c = chains_[p];
  float* const T = &throughput_[size_t{p} * stride_];
  float* const L = &light_[size_t{p} * targets_ * stride_];
  bool ones = !c.folded, none = !c.folded && targets_ == 1;
  if (!c.folded && !none) std::fill_n(L, targets_ * stride_, 0.0f);
  for (const Step *s = &step(p, 0), *const end = s + c.steps; s != end; ++s) {
    if (s->target == kTurn) {
      turn_by(T, std::exchange(ones, false), s->scale, s->a, bins_);
      continue;
    }
    add(L + s->target * stride_, std::exchange(none, false), s->scale, s->a, s->b, ones ? nullptr : T, bins_);
    if (s->second != kNone) add(L + s->second * stride_, false, s->scale, s->a, s->b, ones ? nullptr : T, bins_);
  }
  if (ones) std::fill_n(T, bins_, 1.0f);
  if (none) std::fill_n(L, bins_, 0.0f);
  c.folded = true;
  c.steps = 0;
}

}  // namespace suite
