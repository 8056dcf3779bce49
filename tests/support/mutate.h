// Seeded damage to a valid input: truncation, flipped bits, repeated and removed stretches, spliced-in hostile words.
#pragma once
#include <string>
#include <vector>

#include "math/sampling.h"

namespace suite {

// words: texts that the grammar gives meaning to, or numbers it should refuse. Same generator state, same result.
inline std::string mutated(std::string text, const std::vector<std::string>& words, Pcg32& rng) {
  const auto below = [&](size_t n) { return n ? static_cast<size_t>(rng.uniform() * static_cast<double>(n)) : 0; };
  for (size_t edits = 1 + below(4); edits > 0; --edits) {
    const size_t at = below(text.size() + 1), length = below(std::min<size_t>(text.size() - at, 40) + 1);
    switch (below(6)) {
      case 0:
        text.resize(at);
        break;
      case 1:
        if (at < text.size()) text[at] = static_cast<char>(text[at] ^ (1 << below(8)));
        break;
      case 2:
        text.erase(at, length);
        break;
      case 3:
        text.insert(at, text.substr(at, length));
        break;
      case 4:
        text.replace(at, length, words[below(words.size())]);
        break;
      default:
        text.insert(at, words[below(words.size())]);
        break;
    }
  }
  return text;
}

}  // namespace suite
