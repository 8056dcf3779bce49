#include "page/packed.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace suite {

namespace {

constexpr double kTiny = 0x1p-24;

float of_half(uint16_t bits) {
  const int exponent = bits >> 10 & 31, mantissa = bits & 1023;
  const double size = exponent == 0 ? std::ldexp(mantissa, -24) : std::ldexp(1024 + mantissa, exponent - 25);
  return static_cast<float>(bits & 0x8000 ? -size : size);
}

double largest_of(std::span<const float> values) {
  double largest = 0;
  for (const float v : values)
    if (std::isfinite(v)) largest = std::max(largest, std::fabs(static_cast<double>(v)));
  return largest;
}

}  // namespace

uint16_t half_bits(float x) {
  const uint32_t bits = std::bit_cast<uint32_t>(x), magnitude = bits & 0x7fffffffu;
  const uint16_t sign = static_cast<uint16_t>(bits >> 16 & 0x8000u);
  if (magnitude > 0x7f800000u) return static_cast<uint16_t>(sign | 0x7e00u);
  if (magnitude >= 0x47800000u) return static_cast<uint16_t>(sign | 0x7c00u);
  // Numbers below 2^-14 are multiples of 2^-24.
  if (magnitude < 0x38800000u)
    return static_cast<uint16_t>(sign | static_cast<uint16_t>(std::nearbyint(std::ldexp(std::fabs(x), 24))));
  const uint32_t shifted = magnitude - 0x38000000u, kept = shifted >> 13, rest = shifted & 0x1fffu;
  const uint32_t up = rest > 0x1000u || (rest == 0x1000u && (kept & 1)) ? 1 : 0;
  return static_cast<uint16_t>(sign | (kept + up));
}

Packed packed_half(std::span<const float> values) {
  Packed p;
  const double largest = largest_of(values);
  if (largest > 0) p.first = std::ilogb(largest) - 14;
  p.codes.resize(values.size());
  for (size_t i = 0; i < values.size(); ++i) {
    const double scaled = std::ldexp(static_cast<double>(values[i]), -static_cast<int>(p.first));
    const uint16_t bits = half_bits(static_cast<float>(scaled));
    p.codes[i] = bits;
    if (std::isfinite(values[i]) && std::fabs(values[i]) > kTiny * largest)
      p.loss = std::max(p.loss, std::fabs(of_half(bits) / scaled - 1));
  }
  return p;
}

Packed packed_log8(std::span<const float> values) {
  Packed p;
  double low = INFINITY, high = 0;
  for (const float v : values)
    if (std::isfinite(v) && v > 0)
      low = std::min(low, static_cast<double>(v)), high = std::max(high, static_cast<double>(v));
  p.first = high > 0 ? low : 1;
  const double step = high > low ? std::log(high / low) / 253 : 0;
  p.second = std::exp(step);
  p.codes.resize(values.size());
  for (size_t i = 0; i < values.size(); ++i) {
    const double v = values[i];
    double code = 0;
    if (v == 0) code = 1;
    if (std::isfinite(v) && v > 0) {
      code = 2 + (step > 0 ? std::clamp(std::nearbyint(std::log(v / low) / step), 0.0, 253.0) : 0);
      p.loss = std::max(p.loss, std::fabs(low * std::pow(p.second, code - 2) / v - 1));
    }
    p.codes[i] = static_cast<uint16_t>(code);
  }
  return p;
}

}  // namespace suite
