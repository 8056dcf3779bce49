#include "page/steps.h"

#include <algorithm>
#include <array>
#include <bit>

#include "base/error.h"

namespace suite {

namespace {

constexpr size_t kBlock = 64;
constexpr unsigned kWithBase = 1, kFromFirst = 2, kWays = 4;

using Block = std::array<uint16_t, kBlock>;

uint16_t difference(uint16_t a, uint16_t b) { return static_cast<uint16_t>(a - b); }

// A step between -2^15 and 2^15 - 1 as a number that is small when the step is.
uint16_t folded(uint16_t step) {
  const uint16_t doubled = static_cast<uint16_t>(step << 1);
  return step & 0x8000 ? static_cast<uint16_t>(~doubled) : doubled;
}

struct Steps {
  Block folded{};
  uint16_t first = 0;
  unsigned way = 0, width = 17;
};

Steps steps_of(const Block& codes, const Block& base, unsigned way) {
  Steps s;
  s.way = way;
  Block rest = codes;
  if (way & kWithBase)
    for (size_t i = 0; i < kBlock; ++i) rest[i] = difference(codes[i], base[i]);
  s.first = rest[0];
  unsigned all = 0;
  for (size_t i = 1; i < kBlock; ++i) {
    s.folded[i] = folded(difference(rest[i], way & kFromFirst ? rest[0] : rest[i - 1]));
    all |= s.folded[i];
  }
  s.width = static_cast<unsigned>(std::bit_width(all));
  return s;
}

void put_head(const Steps& s, std::byte* to) {
  const unsigned head = s.first | s.width << 16 | s.way << 21;
  for (unsigned i = 0; i < 3; ++i) to[i] = static_cast<std::byte>(head >> (8 * i) & 255u);
}

void put_steps(const Steps& s, std::vector<std::byte>& to) {
  uint32_t waiting = 0;
  unsigned bits = 0;
  for (const uint16_t step : s.folded) {
    waiting |= static_cast<uint32_t>(step) << bits;
    for (bits += s.width; bits >= 8; bits -= 8, waiting >>= 8) to.push_back(static_cast<std::byte>(waiting & 255u));
  }
}

// The block that begins at `from`; where it ends early, the last code stands for the rest.
Block block_at(std::span<const uint16_t> codes, size_t from) {
  Block b;
  const size_t n = std::min(kBlock, codes.size() - from);
  std::copy_n(codes.begin() + static_cast<std::ptrdiff_t>(from), n, b.begin());
  std::fill(b.begin() + static_cast<std::ptrdiff_t>(n), b.end(), b[n - 1]);
  return b;
}

}  // namespace

std::vector<std::byte> in_steps(std::span<const uint16_t> codes, std::span<const uint16_t> base) {
  SUITE_CHECK(base.empty() || base.size() == codes.size());
  const size_t blocks = (codes.size() + kBlock - 1) / kBlock;
  std::vector<std::byte> out(3 * blocks);
  out.reserve(3 * blocks + codes.size());
  for (size_t i = 0; i < blocks; ++i) {
    const Block block = block_at(codes, i * kBlock), other = base.empty() ? Block{} : block_at(base, i * kBlock);
    Steps best;
    for (unsigned way = 0; way < kWays; ++way) {
      if (way & kWithBase && base.empty()) continue;
      const Steps s = steps_of(block, other, way);
      if (s.width < best.width) best = s;
    }
    put_head(best, &out[3 * i]);
    put_steps(best, out);
  }
  return out;
}

}  // namespace suite
