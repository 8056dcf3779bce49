// exp(-x) and what follows from it, for loops over many numbers: without branches, so that they become vector code
// (with -fno-trapping-math). Based on: the expf of S. Moshier's Cephes library (range reduction by ln 2 in two parts,
// polynomial of degree 7).
#pragma once
#include <bit>
#include <cstdint>
#include <span>

namespace suite {

// exp(y) for -87.33654 <= y <= 89, within 2e-7 of itself; infinite from 88.4 on.
inline float exp_within(float y) {
  constexpr float kRound = 12582912.0f;  // 1.5 * 2^23: adding it rounds to a whole number
  const float n = (y * 1.44269504088896341f + kRound) - kRound;
  const float r = (y - n * 0.693359375f) + n * 2.12194440e-4f;
  float p = 1.9875691500e-4f;
  p = p * r + 1.3981999507e-3f;
  p = p * r + 8.3334519073e-3f;
  p = p * r + 4.1665795894e-2f;
  p = p * r + 1.6666665459e-1f;
  p = p * r + 5.0000001201e-1f;
  p = (p * r * r + r) + 1.0f;
  return p * std::bit_cast<float>((static_cast<int32_t>(n) + 127) << 23);
}
// exp(-x) for x >= 0, within 2e-7 of itself; 2^-126 from 87.3 on.
inline float exp_falling(float x) { return exp_within(-(x < 87.33654f ? x : 87.33654f)); }

// exp(-depth[i]), of depths >= 0, as exp_falling has it; `to` may be `depth`.
void exp_falling(std::span<const float> depth, std::span<float> to);
// exp(from - depth[i]) of any sign, within 2e-7 and the rounding of the difference to a float; 2^-126 where the
// difference is below -87.3, infinite from 88.4 on. `to` may be `depth`.
void exp_difference(double from, std::span<const float> depth, std::span<float> to);

// What a slab of depth x >= 0 sends out towards s = 0, over what it would send if nothing dimmed it; keep: exp(-x).
// Even: its source is the same everywhere, the mean of exp(-x s) over s in 0..1, within 2e-6. Rising: its source grows
// from 0 at s = 0, the mean of 2 s exp(-x s), within 5e-6.
inline float mean_of_even(float x, float keep) {
  const float thin = 1 - x * (0.5f - x * (1 / 6.0f - x * (1 / 24.0f - x * (1 / 120.0f))));
  const float thick = (1 - keep) / (x < 0.25f ? 0.25f : x);
  return x < 0.25f ? thin : thick;
}
inline float mean_of_rising(float x, float keep) {
  const float thin = 1 - x * (2 / 3.0f - x * (0.25f - x * (1 / 15.0f - x * (1 / 72.0f - x * (1 / 420.0f)))));
  const float safe = (x < 0.25f ? 0.25f : x), thick = 2 * (1 - keep * (1 + safe)) / (safe * safe);
  return x < 0.25f ? thin : thick;
}

// Mean over a way of what changes evenly by a factor on it, from a >= 0 to b = a exp(-x), of any sign of x.
inline float mean_of_change(float a, float b, float x) {
  const float small = a * (1 - x * (0.5f - x * (1 / 6.0f - x * (1 / 24.0f - x * (1 / 120.0f - x * (1 / 720.0f))))));
  const float size = x < 0 ? -x : x, safe = size < 0.4f ? 1.0f : x, large = (a - b) / safe;
  return size < 0.4f ? small : large;
}

}  // namespace suite
