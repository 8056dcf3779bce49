#include "cluster/pieces.h"

#include <algorithm>

namespace suite::cluster {

namespace {

// A piece is to take at most this share of what a thread does in a run, and so many paths at least.
constexpr double kShare = 0.25, kLeastPaths = 512;

// Scrambles of one of n pieces (2, 4, 8). The first 256 samples lie in the lower four scrambles, the next in the upper.
Scrambles scrambles_of(int piece, int n) {
  unsigned set = 0;
  for (int s = 0; s < kMostScrambles; ++s)
    if ((n == kMostScrambles ? s : s % 4 * n / 4) == piece) set |= 1u << s;
  return static_cast<Scrambles>(set);
}

struct Dear {
  Piece piece;
  double cost = 0;   // cycles, or paths where nothing is known
  double paths = 0;  // to run
};

Dear whole_of(const Round& r, uint32_t round, uint32_t block, const Costs& costs) {
  Dear d{{round, block}};
  const Block& b = r.blocks[block];
  for (size_t i = 0; i < b.problems(); ++i) {
    const size_t problem = problem_at(*r.capture, b, i);
    const uint32_t there = r.from ? r.from->paths(problem) : 0;
    d.piece.continues |= there > 0;
    d.paths += r.to[problem] - std::min(there, r.to[problem]);
  }
  d.cost = d.paths * costs.per_path(*r.capture, number_of(b, r.capture->columns));
  return d;
}

int cuts_of(const Dear& d, double most, int scrambles) {
  int n = 1;
  while (n < scrambles && d.cost / n > most && d.paths / (2 * n) >= kLeastPaths) n *= 2;
  return n;
}

}  // namespace

void Costs::note(const Capture& capture, size_t block, const RunStatistics& took) {
  std::vector<float>& known = known_[&capture];
  if (known.empty()) known.resize(blocks_of(capture).size());
  if (took.paths) known[block] = static_cast<float>(static_cast<double>(took.cycles) / static_cast<double>(took.paths));
}

double Costs::per_path(const Capture& capture, size_t block) const {
  const auto found = known_.find(&capture);
  if (found == known_.end()) return 1;
  const float cycles = found->second[block];
  return cycles > 0 ? cycles : 1;
}

void Costs::keep(std::span<const Round> rounds) {
  std::erase_if(known_, [&](const auto& k) {
    return std::none_of(rounds.begin(), rounds.end(), [&](const Round& r) { return r.capture == k.first; });
  });
}

std::vector<Piece> pieces_of(std::span<const Round> rounds, const Costs& costs, size_t threads) {
  std::vector<Dear> wholes;
  double sum = 0;
  for (uint32_t r = 0; r < rounds.size(); ++r)
    for (uint32_t b = 0; b < rounds[r].blocks.size(); ++b) {
      wholes.push_back(whole_of(rounds[r], r, b, costs));
      sum += wholes.back().cost;
    }
  const double most = kShare * sum / static_cast<double>(threads);
  std::vector<Dear> dear;
  for (const Dear& d : wholes) {
    const int n = cuts_of(d, most, rounds[d.piece.round].shape.scrambles);
    for (int i = 0; i < n; ++i) {
      dear.push_back({d.piece, d.cost / n, d.paths / n});
      dear.back().piece.of = static_cast<uint8_t>(n);
      if (n > 1) dear.back().piece.scrambles = scrambles_of(i, n);
    }
  }
  std::stable_sort(dear.begin(), dear.end(), [](const Dear& a, const Dear& b) { return a.cost > b.cost; });
  std::vector<Piece> pieces;
  for (const Dear& d : dear) pieces.push_back(d.piece);
  return pieces;
}

}  // namespace suite::cluster
