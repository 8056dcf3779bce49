#include "sqt/prefix_code.h"

#include <algorithm>
#include <array>

#include "base/error.h"

namespace suite::sqt {

namespace {

constexpr uint32_t kSymbols = PrefixLengths::kSymbols, kMost = PrefixLengths::kMost;

// Lengths of a Huffman code, cut to kMost bits: too long codes are shortened and the code is made to fit again by
// lengthening the cheapest ones.
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
      length[-1 - trees[i].left] = static_cast<uint8_t>(std::min(depth, kMost));
      continue;
    }
    down.push_back({static_cast<size_t>(trees[i].left), depth + 1});
    down.push_back({static_cast<size_t>(trees[i].right), depth + 1});
  }
  int room = 1 << kMost;  // in codes of the greatest length
  for (uint32_t s = 0; s < kSymbols; ++s)
    if (length[s]) room -= 1 << (kMost - length[s]);
  while (room < 0) {
    // The rarest symbol whose code can grow pays least.
    uint32_t best = kSymbols;
    for (uint32_t s = 0; s < kSymbols; ++s)
      if (length[s] && length[s] < kMost &&
          (best == kSymbols || uint64_t{count[s]} << length[s] < uint64_t{count[best]} << length[best]))
        best = s;
    room += 1 << (kMost - length[best] - 1);
    ++length[best];
  }
  for (bool grown = true; grown;) {  // hand back what is left over, to the most frequent
    grown = false;
    uint32_t best = kSymbols;
    for (uint32_t s = 0; s < kSymbols; ++s)
      if (length[s] > 1 && (1 << (kMost - length[s])) <= room && (best == kSymbols || count[s] > count[best])) best = s;
    if (best < kSymbols) room -= 1 << (kMost - length[best]), --length[best], grown = true;
  }
}

uint32_t reversed(uint32_t code, uint32_t bits) {
  uint32_t r = 0;
  for (uint32_t b = 0; b < bits; ++b) r |= ((code >> b) & 1) << (bits - 1 - b);
  return r;
}

// Canonical codes of one context, first bit lowest.
void make_codes(const uint8_t* length, uint16_t* code) {
  uint32_t next = 0;
  for (uint32_t bits = 1; bits <= kMost; ++bits, next <<= 1)
    for (uint32_t s = 0; s < kSymbols; ++s)
      if (length[s] == bits) code[s] = static_cast<uint16_t>(reversed(next++, bits));
}

}  // namespace

template <class Coder>
void PrefixLengths::code(Coder& coder, size_t contexts) {
  of.resize(contexts * kSymbols, 0);
  // Per context how many symbols there are, then their lengths; what the symbol had in the last context that was used
  // says most about it.
  std::array<std::array<BitContext, 64>, 1> many;
  std::array<std::array<BitContext, 16>, kMost + 1> model;
  std::array<uint8_t, kSymbols> before{};
  const auto tree = [&](auto& bits, uint32_t value, uint32_t depth) {
    uint32_t node = 1;
    for (uint32_t b = depth; b-- > 0;) node = 2 * node + (coder.bit(bits[node], (value >> b) & 1) ? 1u : 0u);
    return node - (1u << depth);
  };
  for (size_t c = 0; c < contexts; ++c) {
    uint8_t* length = &of[c * kSymbols];
    uint32_t n = kSymbols;
    while (n > 0 && !length[n - 1]) --n;
    n = tree(many[0], n, 6);
    if (n > kSymbols) throw Error("SQT payload is damaged: a code with too many symbols");
    for (uint32_t s = 0; s < n; ++s) {
      length[s] = static_cast<uint8_t>(tree(model[before[s]], length[s], 4));
      if (length[s] > kMost) throw Error("SQT payload is damaged: a code that is too long");
    }
    if (n) std::copy_n(length, kSymbols, before.begin());
  }
}

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

PrefixDecoder::PrefixDecoder(std::span<const std::byte> bytes, size_t contexts) {
  if (bytes.size() < 2) throw Error("SQT payload is damaged: it ends too early");
  const size_t head = std::to_integer<size_t>(bytes[0]) + 256 * std::to_integer<size_t>(bytes[1]);
  if (head > bytes.size() - 2) throw Error("SQT payload is damaged: it ends too early");
  PrefixLengths lengths;
  RangeDecoder coder(bytes.subspan(2, head));
  lengths.code(coder, contexts);
  if (coder.overrun() > 8) throw Error("SQT payload is damaged: it ends too early");
  bits_ = BitReader(bytes.subspan(2 + head));
  // What no code leads to, in damaged files alone, reads as symbol 0.
  entries_.assign(contexts << kMost, Entry(0, kMost));
  for (size_t c = 0; c < contexts; ++c) {
    const uint8_t* length = &lengths.of[c * kSymbols];
    if (std::all_of(length, length + kSymbols, [](uint8_t l) { return l == 0; })) continue;
    uint32_t next = 0;  // as in make_codes
    uint32_t n = kSymbols;
    while (n > 0 && !length[n - 1]) --n;
    for (uint32_t b = 1; b <= kMost; ++b, next <<= 1)
      for (uint32_t s = 0; s < n; ++s) {
        if (length[s] != b) continue;
        if (next >= 1u << b) throw Error("SQT payload is damaged: lengths that make no code");
        for (uint32_t i = reversed(next, b); i <= kMask; i += 1u << b) entries_[(c << kMost) + i] = {s, b};
        ++next;
      }
  }
}

}  // namespace suite::sqt
