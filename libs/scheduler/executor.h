// Running, apart from deciding: whoever is given blocks of captures and counts returns their partial sums.
#pragma once
#include <cstddef>
#include <functional>
#include <mutex>
#include <span>
#include <vector>

#include "base/progress.h"
#include "scheduler/block_sums.h"
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
  // each block, empty = never; false when it ended the run, with what was finished taken. A block that meets a stop
  // point (base/interrupt.h) ends the run likewise. progress: may be null.
  virtual bool run(std::span<Round> rounds, const std::function<bool()>& stop, Progress* progress) = 0;

  // Several processes may run one job together, each with the loop of scheduler.h and kits of its own. One of them
  // leads: it keeps all sums, decides the rounds, delivers and stores; the others are told the rounds, and what they
  // run is taken where it leads. All of them make the same calls in the same order.
  virtual int processes() const { return 1; }
  virtual bool leads() const { return true; }
  // Replaces the bytes by those of the process that leads.
  virtual void broadcast(std::vector<std::byte>&) {}
  // Whether any process says so.
  virtual bool any(bool mine) { return mine; }
};

// The threads of this process.
class LocalExecutor final : public Executor {
 public:
  bool run(std::span<Round> rounds, const std::function<bool()>& stop, Progress* progress) override;

 private:
  std::mutex mutex_;
  BlockSums sums_;
};

// A round as the process that leads tells it to the others of a job.
struct SentRound {
  uint32_t capture = 0;  // its place among those in flight
  uint64_t stream = 0;
  Accumulators::Shape shape;
  std::vector<uint32_t> blocks;  // their numbers
  std::vector<uint32_t> to;
};
SentRound sent_round(uint32_t capture, const Round& round);
// The round as those run it who are told: nobody takes its sums there. Refers to what is told, which must outlive it.
Round round_of(const SentRound& sent, const Pipeline& pipeline, const Sensor& sensor, const Capture& capture);
// Tells the rounds that come next, or is told them; and a number.
void exchange(Executor& executor, std::vector<SentRound>& rounds, uint32_t& number);

}  // namespace suite
