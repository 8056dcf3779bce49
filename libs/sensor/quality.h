// What the bits of a problem's quality mean: the one table that files, logs and closing lines name them from, and the
// two numbers of the promise that a flag takes back.
#pragma once
#include <array>
#include <bit>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "sensor/sensor.h"

namespace suite {

// quality_heavy_tail: the true error of a problem at the reference band may exceed kTailFactor times its reported
// standard error by more than kTailShare of its radiance. Without it that is rarer than Student's distribution says
// for the scrambles of one problem (1.5 % with four, 0.2 % with eight), and only where the standard error itself is
// some per cent of the radiance. Where the capture has a target for its relative error, the target stands for
// kTailShare, and its floor for the radiance of darker problems. How the flag is found: libs/estimate/tails.h.
inline constexpr double kTailFactor = 5, kTailShare = 0.01;

struct QualityBit {
  QualityFlag bit;
  std::string name;     // "heavy_tail", as files and logs have it
  std::string meaning;  // half a sentence
};
// All bits, lowest first.
std::span<const QualityBit> quality_bits();

// How many problems carry a flag.
struct QualityCounts {
  uint64_t problems = 0, flagged = 0;  // flagged: any bit
  std::array<uint64_t, 8> of{};        // of bit 1 << i
  void add(std::span<const uint8_t> quality);
  // Problems that were counted before carry one more bit; alone: those that carried none.
  void add(QualityFlag bit, uint64_t carrying, uint64_t alone) { of[index_of(bit)] += carrying, flagged += alone; }
  uint64_t with(QualityFlag bit) const { return of[index_of(bit)]; }
  static size_t index_of(QualityFlag bit) { return static_cast<size_t>(std::countr_zero(unsigned{bit})); }
};

// The same, of one sensor.
struct SensorQuality {
  std::string sensor;
  QualityCounts counts;
};

// The bits that were seen, as "heavy_tail 12, failures 3"; empty when there was none.
std::string text_of(const QualityCounts& counts);

}  // namespace suite
