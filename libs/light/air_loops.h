// The innermost loops of real air, over bins: apart from the rest so that they become vector code (arrays that do not
// overlap).
#pragma once
#include <cstddef>

#include "light/local_air.h"
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

// A source that runs from low to high over a layer, as the sum of a few with weights, seen at two places in it (0..1).
struct Sources {
  const float *low[4], *high[4];
  float weight[4];
};
inline void see_sources(size_t n, const Sources& s, float near, float far, float* __restrict at_near,
                        float* __restrict at_far) {
  const auto& [low, high, w] = s;
  for (size_t i = 0; i < n; ++i) {
    const float bottom = w[0] * low[0][i] + w[1] * low[1][i] + w[2] * low[2][i] + w[3] * low[3][i];
    const float top = w[0] * high[0][i] + w[1] * high[1][i] + w[2] * high[2][i] + w[3] * high[3][i];
    at_near[i] = bottom + near * (top - bottom);
    at_far[i] = bottom + far * (top - bottom);
  }
}
inline void add_source(size_t n, const float* __restrict low, const float* __restrict high, float near, float far,
                       float* __restrict at_near, float* __restrict at_far) {
  for (size_t i = 0; i < n; ++i) {
    const float rise = high[i] - low[i];
    at_near[i] += low[i] + near * rise;
    at_far[i] += low[i] + far * rise;
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
// Light of a beam that is scattered once on a way; scattered: its irradiance above the air times 1/(m sr).
inline void scatter(size_t n, const float* __restrict scattered, float length, const Weights& w, const Beams& near,
                    const Beams& far, const float* __restrict T, float* __restrict S) {
  const float* __restrict depth = w.depth, * __restrict keep = w.keep, * __restrict d0 = near.depth, * __restrict d1 = far.depth, * __restrict e0 = near.light, * __restrict e1 = far.light;
  for (size_t i = 0; i < n; ++i)
    S[i] += T[i] * scattered[i] * length * mean_of_change(e0[i], e1[i] * keep[i], depth[i] + (d1[i] - d0[i]));
}

// A beam over a thin way: what is left of it at the near end, and how its depth changes up to the far end, by a part
// of the extinction (m) and one of its depth at the near end.
struct ThinBeam {
  const float *light, *depth, *scattered;
  float way, share;
};
inline constexpr float kThin = 0.25f;  // of a depth for which the series hold, within 2e-6
// Mean of exp(-x s) over s in 0..1, for |x| up to kThin.
inline float mean_of_thin(float x) { return 1 - x * (0.5f - x * (1 / 6.0f - x * (1 / 24.0f - x * (1 / 120.0f)))); }
// As mean_of_rising.
inline float rising_of_thin(float x) {
  return 1 - x * (2 / 3.0f - x * (0.25f - x * (1 / 15.0f - x * (1 / 72.0f - x * (1 / 420.0f)))));
}
// Light of a beam that is scattered once on a thin way.
inline void scatter_thin(size_t n, const float* __restrict extinction, float length, const ThinBeam& beam,
                         const float* __restrict T, float* __restrict S) {
  const float* __restrict light = beam.light, * __restrict depth = beam.depth, * __restrict scattered = beam.scattered;
  const float way = length + beam.way, share = beam.share;
  for (size_t i = 0; i < n; ++i)
    S[i] += T[i] * light[i] * scattered[i] * length * mean_of_thin(extinction[i] * way + depth[i] * share);
}
// Of a beam near the scene's middle, from tables: its depth, and what is left of it,
inline float depth_here(const LocalAir::BeamDepth& b, size_t i) {
  const float depth = (b.low[i] + b.rise[i] * b.share) * b.stretch + b.curve[i] * b.bend;
  return depth < 0 ? 0 : depth;
}
inline void fall_here(size_t n, const LocalAir::BeamDepth& beam, float* __restrict T) {
  for (size_t i = 0; i < n; ++i) T[i] = exp_falling(depth_here(beam, i));
}
// and its light that is scattered once on a way of `length` (m) that begins there; grows: the way over which extinction
// adds to the depth, m; share: as of ThinBeam.
struct BeamHere {
  LocalAir::BeamDepth depth;
  LocalAir::Scattered scattered;
  float length, grows, share;
};
template <bool thin>
inline float scattered_here(const BeamHere& beam, float extinction, size_t i) {
  const float* __restrict low = beam.scattered.low, * __restrict high = beam.scattered.high;
  const float depth = depth_here(beam.depth, i), sent = low[i] + beam.scattered.share * (high[i] - low[i]);
  const float more = extinction * beam.grows + depth * beam.share, end = depth + more, near = exp_falling(depth);
  return sent * beam.length *
         (thin ? near * mean_of_thin(more) : mean_of_change(near, exp_falling(end < 0 ? 0 : end), more));
}
// Of n bins from the first on.
template <bool thin>
inline void scatter_here(size_t first, size_t n, const float* __restrict extinction, const BeamHere& beam,
                         float* __restrict S) {
  for (size_t i = first; i < first + n; ++i) S[i] += scattered_here<thin>(beam, extinction[i], i);
}
// What a way does in all, of n bins from the first on: see_sources(), scatter_here(), weigh() and send() at once.
// alone: nothing lies before it, and T and S are set.
template <bool thin, bool alone>
inline void pass(size_t first, size_t n, const float* __restrict extinction, const Sources& sources, float near,
                 float far, const BeamHere& beam, float* __restrict T, float* __restrict S) {
  const auto& [low, high, w] = sources;
  const float length = beam.length, on = 0.5f * (far - near);
  for (size_t i = first; i < first + n; ++i) {
    const float bottom = w[0] * low[0][i] + w[1] * low[1][i] + w[2] * low[2][i] + w[3] * low[3][i];
    const float rise = w[0] * high[0][i] + w[1] * high[1][i] + w[2] * high[2][i] + w[3] * high[3][i] - bottom;
    const float x = extinction[i] * length, keep = thin ? 0 : exp_falling(x);
    const float even = x * (thin ? mean_of_thin(x) : mean_of_even(x, keep));
    const float rising = x * (thin ? rising_of_thin(x) : mean_of_rising(x, keep));
    const float sent =
        scattered_here<thin>(beam, extinction[i], i) + (bottom + near * rise) * even + on * rise * rising;
    const float through = thin ? 1 - even : keep;
    S[i] = alone ? sent : S[i] + T[i] * sent;
    T[i] = alone ? through : T[i] * through;
  }
}
// weigh() and send() of a thin way at once.
inline void send_thin(size_t n, const float* __restrict extinction, float length, const float* __restrict at_near,
                      const float* __restrict at_far, float* __restrict T, float* __restrict S) {
  for (size_t i = 0; i < n; ++i) {
    const float x = extinction[i] * length, even = x * mean_of_thin(x);
    S[i] += T[i] * (at_near[i] * even + (at_far[i] - at_near[i]) * (0.5f * x * rising_of_thin(x)));
    T[i] -= T[i] * even;
  }
}

}  // namespace suite::air_loops
