// Which independent scramble of the low-discrepancy sequence a sample belongs to.
#pragma once
#include <cstdint>

namespace suite {

inline constexpr int kMostScrambles = 8;

// Samples are dealt to independent scrambles of the sequence, from whose spread the standard error comes. The rule
// depends on the sample's number alone, so that a run that is continued deals like one that never stopped: four
// scrambles share the first 256 samples, four more the next 256, all eight take turns from there on.
struct Deal {
  uint32_t scramble, index;
};
constexpr Deal deal(uint32_t sample) {
  if (sample < 256) return {sample % 4, sample / 4};
  if (sample < 512) return {4 + sample % 4, (sample - 256) / 4};
  return {sample % 8, 64 + (sample - 512) / 8};
}
// The number of the sample that is dealt as this one.
constexpr uint32_t sample_of(Deal d) {
  if (d.index >= 64) return 512 + 8 * (d.index - 64) + d.scramble;
  return d.scramble < 4 ? 4 * d.index + d.scramble : 256 + 4 * d.index + d.scramble - 4;
}
// How many of the first n samples went to a scramble.
constexpr uint32_t dealt(uint32_t n, uint32_t scramble) {
  const uint32_t begin = scramble < 4 ? 0 : 256, lane = scramble % 4;
  const uint32_t early = n <= begin ? 0 : n - begin < 256 ? n - begin : 256;
  const uint32_t late = n > 512 ? n - 512 : 0;
  return (early + 3 - lane) / 4 + (late + 7 - scramble) / 8;
}
// Scrambles that `samples` samples are dealt to.
constexpr int scrambles_for(uint32_t samples) { return samples > 256 ? 8 : 4; }

// A set of scrambles: bit s is scramble s.
using Scrambles = uint8_t;
inline constexpr Scrambles kAllScrambles = 0xff;

}  // namespace suite
