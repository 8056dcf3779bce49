#include "sqt_fit/prefix_encoder.h"

#include <algorithm>
#include <array>

#include "base/error.h"
#include "sqt_fit/range_encoder.h"

namespace suite::sqt {

namespace {

constexpr uint32_t kSymbols = PrefixLengths::kSymbols, kBits = PrefixLengths::kMost;

// Lengths of a Huffman code, cut to kBits bits: too long codes are shortened and the code is made to fit
// again by lengthening the cheapest ones.
void make_lengths(const std::array<uint32_t, kSymbols>& count, uint8_t* length) {
  struct Tree {
    uint64_t weight;
    int left, right;  // -1 - symbol for leaves
  };
  std::vector<Tree> trees;
  std::vector<size_t> open;
  for (uint32_t s = 0; s < kSymbols; ++s) {
    length[s] = 0;
    if (!count[s]) continue;
    open.push_back(trees.size());
    trees.push_back({count[s], -1 - static_cast<int>(s), 0});
  }
  if (open.empty()) return;
  if (open.size() == 1) {
    length[-1 - trees[0].left] = 1;
    return;
  }
  const auto heavier = [&](size_t a, size_t b) {
    return trees[a].weight != trees[b].weight ? trees[a].weight > trees[b].weight : a > b;
  };
  while (open.size() > 1) {
    std::sort(open.begin(), open.end(), heavier);
    const size_t a = open.back(), b = open[open.size() - 2];
    open.resize(open.size() - 2);
    open.push_back(trees.size());
    trees.push_back({trees[a].weight + trees[b].weight, static_cast<int>(a), static_cast<int>(b)});
  }
  std::vector<std::pair<size_t, uint32_t>> down{{open[0], 0}};
  while (!down.empty()) {
    const auto [i, depth] = down.back();
    down.pop_back();
    if (trees[i].left < 0) {
      length[-1 - trees[i].left] = static_cast<uint8_t>(std::min(depth, kBits));
      continue;
    }
    down.push_back({static_cast<size_t>(trees[i].left), depth + 1});
    down.push_back({static_cast<size_t>(trees[i].right), depth + 1});
  }
  int room = 1 << kBits;  // in codes of the greatest length
  for (uint32_t s = 0; s < kSymbols; ++s)
    if (length[s]) room -= 1 << (kBits - length[s]);
  while (room < 0) {
    // The rarest symbol whose code can grow pays least.
    uint32_t best = kSymbols;
    for (uint32_t s = 0; s < kSymbols; ++s)
      if (length[s] && length[s] < kBits &&
          (best == kSymbols || uint64_t{count[s]} << length[s] < uint64_t{count[best]} << length[best]))
        best = s;
    room += 1 << (kBits - length[best] - 1);
    ++length[best];
  }
  for (bool grown = true; grown;) {  // hand back what is left over, to the most frequent
    grown = false;
    uint32_t best = kSymbols;
    for (uint32_t s = 0; s < kSymbols; ++s)
      if (length[s] > 1 && (1 << (kBits - length[s])) <= room && (best == kSymbols || count[s] > count[best])) best = s;
    if (best < kSymbols) room -= 1 << (kBits - length[best]), --length[best], grown = true;
  }
}

// Canonical codes of one context, first bit lowest.
void make_codes(const uint8_t* length, uint16_t* code) {
  uint32_t next = 0;
  for (uint32_t bits = 1; bits <= kBits; ++bits, next <<= 1)
    for (uint32_t s = 0; s < kSymbols; ++s)
      if (length[s] == bits) code[s] = static_cast<uint16_t>(reversed_bits(next++, bits));
}

}  // namespace

std::vector<std::byte> PrefixEncoder::finish() const {
  std::vector<std::array<uint32_t, kSymbols>> count(contexts_);
  for (const Note& n : noted_)
    if (n.context != kRaw) ++count[n.context][n.symbol];
  PrefixLengths lengths;
  lengths.of.resize(contexts_ * kSymbols);
  std::vector<uint16_t> code(contexts_ * kSymbols);
  for (size_t c = 0; c < contexts_; ++c) {
    make_lengths(count[c], &lengths.of[c * kSymbols]);
    make_codes(&lengths.of[c * kSymbols], &code[c * kSymbols]);
  }
  RangeEncoder head;
  lengths.code(head, contexts_);
  const std::vector<std::byte> first = head.finish();
  SUITE_CHECK(first.size() < 65536);
  std::vector<std::byte> out;
  out.reserve(first.size() + noted_.size());
  for (const size_t byte : {first.size() & 0xFF, first.size() >> 8}) out.push_back(static_cast<std::byte>(byte));
  out.insert(out.end(), first.begin(), first.end());
  uint64_t bits = 0;
  uint32_t used = 0;
  for (const Note& n : noted_) {
    const size_t at = size_t{n.context} * kSymbols + n.symbol;
    bits |= uint64_t{n.context == kRaw ? n.value : code[at]} << used;
    used += n.context == kRaw ? n.bits : lengths.of[at];
    for (; used >= 8; used -= 8, bits >>= 8) out.push_back(static_cast<std::byte>(bits & 0xFF));
  }
  if (used) out.push_back(static_cast<std::byte>(bits & 0xFF));
  return out;
}

}  // namespace suite::sqt
