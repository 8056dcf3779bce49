// One rank's link to the others: the calls of MPI that more than one file needs. Not a public header.
#pragma once
#include <mpi.h>

#include <atomic>
#include <cstddef>
#include <mutex>
#include <span>
#include <vector>

#include "cluster/makespan.h"

namespace suite::cluster {

// Waits that leave the processor to others: many ranks may share one.
class Patience {
 public:
  void wait();

 private:
  int turns_ = 0;
};
void wait_for(MPI_Request& request);

class Link {
 public:
  explicit Link(MPI_Comm comm);
  ~Link();
  Link(const Link&) = delete;
  Link& operator=(const Link&) = delete;
  MPI_Comm comm() const { return comm_; }
  int rank() const { return rank_; }
  int size() const { return size_; }

  // Waits for all ranks; the largest of their numbers. EndedElsewhere: one of them has failed.
  int meet(int number = 0);
  bool fail();  // as in ranks.h
  void broadcast(std::vector<std::byte>& bytes);

  // A number on rank 0 that all ranks may fetch and change, from any thread, without rank 0 having to answer.
  int64_t fetch_and_add(int64_t more);
  void set(int64_t value);

 private:
  struct Status {
    int failed, number;  // the first rank that failed (its negative); a rank's number
  };
  Status exchange(Status mine);
  int64_t fetch(int64_t operand, MPI_Op operation);
  MPI_Comm comm_;
  MPI_Win window_ = MPI_WIN_NULL;
  int rank_ = 0, size_ = 1;
  std::mutex mutex_;  // of the window
};

// measure_link.cpp; called by all ranks.
LinkCosts measure(Link& link);

}  // namespace suite::cluster
