// Runs on several ranks (libs/cluster): one of them speaks, what they run must be the same, and all of them end when
// one fails.
#pragma once
#include <exception>
#include <functional>
#include <memory>

#include "base/mapped_file.h"
#include "cluster/ranks.h"
#include "formats/render_state/render_state.h"
#include "options.h"

namespace suite {

class Together {
 public:
  // Joins the ranks that the program was started with, if it was, and silences all but rank 0.
  Together();
  // Runs what a rank does. What it throws passes on where it is to be told; elsewhere the run ends silently.
  int run(const std::function<int()>& body);
  // The last thing that a rank does: the exit code of all of them.
  int conclude(int code);
  Ranks* ranks() const { return ranks_.get(); }  // null = alone

 private:
  std::unique_ptr<Ranks> ranks_;
  std::exception_ptr refused_;
  bool begun_ = false;
};

// Refuses options that are for one process (UsageError).
void check_ranks_usage(const Cli& cli, const RenderOptions& o);
// Refuses ranks that differ in what they were given or in what they are (Error, on rank 0). identity: of the run as a
// rank sees it.
void check_alike(Ranks& ranks, const StateIdentity& identity);
// A file that all ranks of this machine have open, for what they unpack; null where they cannot share one.
std::shared_ptr<SpillFile> spill_file(Ranks& ranks);
// The budget that rank 0 has, which may be that of a state.
void broadcast_budget(Ranks& ranks, Budget& budget);

}  // namespace suite
