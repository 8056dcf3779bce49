#include "transport/throughput.h"

#include <algorithm>
#include <new>
#include <utility>

namespace suite {

namespace {

constexpr size_t kVector = 8;

// L <- L + scale a b (t u), null = ones; none: L is not yet anything, and counts as 0. T: where t u is to be kept, or
// null; it may be t or u. t and u are multiplied with each other first, kept or not: sums do not depend on where a
// chain is folded.
struct Product {
  float scale;
  const float *a, *b, *t, *u;
};
template <bool kA, bool kB, int kT, bool kKeep>
void add(float* L, bool none, const Product& f, float* T, size_t n) {
  const auto [scale, a, b, t, u] = f;
  const auto value = [=](size_t k) {
    float x = scale;
    if constexpr (kA) x *= a[k];
    if constexpr (kB) x *= b[k];
    if constexpr (kT == 1) x *= t[k];
    if constexpr (kT == 2) {
      const float both = t[k] * u[k];
      if constexpr (kKeep) T[k] = both;
      x *= both;
    }
    return x;
  };
  if (none) {
#pragma GCC ivdep
    for (size_t k = 0; k < n; ++k) L[k] = value(k);
  } else {
#pragma GCC ivdep
    for (size_t k = 0; k < n; ++k) L[k] += value(k);
  }
}

template <bool kA, bool kB>
void add(float* L, bool none, const Product& f, float* T, size_t n) {
  if (!f.t) return add<kA, kB, 0, false>(L, none, f, T, n);
  if (!f.u) return add<kA, kB, 1, false>(L, none, f, T, n);
  T ? add<kA, kB, 2, true>(L, none, f, T, n) : add<kA, kB, 2, false>(L, none, f, T, n);
}

void add(float* L, bool none, const Product& f, float* T, size_t n) {
  if (f.a)
    f.b ? add<true, true>(L, none, f, T, n) : add<true, false>(L, none, f, T, n);
  else
    f.b ? add<false, true>(L, none, f, T, n) : add<false, false>(L, none, f, T, n);
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

// t u <- t u times a step's factor.
void SpectralThroughputs::turn_by(uint32_t p, const float* by) {
  Chain& c = chains_[p];
  if (!c.t) {
    c.t = by;
    return;
  }
  if (c.u) {
    float* const T = &throughput_[size_t{p} * stride_];
    const float *t = c.t, *u = c.u;
#pragma GCC ivdep
    for (size_t k = 0; k < bins_; ++k) T[k] = t[k] * u[k];
    c.t = T;
  }
  c.u = by;
}

// What is not yet anything is written by the first step that makes it something.
void SpectralThroughputs::fold(uint32_t p) {
  Chain& c = chains_[p];
  float* const T = &throughput_[size_t{p} * stride_];
  float* const L = &light_[size_t{p} * targets_ * stride_];
  bool none = !c.light && targets_ == 1;
  if (!c.light && !none) std::fill_n(L, targets_ * stride_, 0.0f);
  const Step* const begin = &step(p, 0);
  const Step* last_turn = begin;  // behind the last that will be asked for a product
  for (const Step* s = begin; s != begin + c.steps; ++s)
    if (s->target == kTurn) last_turn = s;
  for (const Step* s = begin; s != begin + c.steps; ++s) {
    if (s->target == kTurn) {
      turn_by(p, s->a);
      continue;
    }
    const Product product{s->scale, s->a, s->b, c.t, c.u};
    float* const keep = c.u && s < last_turn ? T : nullptr;
    add(L + s->target * stride_, std::exchange(none, false), product, keep, bins_);
    if (s->second != kNone)
      add(L + s->second * stride_, false, {product.scale, s->a, s->b, keep ? keep : c.t, keep ? nullptr : c.u}, nullptr,
          bins_);
    if (keep) c.t = T, c.u = nullptr;
  }
  if (none) std::fill_n(L, bins_, 0.0f);
  c.light = true;
  c.steps = 0;
}

void SpectralThroughputs::stand(uint32_t p) {
  fold(p);
  Chain& c = chains_[p];
  float* const T = &throughput_[size_t{p} * stride_];
  if (!c.t || (c.t == T && !c.u)) return;
  const float *const t = c.t, *const u = c.u;
#pragma GCC ivdep
  for (size_t k = 0; k < bins_; ++k) T[k] = u ? t[k] * u[k] : t[k];
  c.t = T, c.u = nullptr;
}

void SpectralThroughputs::settle(uint32_t p) {
  if (bins_ == 1) return;
  stand(p);
  Chain& c = chains_[p];
  float* const T = &throughput_[size_t{p} * stride_];
  if (c.t && c.scale == 1) return;
  const float scale = c.scale;
#pragma GCC ivdep
  for (size_t k = 0; k < bins_; ++k) T[k] = c.t ? scale * T[k] : scale;
  c.scale = 1, c.t = T;
}

void SpectralThroughputs::shine_now(uint32_t p, const Factor& factor, float scale, const float* radiance,
                                    std::span<const float> s, uint16_t target) {
  settle(p);
  const float* const T = &throughput_[size_t{p} * stride_];
  float* const L = &light_[(size_t{p} * targets_ + target) * stride_];
  for (size_t k = 0; k < bins_; ++k)
    L[k] +=
        factor.scale * scale * (factor.spectrum ? factor.spectrum[k] : 1) * (radiance ? radiance[k] : 1) * s[k] * T[k];
}

}  // namespace suite
