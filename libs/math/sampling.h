// Sample points as functions of (seed, capture, problem, sample, dimension): hash-based Owen-scrambled Sobol points,
// padded in blocks of four dimensions with hashed shuffles of the sample index, so that any thread, rank or resumed run
// draws the same numbers.
//
// Based on: B. Burley, "Practical hash-based Owen scrambling", JCGT 9(4), 2020; the permutation hash of N. Vegdahl
// (2021); Sobol direction numbers for the first four dimensions from Joe & Kuo, SIAM J. Sci. Comput. 30, 2008.
#pragma once
#include <array>
#include <cstdint>
#include <span>

#include "math/vec.h"

namespace suite {

// A well-mixed 64-bit hash of one or more integers (finaliser of splitmix64; Steele et al., OOPSLA 2014).
constexpr uint64_t mix64(uint64_t x) {
  x += 0x9e3779b97f4a7c15ull;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ull;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebull;
  return x ^ (x >> 31);
}
constexpr uint64_t hash_of(uint64_t a, uint64_t b) { return mix64(mix64(a) ^ b); }
constexpr uint64_t hash_of(uint64_t a, uint64_t b, uint64_t c) { return mix64(hash_of(a, b) ^ c); }
constexpr uint64_t hash_of(uint64_t a, uint64_t b, uint64_t c, uint64_t d) { return mix64(hash_of(a, b, c) ^ d); }

// Uniform double in [0, 1) from 53 / 32 bits.
constexpr double unit_double(uint64_t bits) { return static_cast<double>(bits >> 11) * 0x1p-53; }
constexpr double unit_double(uint32_t bits) { return bits * 0x1p-32; }

// Coordinate `dimension` (0..3) of point `index` of the Sobol sequence, as a 32-bit fraction.
uint32_t sobol4(uint32_t index, int dimension);
// The four coordinates of one point at once.
std::array<uint32_t, 4> sobol4(uint32_t index);
// A nested uniform (Owen) permutation of [0, 2^32) chosen by seed.
uint32_t owen_scramble(uint32_t value, uint32_t seed);

// The stream of one problem (pixel): an independent random scramble of the sequence per `scramble`.
// draw(sample, block) are four numbers in [0, 1): the stratified coordinates of that sample in that block of
// dimensions.
class SampleStream {
 public:
  SampleStream(uint64_t seed, uint64_t capture, uint64_t problem, uint32_t scramble = 0)
      : SampleStream(problem_key(seed, capture, problem), scramble) {}
  // The same, from what all scrambles of a problem have in common.
  SampleStream(uint64_t problem_key, uint32_t scramble)
      : key_(mix64(problem_key ^ scramble)), mixed_key_(mix64(key_)) {}
  static uint64_t problem_key(uint64_t seed, uint64_t capture, uint64_t problem) {
    return hash_of(hash_of(seed, capture), problem);
  }
  std::array<double, 4> draw(uint32_t sample, uint32_t block) const;
  // The same of many samples and streams, to the same bits, in less time.
  struct Point {
    uint64_t mixed_key;
    uint32_t sample, block;
    std::array<double, 4>* numbers;  // go there
  };
  Point point(uint32_t sample, uint32_t block, std::array<double, 4>& numbers) const {
    return {mixed_key_, sample, block, &numbers};
  }
  static void draw(std::span<const Point> points);
  // A number that is not stratified (hashed), for choices that must not use up a low-discrepancy dimension.
  double hashed(uint32_t sample, uint32_t purpose) const {
    return unit_double(hash_of(key_, 0x68617368ull, (uint64_t{purpose} << 32) | sample));
  }
  uint64_t key() const { return key_; }

 private:
  uint64_t key_, mixed_key_;
};

// Independent random numbers behind the same interface as a stream of bits; for tests and reference estimators.
class Pcg32 {
 public:
  explicit Pcg32(uint64_t seed, uint64_t stream = 0) : state_(0), increment_((stream << 1) | 1) {
    next();
    state_ += seed;
    next();
  }
  uint32_t next() {  // O'Neill, "PCG", HMC-CS-2014-0905
    const uint64_t old = state_;
    state_ = old * 6364136223846793005ull + increment_;
    const uint32_t shifted = static_cast<uint32_t>(((old >> 18) ^ old) >> 27);
    const int rot = static_cast<int>(old >> 59);
    return (shifted >> rot) | (shifted << ((-rot) & 31));
  }
  double uniform() { return unit_double((uint64_t{next()} << 32) | next()); }

 private:
  uint64_t state_, increment_;
};

}  // namespace suite
