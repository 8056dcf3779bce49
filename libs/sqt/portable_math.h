// Elementary functions made of IEEE additions and multiplications only, so that a file decodes to the same bits with
// any mathematical library and instruction set. Used where the decoder's control flow or step sizes depend on a value.
#pragma once
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

#include "sqt/vectors.h"

namespace suite::sqt {

// 2^x for -120 <= x <= 120 (clamped); relative error below 2e-7. Remez-like quintic on [-0.5, 0.5].
inline float portable_exp2(float x) {
  x = x < -120 ? -120 : x > 120 ? 120 : x;
  const float n = static_cast<float>(static_cast<int>(x + (x < 0 ? -0.5f : 0.5f)));
  const float r = x - n;
  const float p =
      1.0f + r * (0.693147180f + r * (0.240226507f + r * (0.0555041087f + r * (0.00961812911f + r * 0.00133335581f))));
  return p * std::bit_cast<float>(static_cast<uint32_t>(static_cast<int>(n) + 127) << 23);
}

// The same for eight numbers at once; the same bits.
inline EightFloats portable_exp2(EightFloats x) {
  using EightInts = int32_t __attribute__((vector_size(32)));
  x = x < -120 ? EightFloats{} - 120 : x > 120 ? EightFloats{} + 120 : x;
  const EightInts n = __builtin_convertvector(x + (x < 0 ? EightFloats{} - 0.5f : EightFloats{} + 0.5f), EightInts);
  const EightFloats r = x - __builtin_convertvector(n, EightFloats);
  const EightFloats p =
      1.0f + r * (0.693147180f + r * (0.240226507f + r * (0.0555041087f + r * (0.00961812911f + r * 0.00133335581f))));
  return p * reinterpret_cast<EightFloats>((n + 127) << 23);
}

// Mean of 2^(slope t) over t in [-1/2, 1/2]: sinh(a) / a with a = slope ln 2 / 2, by its series (|slope| <= 8; error <
// 1e-4).
inline float mean_exp2(float slope) {
  const float a2 = std::min(8.0f, slope * slope * 0.120113254f);
  return 1 + a2 * (1.0f / 6) * (1 + a2 * (1.0f / 20) * (1 + a2 * (1.0f / 42) * (1 + a2 * (1.0f / 72))));
}

// log2(x) for positive normal x, absolute error below 1e-7: atanh series of the mantissa.
inline double portable_log2(double x) {
  const uint64_t bits = std::bit_cast<uint64_t>(x);
  int e = static_cast<int>((bits >> 52) & 0x7FF) - 1023;
  double m = std::bit_cast<double>((bits & 0xFFFFFFFFFFFFFull) | 0x3FF0000000000000ull);
  if (m > 1.4142135623730951) m *= 0.5, ++e;
  const double t = (m - 1) / (m + 1), t2 = t * t;
  return e + 2.8853900817779268 * t * (1 + t2 * (1.0 / 3 + t2 * (1.0 / 5 + t2 * (1.0 / 7 + t2 * (1.0 / 9)))));
}

// cos(pi * n / m) for integers, by the Taylor series after reduction to [0, pi/4].
inline double portable_cos_pi(long long n, long long m) {
  n %= 2 * m;
  if (n < 0) n += 2 * m;
  if (n > m) n = 2 * m - n;
  double sign = 1;
  if (2 * n > m) n = m - n, sign = -1;
  const bool use_sine = 4 * n > m;
  const double x = 3.14159265358979323846 * (use_sine ? 0.5 - static_cast<double>(n) / static_cast<double>(m)
                                                      : static_cast<double>(n) / static_cast<double>(m));
  const double x2 = x * x;
  const double c =
      1 - x2 / 2 * (1 - x2 / 12 * (1 - x2 / 30 * (1 - x2 / 56 * (1 - x2 / 90 * (1 - x2 / 132 * (1 - x2 / 182))))));
  const double s = x * (1 - x2 / 6 * (1 - x2 / 20 * (1 - x2 / 42 * (1 - x2 / 72 * (1 - x2 / 110 * (1 - x2 / 156))))));
  return sign * (use_sine ? s : c);
}

}  // namespace suite::sqt
