#include "scheduler/executor.h"

#include <algorithm>
#include <atomic>

#include "base/parallel.h"

namespace suite {

std::unique_ptr<Accumulators> LocalExecutor::borrow(const Round& round) {
  Accumulators::Shape shape = round.shape;
  shape.problems = kBlockEdge * kBlockEdge;
  const std::lock_guard lock(mutex_);
  for (auto& sums : idle_)
    if (sums && sums->shape() == shape) {
      std::swap(sums, idle_.back());
      std::unique_ptr<Accumulators> found = std::move(idle_.back());
      idle_.pop_back();
      found->clear();
      return found;
    }
  return std::make_unique<Accumulators>(shape);
}

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
    std::unique_ptr<Accumulators> sums = borrow(round);
    if (round.from)
      for (size_t i = 0; i < block.problems(); ++i)
        sums->join_problem(i, *round.from, problem_at(*round.capture, block, i));
    RunStatistics mine;
    round.pipeline->run(*round.sensor, *round.capture, round.stream, block, round.to, *sums, Slots::by_place, mine);
    round.take(block, *sums, mine);
    const std::lock_guard lock(mutex_);
    round.statistics.merge(mine);
    if (progress) progress->add(static_cast<double>(mine.paths));
    idle_.push_back(std::move(sums));
  });
  idle_.clear();
  return !stopped;
}

}  // namespace suite
