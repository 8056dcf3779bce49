#include <sched.h>
#include <unistd.h>

#include <algorithm>
#include <climits>

#include "cluster/mpi_link.h"
#include "cluster/ranks.h"

namespace suite::cluster {

void Patience::wait() {
  constexpr int kEager = 200;  // turns, some 50 us
  constexpr useconds_t kNap = 100, kLongest = 1000;
  if (++turns_ < kEager)
    sched_yield();
  else
    usleep(std::min(kLongest, kNap + static_cast<useconds_t>(turns_ - kEager)));
}

void wait_for(MPI_Request& request) {
  Patience patience;
  for (int done = 0; MPI_Test(&request, &done, MPI_STATUS_IGNORE), !done;) patience.wait();
}

Link::Link(MPI_Comm comm) : comm_(comm) {
  MPI_Comm_rank(comm_, &rank_);
  MPI_Comm_size(comm_, &size_);
  void* base = nullptr;
  const MPI_Aint bytes = rank_ == 0 ? sizeof(int64_t) : 0;
  MPI_Win_allocate(bytes, sizeof(int64_t), MPI_INFO_NULL, comm_, &base, &window_);
  MPI_Win_lock_all(MPI_MODE_NOCHECK, window_);
}

Link::~Link() {
  MPI_Win_unlock_all(window_);
  MPI_Win_free(&window_);
  MPI_Comm_free(&comm_);
}

Link::Status Link::exchange(Status mine) {
  Status all{};
  MPI_Request request;
  MPI_Iallreduce(&mine, &all, 2, MPI_INT, MPI_MAX, comm_, &request);
  wait_for(request);
  return all;
}

int Link::meet(int number) {
  const Status all = exchange({INT_MIN, number});
  if (all.failed > INT_MIN) throw EndedElsewhere();
  return all.number;
}

bool Link::fail() { return exchange({-rank_, INT_MIN}).failed == -rank_; }

void Link::broadcast(std::vector<std::byte>& bytes) {
  constexpr size_t kAtOnce = size_t{1} << 30;
  uint64_t size = bytes.size();
  MPI_Request request;
  MPI_Ibcast(&size, 1, MPI_UINT64_T, 0, comm_, &request);
  wait_for(request);
  bytes.resize(size);
  for (size_t at = 0; at < size; at += kAtOnce) {
    MPI_Ibcast(&bytes[at], static_cast<int>(std::min(kAtOnce, size - at)), MPI_BYTE, 0, comm_, &request);
    wait_for(request);
  }
}

int64_t Link::fetch(int64_t operand, MPI_Op operation) {
  const std::lock_guard lock(mutex_);
  int64_t before = 0;
  MPI_Fetch_and_op(&operand, &before, MPI_INT64_T, 0, 0, operation, window_);
  MPI_Win_flush(0, window_);
  return before;
}

int64_t Link::fetch_and_add(int64_t more) { return fetch(more, MPI_SUM); }
void Link::set(int64_t value) { fetch(value, MPI_REPLACE); }

}  // namespace suite::cluster
