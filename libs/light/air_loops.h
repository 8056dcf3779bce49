// The innermost loops of real air, over bins: apart from the rest so that they become vector code (arrays that do not
// overlap).
#pragma once
#include <cstddef>

#include "math/falling.h"

namespace suite::air_loops {

// Depth of a way, what it lets through, and the weights of a source's values at its near end and of its change along
// it.
struct Weights {
  float *depth, *keep, *even, *change;
};
inline void weigh(size_t n, const float* __restrict extinction, float length, const Weights& w) {
  float* __restrict depth = w.depth, * __restrict keep = w.keep, * __restrict even = w.even, * __restrict change = w.change;
  for (size_t i = 0; i < n; ++i) {
    const float x = extinction[i] * length, k = exp_falling(x);
    depth[i] = x;
    keep[i] = k;
    even[i] = x * mean_of_even(x, k);
    change[i] = 0.5f * x * mean_of_rising(x, k);
  }
}

// Adds a share of a source that runs from `low` to `high` over a layer, seen at two places in it (0..1).
inline void add_source(size_t n, const float* __restrict low, const float* __restrict high, float share, float near,
                       float far, float* __restrict at_near, float* __restrict at_far) {
  for (size_t i = 0; i < n; ++i) {
    const float rise = share * (high[i] - low[i]), bottom = share * low[i];
    at_near[i] += bottom + near * rise;
    at_far[i] += bottom + far * rise;
  }
}

// What a way sends back: S += T (source); then T is dimmed by the way.
inline void send(size_t n, const Weights& w, const float* __restrict at_near, const float* __restrict at_far,
                 float* __restrict T, float* __restrict S) {
  const float* __restrict keep = w.keep, * __restrict even = w.even, * __restrict change = w.change;
  for (size_t i = 0; i < n; ++i) {
    S[i] += T[i] * (at_near[i] * even[i] + (at_far[i] - at_near[i]) * change[i]);
    T[i] *= keep[i];
  }
}

inline void multiply_add(size_t n, const float* __restrict a, const float* __restrict b, float* __restrict sums) {
  for (size_t i = 0; i < n; ++i) sums[i] += a[i] * b[i];
}

inline void fall(size_t n, const float* __restrict depth, float* __restrict light) {
  for (size_t i = 0; i < n; ++i) light[i] = exp_falling(depth[i]);
}

// A beam on its way: depth and what is left of it.
struct Beams {
  const float *depth, *light;
};
// Light of a beam that is scattered once on a way; scattered: 1/(m sr).
inline void scatter(size_t n, const float* __restrict irradiance, const float* __restrict scattered, float length,
                    const Weights& w, const Beams& near, const Beams& far, const float* __restrict T,
                    float* __restrict S) {
  const float* __restrict depth = w.depth, * __restrict keep = w.keep, * __restrict d0 = near.depth, * __restrict d1 = far.depth, * __restrict e0 = near.light, * __restrict e1 = far.light;
  for (size_t i = 0; i < n; ++i)
    S[i] += T[i] * irradiance[i] * scattered[i] * length *
            mean_of_change(e0[i], e1[i] * keep[i], depth[i] + (d1[i] - d0[i]));
}

}  // namespace suite::air_loops
