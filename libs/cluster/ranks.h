// The processes that mpirun (or srun, mpiexec) started together to run one job: ranks 0 to n - 1, of which rank 0
// leads.
//
// All calls but rank(), size() and host() are made by all ranks in the same order. Where a rank has failed, the others
// learn it in their next call, which throws EndedElsewhere there, so that none waits for what will never come.
#pragma once
#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "cluster/makespan.h"
#include "scheduler/executor.h"

namespace suite {

// Another rank has failed and says why.
struct EndedElsewhere {};

class Ranks {
 public:
  virtual ~Ranks() = default;
  virtual int rank() const = 0;
  virtual int size() const = 0;
  virtual const std::string& host() const = 0;
  bool leads() const { return rank() == 0; }

  // Hands the blocks of rounds out to the threads of all ranks, dearest first, and rank 0 all that comes of them.
  virtual Executor& executor() = 0;
  // The texts of all ranks, on rank 0; nothing elsewhere.
  virtual std::vector<std::string> gather(const std::string& mine) = 0;
  // The first rank's bytes, on all.
  virtual void share(std::vector<std::byte>& bytes) = 0;
  // Waits for all.
  virtual void meet() = 0;
  // What talking costs between the first two ranks; a second or so. Of use on rank 0 of two or more.
  virtual LinkCosts measure_link() = 0;
  // Of the ranks that share this machine's memory the first one's text, on all of them.
  virtual std::string of_first_here(const std::string& mine) = 0;

  // Called in place of the next call of the others: this rank has failed. Whether it is the first that did, and so the
  // one to say why. After it, and after EndedElsewhere, only conclude() may be called.
  virtual bool fail() = 0;
  // The last call, on every rank: the exit code of all, which is the largest. code: of this rank.
  virtual int conclude(int code) = 0;
};

// Joins the ranks that this process was started with; null when it was started alone, which is told by the environment
// and calls nothing of MPI. Error: started with others, but MPI was not there when the program was built, or it cannot
// be called from several threads.
std::unique_ptr<Ranks> join_ranks();

}  // namespace suite
