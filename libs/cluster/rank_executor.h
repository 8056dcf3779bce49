// Runs rounds on the threads of all ranks. Not a public header.
//
// Rank 0 cuts the blocks of all rounds into pieces, dearest first, and tells them; threads anywhere fetch the number of
// the next one. What comes of a piece goes to rank 0, which puts the pieces of a block together before it is taken.
// Ranks that continue what others began ask rank 0 for the sums so far.
#pragma once
#include <exception>
#include <map>
#include <mutex>
#include <string>

#include "cluster/mpi_link.h"
#include "cluster/pieces.h"
#include "scheduler/executor.h"

namespace suite::cluster {

class RankExecutor final : public Executor {
 public:
  explicit RankExecutor(Link& link) : link_(link) {}
  bool run(std::span<Round> rounds, const std::function<bool()>& stop, Progress* progress) override;
  int processes() const override { return link_.size(); }
  bool leads() const override { return link_.rank() == 0; }
  void broadcast(std::vector<std::byte>& bytes) override {
    link_.meet();
    link_.broadcast(bytes);
  }
  bool any(bool mine) override { return link_.meet(mine) != 0; }

 private:
  struct Whole {  // a block that is run in several pieces
    std::unique_ptr<Accumulators> sums;
    RunStatistics statistics;
    int missing = 0;  // pieces
  };
  void share_out();
  void work(size_t slot, const std::function<bool()>& stop);
  void run_piece(uint32_t number, size_t slot);
  void begin(const Piece& piece, uint32_t number, size_t slot, Accumulators& sums);
  void finish(const Piece& piece, const Accumulators& sums, const RunStatistics& took);
  void take(const Piece& piece, const Accumulators& sums, const RunStatistics& took);
  void serve();
  void receive(MPI_Message& message, const MPI_Status& status);
  void end_early();
  void stop_here();
  void failed();

  Link& link_;
  BlockSums sums_;
  Costs costs_;  // of rank 0
  // Of the run that is on:
  std::span<Round> rounds_;
  Progress* progress_ = nullptr;
  std::vector<Piece> pieces_;
  std::map<std::pair<uint32_t, uint32_t>, Whole> wholes_;  // by round and block
  std::mutex mutex_;
  std::exception_ptr fault_;
  bool stopped_ = false;
};

}  // namespace suite::cluster
