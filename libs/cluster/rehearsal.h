// A job played through as some number of ranks would run it, on this machine and in little time: batches, rounds,
// plans, kits and results are made as in the job itself, but of all blocks only a few are run, with few paths; the
// others are taken to cost what those beside them do. What comes out of the sensors is of no use but for its time.
#pragma once
#include <map>
#include <memory>
#include <vector>

#include "cluster/makespan.h"
#include "scheduler/executor.h"

namespace suite {

namespace cluster {
struct Piece;
}

// What one rehearsal found. Seconds of the whole job; threads are those of all ranks.
struct Rehearsed {
  double busy = 0;    // of all threads, tracing paths
  double trace = 0;   // until the last path is done, were talking free
  double gather = 0;  // more, for fetching, telling, and results on their way to the first rank
  double here = 0;    // that all of it took here
};

class Rehearsal final : public Executor {
 public:
  // What blocks cost, measured once and used for any number of ranks: seconds of one thread a path.
  class Measured {
   public:
    // blocks: of which about `most` are run for the whole job.
    explicit Measured(double blocks, double most = 384);
    size_t every() const { return every_; }

   private:
    friend class Rehearsal;
    size_t every_;                                           // one block of so many that follow one another is run
    std::map<const Capture*, std::vector<float>> per_path_;  // [block]; 0 = not known
  };
  // ranks, threads (of each): at least 1.
  Rehearsal(int ranks, int threads, const LinkCosts& link, std::shared_ptr<Measured> measured);
  ~Rehearsal() override;
  bool run(std::span<Round> rounds, const std::function<bool()>& stop, Progress* progress) override;
  int processes() const override { return ranks_; }
  void broadcast(std::vector<std::byte>& bytes) override;
  const Rehearsed& found() const { return found_; }

 private:
  struct Costs;
  void measure(Round& round, const std::function<bool()>& stop);
  double run_timed(const Round& round, const Block& block, std::span<const uint32_t> to, Accumulators& sums);
  void measure_few(Round& round, std::span<const Block> blocks);
  void take_as(Round& round, const Block& block, const Accumulators& sums, size_t problems, double cost);
  void time(std::span<const Round> rounds, std::span<const cluster::Piece> pieces, std::span<const double> paths);
  float& per_path(const Round& round, const Block& block);

  const int ranks_, threads_;
  const LinkCosts link_;
  std::shared_ptr<Measured> measured_;
  std::unique_ptr<Costs> costs_;
  BlockSums sums_;
  std::mutex mutex_;
  Rehearsed found_;
};

}  // namespace suite
