// Sums of blocks, which go from block to block: as many as threads have been at work at once.
#pragma once
#include <memory>
#include <mutex>
#include <vector>

#include "estimate/accumulators.h"
#include "estimate/block.h"

namespace suite {

class BlockSums {
 public:
  // Empty ones of a block of a capture whose sums have this shape.
  std::unique_ptr<Accumulators> borrow(Accumulators::Shape shape) {
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
  void give_back(std::unique_ptr<Accumulators> sums) {
    const std::lock_guard lock(mutex_);
    idle_.push_back(std::move(sums));
  }
  void clear() { idle_.clear(); }

 private:
  std::mutex mutex_;
  std::vector<std::unique_ptr<Accumulators>> idle_;
};

}  // namespace suite
