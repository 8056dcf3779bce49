// The pieces of a run: each scramble of each block once, dearest first, and none so dear that the others wait for it.
#include "cluster/pieces.h"

#include <gtest/gtest.h>

#include <map>

#include "cluster/message.h"

namespace suite::cluster::pieces_test {
namespace {

struct Job {
  Job(uint32_t columns, uint32_t rows, uint32_t paths) : to(size_t{columns} * rows, paths) {
    capture.columns = columns, capture.rows = rows;
    round.capture = &capture;
    round.blocks = blocks_of(capture);
    round.to = to;
    round.shape = {to.size(), 2, scrambles_for(paths), 3, true};
  }
  Capture capture;
  std::vector<uint32_t> to;
  Round round;
};

// Each block has each of its scrambles in one piece.
void expect_whole(std::span<const Piece> pieces, std::span<const Round> rounds) {
  std::map<std::pair<uint32_t, uint32_t>, std::pair<int, int>> seen;  // by round and block: scrambles, pieces
  for (const Piece& p : pieces) {
    auto& [scrambles, count] = seen[{p.round, p.block}];
    EXPECT_EQ(scrambles & p.scrambles, 0);
    scrambles |= p.scrambles, ++count;
  }
  size_t blocks = 0;
  for (const Round& r : rounds) blocks += r.blocks.size();
  EXPECT_EQ(seen.size(), blocks);
  for (const Piece& p : pieces) {
    EXPECT_EQ((seen[{p.round, p.block}].first), kAllScrambles);
    EXPECT_EQ((seen[{p.round, p.block}].second), p.of);
  }
}

TEST(Pieces, are_all_there_and_cut_where_threads_would_wait) {
  const Job large(80, 80, 64), small(8, 8, 4096), tiny(3, 2, 16);
  const std::vector<Round> rounds{large.round, tiny.round, small.round};
  for (const size_t threads : {1, 2, 8, 64, 1000}) {
    const std::vector<Piece> pieces = pieces_of(rounds, Costs(), threads);
    expect_whole(pieces, rounds);
    // The one dear block of 262 144 paths among 409 600 others comes first, cut into its eight scrambles from two
    // threads on; 36 paths are never cut.
    EXPECT_EQ(pieces.front().round, 2u);
    EXPECT_EQ(pieces.front().of, threads == 1 ? 2 : threads == 2 ? 4 : 8);
    EXPECT_EQ(pieces.back().round, 1u);
    EXPECT_EQ(pieces.back().of, 1);
  }
}

TEST(Pieces, are_ordered_by_what_blocks_took_before) {
  const Job job(24, 8, 4);  // too few paths to be cut
  const std::vector<Round> rounds{job.round};
  Costs costs;
  const auto took = [](uint64_t paths, uint64_t cycles) {
    RunStatistics s;
    s.paths = paths, s.cycles = cycles;
    return s;
  };
  costs.note(job.capture, 0, took(100, 1000));
  costs.note(job.capture, 1, took(10, 500));
  costs.note(job.capture, 2, took(100, 3000));
  std::vector<uint32_t> order;
  for (const Piece& p : pieces_of(rounds, costs, 1))
    if (order.empty() || order.back() != p.block) order.push_back(p.block);
  EXPECT_EQ(order, (std::vector<uint32_t>{1, 2, 0}));
  costs.keep({});
  order.clear();
  for (const Piece& p : pieces_of(rounds, costs, 1))
    if (order.empty() || order.back() != p.block) order.push_back(p.block);
  EXPECT_EQ(order, (std::vector<uint32_t>{0, 1, 2}));
}

TEST(Pieces, that_continue_know_it) {
  const Job job(16, 8, 32);
  Accumulators from(job.round.shape);
  from.set_paths(8, 16);  // in the second block
  Round round = job.round;
  round.from = &from;
  for (const Piece& p : pieces_of({&round, 1}, Costs(), 1)) EXPECT_EQ(p.continues, p.block == 1);
}

TEST(Message, brings_the_rows_of_its_scrambles_and_no_others) {
  const Accumulators::Shape shape{5, 2, 8, 3, true};
  Accumulators sums(shape);
  uint8_t value = 1;
  for (const auto& column : sums.columns())
    for (size_t i = 0; i < column.width * 40; ++i) column.data[i] = std::byte{value++};
  Head head{17, {}};
  head.statistics.paths = 4, head.statistics.truncated += 0.5;
  const Scrambles some = 0b10100010;
  const std::vector<std::byte> bytes = pack(head, sums, 4, some);
  EXPECT_EQ(head_of(bytes).piece, 17u);
  EXPECT_EQ(head_of(bytes).statistics.counts(), head.statistics.counts());
  Accumulators there(shape);
  unpack(bytes, 4, some, there);
  for (size_t c = 0; c < Accumulators::kColumns; ++c)
    for (size_t i = 0; i < 5; ++i)
      for (size_t s = 0; s < 8; ++s) {
        const size_t width = sums.columns()[c].width, at = (i * 8 + s) * width;
        const bool came = i < 4 && (some >> s & 1);
        for (size_t b = 0; b < width; ++b)
          EXPECT_EQ(there.columns()[c].data[at + b], came ? sums.columns()[c].data[at + b] : std::byte{});
      }
}

}  // namespace
}  // namespace suite::cluster::pieces_test
