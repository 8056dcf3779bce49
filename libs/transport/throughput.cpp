#include "transport/throughput.h"

#include <algorithm>
#include <array>
#include <new>
#include <utility>

namespace suite {

namespace {

constexpr size_t kVector = 8;
// Spectra that are multiplied with each other; ones are left out.
struct Factors {
  std::array<const float*, 4> of{};
  size_t count = 0;
  void add(const float* spectrum) {
    if (spectrum) of[count++] = spectrum;
  }
};

// L <- L + scale times the product of N spectra; none: L is not yet anything, and counts as 0. kKeep: the product of
// the last two is kept in T, which may be one of them.
template <size_t N, bool kKeep>
void add(float* L, bool none, float scale, const Factors& f, float* T, size_t n) {
  const auto [a, b, c, d] = f.of;
  const auto value = [=](size_t k) {
    float x = scale;
    if constexpr (N > 0 && !(kKeep && N < 3)) x *= a[k];
    if constexpr (N > 1 && !(kKeep && N < 4)) x *= b[k];
    if constexpr (N > 2 && !kKeep) x *= c[k];
    if constexpr (N > 3 && !kKeep) x *= d[k];
    if constexpr (kKeep) {
      const float kept = f.of[N - 2][k] * f.of[N - 1][k];
      T[k] = kept, x *= kept;
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

void add(float* L, bool none, float scale, const Factors& f, float* keep, size_t n) {
  switch (f.count) {
    case 0:
      return add<0, false>(L, none, scale, f, keep, n);
    case 1:
      return add<1, false>(L, none, scale, f, keep, n);
    case 2:
      return keep ? add<2, true>(L, none, scale, f, keep, n) : add<2, false>(L, none, scale, f, keep, n);
    case 3:
      return keep ? add<3, true>(L, none, scale, f, keep, n) : add<3, false>(L, none, scale, f, keep, n);
    default:
      return keep ? add<4, true>(L, none, scale, f, keep, n) : add<4, false>(L, none, scale, f, keep, n);
  }
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

// T <- T times a step's factor.
void SpectralThroughputs::turn_by(uint32_t p, const Step& by) {
  Chain& c = chains_[p];
  c.scale *= by.scale;
  if (!by.a) return;
  if (!c.t) {
    c.t = by.a;
    return;
  }
  if (c.u) {
    float* const T = &throughput_[size_t{p} * stride_];
    const float *t = c.t, *u = c.u;
#pragma GCC ivdep
    for (size_t k = 0; k < bins_; ++k) T[k] = t[k] * u[k];
    c.t = T;
  }
  c.u = by.a;
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
    if (s->target == kTurn && s->a) last_turn = s;
  for (const Step* s = begin; s != begin + c.steps; ++s) {
    if (s->target == kTurn) {
      turn_by(p, *s);
      continue;
    }
    Factors f;
    for (const float* spectrum : {s->a, s->b, c.t, c.u}) f.add(spectrum);
    float* const keep = c.u && s < last_turn ? T : nullptr;
    add(L + s->target * stride_, std::exchange(none, false), c.scale * s->scale, f, keep, bins_);
    if (keep) c.t = T, c.u = nullptr;
    if (s->second == kNone) continue;
    f = {};
    for (const float* spectrum : {s->a, s->b, c.t, c.u}) f.add(spectrum);
    add(L + s->second * stride_, false, c.scale * s->scale, f, nullptr, bins_);
  }
  if (none) std::fill_n(L, bins_, 0.0f);
  c.light = true;
  c.steps = 0;
}

void SpectralThroughputs::settle(uint32_t p) {
  if (bins_ == 1) return;
  fold(p);
  Chain& c = chains_[p];
  float* const T = &throughput_[size_t{p} * stride_];
  if (c.t == T && !c.u && c.scale == 1) return;
  const float scale = c.scale;
  const float *const t = c.t, *const u = c.u;
#pragma GCC ivdep
  for (size_t k = 0; k < bins_; ++k) T[k] = scale * (t ? t[k] : 1.0f) * (u ? u[k] : 1.0f);
  c.scale = 1, c.t = T, c.u = nullptr;
}

}  // namespace suite
