// Running, apart from deciding: whoever is given blocks of captures and counts returns their partial sums.
#pragma once
#include <functional>
#include <memory>
#include <mutex>
#include <span>
#include <vector>

#include "base/progress.h"
#include "transport/pipeline.h"

namespace suite {

// Blocks of one capture that are to be continued to given counts. What is referred to must outlive the run.
struct Round {
  const Pipeline* pipeline = nullptr;
  const Sensor* sensor = nullptr;
  const Capture* capture = nullptr;
  uint64_t stream = 0;  // which capture the sample points are those of
  std::vector<Block> blocks;
  std::span<const uint32_t> to;        // [problem] samples
  Accumulators::Shape shape;           // of the capture's sums
  const Accumulators* from = nullptr;  // what the problems have already; null = nothing
  // Takes the partial sums of a block, which stand by place and may not be kept, and what they took beyond `from`, from
  // whichever thread has them. Distinct blocks may come at the same time; parts of one block one after the other.
  std::function<void(const Block&, const Accumulators&, const RunStatistics&)> take;
  RunStatistics statistics = {};  // of what was run
};

class Executor {
 public:
  virtual ~Executor() = default;
  // Runs all blocks of all rounds, whichever capture they belong to, so that none waits for another. stop: asked before
  // each block, empty = never; false when it ended the run, with what was finished taken. progress: may be null.
  virtual bool run(std::span<Round> rounds, const std::function<bool()>& stop, Progress* progress) = 0;
};

// The threads of this process.
class LocalExecutor final : public Executor {
 public:
  bool run(std::span<Round> rounds, const std::function<bool()>& stop, Progress* progress) override;

 private:
  std::unique_ptr<Accumulators> borrow(const Round& round);
  std::mutex mutex_;
  std::vector<std::unique_ptr<Accumulators>> idle_;  // of a block; as many as threads have been at work at once
};

}  // namespace suite
