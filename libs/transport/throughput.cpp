#include "transport/throughput.h"

#include <immintrin.h>

#include <algorithm>
#include <cstring>
#include <new>

namespace suite {

namespace {

constexpr size_t kVector = 8;

// Neighbouring bins that are computed together: one, or eight.
struct One {
  static constexpr size_t kBins = 1;
  float x;
  static One all(float v) { return {v}; }
  static One at(const float* p) { return {*p}; }
  void to(float* p) const { *p = x; }
};
struct Eight {
  static constexpr size_t kBins = kVector;
  __m256 x;
  static Eight all(float v) { return {_mm256_set1_ps(v)}; }
  static Eight at(const float* p) { return {_mm256_loadu_ps(p)}; }
  void to(float* p) const { _mm256_storeu_ps(p, x); }
};

// W of them, in registers while all steps of a chain pass.
template <class V, size_t W>
struct Bins {
  V v[W];
  static Bins all(float x) {
    Bins b;
    for (V& v : b.v) v = V::all(x);
    return b;
  }
  static Bins at(const float* p) {
    Bins b;
    for (size_t w = 0; w < W; ++w) b.v[w] = V::at(p + w * V::kBins);
    return b;
  }
  void to(float* p) const {
    for (size_t w = 0; w < W; ++w) v[w].to(p + w * V::kBins);
  }
  friend Bins operator*(Bins a, const Bins& b) {
    for (size_t w = 0; w < W; ++w) a.v[w].x *= b.v[w].x;
    return a;
  }
  friend Bins operator+(Bins a, const Bins& b) {
    for (size_t w = 0; w < W; ++w) a.v[w].x += b.v[w].x;
    return a;
  }
};

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

// Bins k and after of a chain. Steps to one target after the other add up in registers.
template <class Bins>
void SpectralThroughputs::fold_bins(const Chain& c, const Step* steps, size_t k, float* memory_T,
                                    float* memory_L) const {
  const auto target = [=, this](size_t t) { return memory_L + t * stride_ + k; };
  Bins T = c.folded ? Bins::at(memory_T + k) : Bins::all(1), L = c.folded ? Bins::at(target(0)) : Bins::all(0);
  if (!c.folded)
    for (size_t t = 1; t < targets_; ++t) L.to(target(t));
  size_t gathers = 0;  // the target that L is of
  for (const Step* s = steps; s != steps + c.steps; ++s) {
    Bins x = Bins::all(s->scale);
    if (s->a) x = x * Bins::at(s->a + k);
    if (s->b) x = x * Bins::at(s->b + k);
    if (s->target == kTurn) {
      T = T * x;
      continue;
    }
    x = x * T;
    for (const uint16_t t : {s->target, s->second}) {
      if (t == kNone) break;
      if (t != gathers) {
        L.to(target(gathers));
        L = Bins::at(target(t)), gathers = t;
      }
      L = L + x;
    }
  }
  T.to(memory_T + k), L.to(target(gathers));
}

void SpectralThroughputs::fold(uint32_t p) {
  Chain& c = chains_[p];
  const Step* const steps = &step(p, 0);
  float* const T = &throughput_[size_t{p} * stride_];
  float* const L = &light_[size_t{p} * targets_ * stride_];
  size_t k = 0;
  for (; k + 4 * kVector <= bins_; k += 4 * kVector) fold_bins<Bins<Eight, 4>>(c, steps, k, T, L);
  for (; k + kVector <= bins_; k += kVector) fold_bins<Bins<Eight, 1>>(c, steps, k, T, L);
  for (; k < bins_; ++k) fold_bins<Bins<One, 1>>(c, steps, k, T, L);
  c.folded = true;
  c.steps = 0;
}

}  // namespace suite
