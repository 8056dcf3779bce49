#include "math/sampling.h"

#include <cstring>

namespace suite {

namespace {

// Direction numbers of the first four Sobol dimensions, generated once at compile time from the primitive polynomials
// and initial values of Joe & Kuo (new-joe-kuo-6): d2: s=1 a=0 m=1; d3: s=2 a=1 m=1,3; d4: s=3 a=1 m=1,3,1.
struct Polynomial {
  int degree;
  uint32_t coefficients;
  uint32_t initial[3];
};
constexpr Polynomial kPolynomials[3] = {{1, 0, {1, 0, 0}}, {2, 1, {1, 3, 0}}, {3, 1, {1, 3, 1}}};

constexpr std::array<std::array<uint32_t, 32>, 4> direction_numbers() {
  std::array<std::array<uint32_t, 32>, 4> v{};
  for (int i = 0; i < 32; ++i) v[0][i] = 1u << (31 - i);
  for (int d = 1; d < 4; ++d) {
    const Polynomial& p = kPolynomials[d - 1];
    for (int i = 0; i < 32; ++i) {
      if (i < p.degree) {
        v[d][i] = p.initial[i] << (31 - i);
      } else {
        uint32_t x = v[d][i - p.degree] ^ (v[d][i - p.degree] >> p.degree);
        for (int k = 1; k < p.degree; ++k)
          if ((p.coefficients >> (p.degree - 1 - k)) & 1) x ^= v[d][i - k];
        v[d][i] = x;
      }
    }
  }
  return v;
}
constexpr auto kDirections = direction_numbers();

constexpr uint32_t reversed(uint32_t x) {
  uint32_t r = 0;
  for (int i = 0; i < 32; ++i) r |= ((x >> i) & 1u) << (31 - i);
  return r;
}

// XOR of the direction numbers of the set bits, four bits at a time: 8 look-ups instead of up to 32 branches.
// Scrambling works on numbers with their bits in reverse order, so index and value of the table are kept that way.
struct Nibbles {
  alignas(16) uint32_t value[8][16][4];
};
constexpr Nibbles nibble_table() {
  Nibbles t{};
  for (int n = 0; n < 8; ++n)
    for (int bits = 0; bits < 16; ++bits)
      for (int d = 0; d < 4; ++d) {
        uint32_t x = 0;
        for (int k = 0; k < 4; ++k)
          if ((bits >> k) & 1) x ^= kDirections[d][31 - (4 * n + k)];
        t.value[n][bits][d] = reversed(x);
      }
  return t;
}
constexpr Nibbles kNibbles = nibble_table();

// Both maps below take one number, or four at once in a vector of the compiler's.
using Four = uint32_t __attribute__((vector_size(16)));

template <class T>
constexpr T reverse_bits(T x) {
  x = (x << 16) | (x >> 16);
  x = ((x & 0x00ff00ffu) << 8) | ((x >> 8) & 0x00ff00ffu);
  x = ((x & 0x0f0f0f0fu) << 4) | ((x >> 4) & 0x0f0f0f0fu);
  x = ((x & 0x33333333u) << 2) | ((x >> 2) & 0x33333333u);
  return ((x & 0x55555555u) << 1) | ((x >> 1) & 0x55555555u);
}

// Laine-Karras style permutation: each output bit depends on lower input bits only. Constants: Vegdahl 2021.
template <class T>
constexpr T laine_karras(T x, T seed) {
  x ^= x * 0x3d20adeau;
  x += seed;
  x *= (seed >> 16) | 1;
  x ^= x * 0x05526c56u;
  x ^= x * 0x53a22864u;
  return x;
}

// The four coordinates of a point; both index and coordinates in reversed bits.
inline Four reversed_point(uint32_t reversed_index) {
  Four x{};
  for (int n = 0; n < 8; ++n) {
    Four row;
    std::memcpy(&row, kNibbles.value[n][(reversed_index >> (4 * n)) & 15], sizeof row);
    x ^= row;
  }
  return x;
}

// 32-bit fractions as doubles, exactly; the processor converts signed numbers only.
std::array<double, 4> units(Four bits) {
  const auto shifted = reinterpret_cast<int32_t __attribute__((vector_size(16)))>(bits ^ 0x80000000u);
  const auto u = __builtin_convertvector(shifted, double __attribute__((vector_size(32)))) * 0x1p-32 + 0.5;
  std::array<double, 4> values;
  std::memcpy(values.data(), &u, sizeof u);
  return values;
}

}  // namespace

uint32_t owen_scramble(uint32_t value, uint32_t seed) { return reverse_bits(laine_karras(reverse_bits(value), seed)); }

uint32_t sobol4(uint32_t index, int dimension) { return sobol4(index)[dimension]; }

std::array<uint32_t, 4> sobol4(uint32_t index) {
  const Four point = reverse_bits(reversed_point(reverse_bits(index)));
  return {point[0], point[1], point[2], point[3]};
}

namespace {

// A point in reversed bits, before it is scrambled, and the seeds of that.
struct Unscrambled {
  Four point, seeds;
};
inline Unscrambled unscrambled(uint64_t mixed_key, uint32_t sample, uint32_t block) {
  // A nested shuffle of the sample index decorrelates the blocks and keeps every power-of-two prefix stratified.
  const uint64_t key = mix64(mixed_key ^ block);  // hash_of(key_, block)
  const uint32_t shuffled = laine_karras(reverse_bits(sample), static_cast<uint32_t>(key));
  const uint64_t a = mix64(key), b = mix64(key ^ 0x5bd1e995ull);
  const Four seeds{static_cast<uint32_t>(a), static_cast<uint32_t>(a >> 32), static_cast<uint32_t>(b),
                   static_cast<uint32_t>(b >> 32)};
  return {reversed_point(shuffled), seeds};
}

}  // namespace

std::array<double, 4> SampleStream::draw(uint32_t sample, uint32_t block) const {
  const Unscrambled x = unscrambled(mixed_key_, sample, block);
  return units(reverse_bits(laine_karras(x.point, x.seeds)));
}

// Two points fill a vector.
void SampleStream::draw(std::span<const Point> points) {
  using Eight = uint32_t __attribute__((vector_size(32)));
  size_t i = 0;
  for (; i + 2 <= points.size(); i += 2) {
    const Unscrambled x = unscrambled(points[i].mixed_key, points[i].sample, points[i].block);
    const Unscrambled y = unscrambled(points[i + 1].mixed_key, points[i + 1].sample, points[i + 1].block);
    const auto both = [](Four a, Four b) { return __builtin_shufflevector(a, b, 0, 1, 2, 3, 4, 5, 6, 7); };
    const Eight u = reverse_bits(laine_karras<Eight>(both(x.point, y.point), both(x.seeds, y.seeds)));
    *points[i].numbers = units(__builtin_shufflevector(u, u, 0, 1, 2, 3));
    *points[i + 1].numbers = units(__builtin_shufflevector(u, u, 4, 5, 6, 7));
  }
  for (; i < points.size(); ++i) {
    const Unscrambled x = unscrambled(points[i].mixed_key, points[i].sample, points[i].block);
    *points[i].numbers = units(reverse_bits(laine_karras(x.point, x.seeds)));
  }
}

}  // namespace suite
