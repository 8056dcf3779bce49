#include "cluster/ranks.h"

#include "base/error.h"
#include "cluster/launched.h"
#include "cluster/mpi_link.h"
#include "cluster/rank_executor.h"

namespace suite {

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
  void share(std::vector<std::byte>& bytes) override {
    link_->meet();
    link_->broadcast(bytes);
  }
  void meet() override { link_->meet(); }
  LinkCosts measure_link() override { return cluster::measure(*link_); }
  std::string of_first_here(const std::string& mine) override {
    link_->meet();
    MPI_Comm here;
    MPI_Comm_split_type(link_->comm(), MPI_COMM_TYPE_SHARED, rank(), MPI_INFO_NULL, &here);
    int length = static_cast<int>(mine.size());
    MPI_Bcast(&length, 1, MPI_INT, 0, here);
    std::string text = mine;
    text.resize(static_cast<size_t>(length));
    MPI_Bcast(text.data(), length, MPI_CHAR, 0, here);
    MPI_Comm_free(&here);
    return text;
  }
  bool fail() override { return link_->fail(); }
  int conclude(int code) override {
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
};

}  // namespace

std::unique_ptr<Ranks> join_ranks() {
  if (!launched().together) return nullptr;
  return std::make_unique<MpiRanks>();
}

}  // namespace suite
