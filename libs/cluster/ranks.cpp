#include "cluster/ranks.h"

#include <sched.h>
#include <unistd.h>

#include <algorithm>
#include <climits>

#include "base/error.h"
#include "cluster/launched.h"
#include "cluster/mpi_link.h"
#include "cluster/rank_executor.h"

namespace suite {

namespace cluster {

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
  ended_ = all.failed > INT_MIN;
  return all;
}

int Link::meet(int number) {
  const Status all = exchange({INT_MIN, number});
  if (ended_) throw EndedElsewhere();
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

}  // namespace cluster

namespace {

class MpiRanks final : public Ranks {
 public:
  MpiRanks() : link_(std::make_unique<cluster::Link>(world())), executor_(*link_) {
    char name[MPI_MAX_PROCESSOR_NAME] = {};
    int length = 0;
    MPI_Get_processor_name(name, &length);
    host_.assign(name, static_cast<size_t>(length));
  }
  int rank() const override { return link_->rank(); }
  int size() const override { return link_->size(); }
  const std::string& host() const override { return host_; }
  Executor& executor() override { return executor_; }

  std::vector<std::string> gather(const std::string& mine) override {
    link_->meet();
    const int length = static_cast<int>(mine.size());
    std::vector<int> lengths(leads() ? static_cast<size_t>(size()) : 0), begins(lengths.size());
    MPI_Gather(&length, 1, MPI_INT, lengths.data(), 1, MPI_INT, 0, link_->comm());
    for (size_t i = 1; i < begins.size(); ++i) begins[i] = begins[i - 1] + lengths[i - 1];
    std::string all(begins.empty() ? 0 : static_cast<size_t>(begins.back() + lengths.back()), ' ');
    MPI_Gatherv(mine.data(), length, MPI_CHAR, all.data(), lengths.data(), begins.data(), MPI_CHAR, 0, link_->comm());
    std::vector<std::string> texts;
    for (size_t i = 0; i < lengths.size(); ++i)
      texts.push_back(all.substr(static_cast<size_t>(begins[i]), static_cast<size_t>(lengths[i])));
    return texts;
  }
  void meet() override {
    link_->meet();
    met_ = true;
  }
  bool fail() override { return link_->fail(); }
  int conclude(int code) override {
    // Who never came so far as to run anything fails where others may have.
    if (code != 0 && !met_ && !link_->ended()) link_->fail();
    int most = 0;
    MPI_Request request;
    MPI_Iallreduce(&code, &most, 1, MPI_INT, MPI_MAX, link_->comm(), &request);
    cluster::wait_for(request);
    link_.reset();
    MPI_Finalize();
    return most;
  }

 private:
  // MPI's communicator of all ranks, of our own so that nobody else's messages are in it.
  static MPI_Comm world() {
    int provided = MPI_THREAD_SINGLE;
    MPI_Init_thread(nullptr, nullptr, MPI_THREAD_MULTIPLE, &provided);
    if (provided < MPI_THREAD_MULTIPLE)
      throw Error("this MPI cannot be called from several threads", "build with one that has MPI_THREAD_MULTIPLE");
    MPI_Comm all;
    MPI_Comm_dup(MPI_COMM_WORLD, &all);
    return all;
  }
  std::unique_ptr<cluster::Link> link_;
  cluster::RankExecutor executor_;
  std::string host_;
  bool met_ = false;
};

}  // namespace

std::unique_ptr<Ranks> join_ranks() {
  if (!launched().together) return nullptr;
  return std::make_unique<MpiRanks>();
}

}  // namespace suite
