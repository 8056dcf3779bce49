#include "scheduler/executor.h"

#include <algorithm>
#include <atomic>

#include "base/interrupt.h"
#include "base/parallel.h"

namespace suite {

namespace {
// Blocks that follow one another along this order (Morton 1966) lie together: their rays meet the same parts of the
// scene, which are then in the caches, and few under a limit of memory.
uint64_t place_of(const Block& b) {
  uint64_t place = 0;
  for (uint32_t bit = 0; bit < 32; ++bit)
    place |= uint64_t{b.column / kBlockEdge >> bit & 1} << (2 * bit) | uint64_t{b.row / kBlockEdge >> bit & 1}
                                                                           << (2 * bit + 1);
  return place;
}
}  // namespace

bool LocalExecutor::run(std::span<Round> rounds, const std::function<bool()>& stop, Progress* progress) {
  struct Piece {
    Round* round;
    const Block* block;
    uint64_t place;
  };
  std::vector<Piece> pieces;
  for (Round& r : rounds) {
    const size_t first = pieces.size();
    for (const Block& b : r.blocks) pieces.push_back({&r, &b, place_of(b)});
    std::stable_sort(pieces.begin() + static_cast<long>(first), pieces.end(),
                     [](const Piece& a, const Piece& b) { return a.place < b.place; });
  }
  std::atomic<bool> stopped = false;
  const auto run_whole = [&](const Piece& piece) {
    if (stopped || (stop && stop())) {
      stopped = true;
      return;
    }
    Round& round = *piece.round;
    const Block& block = *piece.block;
    const AtWork work(round.pipeline->tracer());
    std::unique_ptr<Accumulators> sums = sums_.borrow(round.shape);
    if (round.from)
      for (size_t i = 0; i < block.problems(); ++i)
        sums->join_problem(i, *round.from, problem_at(*round.capture, block, i));
    RunStatistics mine;
    round.pipeline->run(*round.sensor, *round.capture, round.stream, block, round.to, *sums, Slots::by_place, mine);
    round.take(block, *sums, mine);
    sums_.give_back(std::move(sums));
    const std::lock_guard lock(mutex_);
    round.statistics.merge(mine);
    if (progress) progress->add(static_cast<double>(mine.paths));
  };
  // What a block has is dropped when it takes too long to its end.
  const auto run_piece = [&](const Piece& piece) {
    try {
      run_whole(piece);
    } catch (const Stopped&) {
      stopped = true;
    }
  };
  std::atomic<size_t> next = 0;  // all threads at neighbouring blocks
  const int useful = pieces.empty() ? 0 : rounds.front().pipeline->tracer().useful_threads();
  if (useful <= threads())
    parallel_for(
        0, pieces.size(), 1, [&](size_t, size_t) { run_piece(pieces[next++]); }, StopPoints::in_body);
  else
    on_threads(std::min(useful, static_cast<int>(pieces.size())), [&] {
      try {
        for (size_t piece; (piece = next++) < pieces.size();) run_piece(pieces[piece]);
      } catch (...) {
        next = pieces.size();  // for the others
        throw;
      }
    });
  sums_.clear();
  return !stopped;
}

}  // namespace suite
