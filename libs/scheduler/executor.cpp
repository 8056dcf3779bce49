#include "scheduler/executor.h"

#include <algorithm>
#include <atomic>

#include "base/parallel.h"

namespace suite {

bool LocalExecutor::run(std::span<Round> rounds, const std::function<bool()>& stop, Progress* progress) {
  struct Piece {
    Round* round;
    const Block* block;
  };
  std::vector<Piece> pieces;
  for (Round& r : rounds)
    for (const Block& b : r.blocks) pieces.push_back({&r, &b});
  std::atomic<bool> stopped = false;
  parallel_for(0, pieces.size(), 1, [&](size_t piece, size_t) {
    if (stopped || (stop && stop())) {
      stopped = true;
      return;
    }
    Round& round = *pieces[piece].round;
    const Block& block = *pieces[piece].block;
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
  });
  sums_.clear();
  return !stopped;
}

}  // namespace suite
