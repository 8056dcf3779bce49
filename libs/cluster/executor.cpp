#include "cluster/rank_executor.h"

#include <climits>
#include <cstring>
#include <thread>
#include <utility>

#include "base/error.h"
#include "base/interrupt.h"
#include "base/parallel.h"
#include "cluster/message.h"

namespace suite::cluster {

namespace {

enum Tag : int { kResult = 1, kDone, kAsk, kAnswer };  // answers: kAnswer + the slot that asked
constexpr int64_t kNoMore = int64_t{1} << 60;          // added to by fetching on

int count_of(const std::vector<std::byte>& bytes) {
  SUITE_CHECK(bytes.size() <= INT_MAX);
  return static_cast<int>(bytes.size());
}

void send(const Link& link, int to, int tag, const std::vector<std::byte>& bytes) {
  MPI_Request request;
  MPI_Isend(bytes.data(), count_of(bytes), MPI_BYTE, to, tag, link.comm(), &request);
  wait_for(request);
}

Block block_of(std::span<const Round> rounds, const Piece& piece) {
  Block block = rounds[piece.round].blocks[piece.block];
  block.scrambles = piece.scrambles;
  return block;
}

}  // namespace

// Rank 0 decides; the number that is fetched stands at 0 before anybody can.
void RankExecutor::share_out() {
  std::vector<std::byte> bytes;
  if (leads()) {
    link_.set(0);
    pieces_ = pieces_of(rounds_, costs_, static_cast<size_t>(processes()) * static_cast<size_t>(threads()));
    costs_.keep(rounds_);
    const auto all = std::as_bytes(std::span<const Piece>(pieces_));
    bytes.assign(all.begin(), all.end());
  }
  broadcast(bytes);
  pieces_.resize(bytes.size() / sizeof(Piece));
  if (!leads()) std::copy(bytes.begin(), bytes.end(), std::as_writable_bytes(std::span(pieces_)).begin());
}

bool RankExecutor::run(std::span<Round> rounds, const std::function<bool()>& stop, Progress* progress) {
  rounds_ = rounds, progress_ = progress, stopped_ = false, fault_ = nullptr;
  share_out();
  std::thread server;
  if (leads()) server = std::thread([this] { serve(); });
  const auto workers = static_cast<size_t>(threads());
  parallel_for(
      0, workers, 1, [&](size_t slot, size_t) { work(slot, stop); }, StopPoints::in_body);
  if (leads())
    server.join();
  else
    send(link_, 0, kDone, {});
  wholes_.clear();
  sums_.clear();
  if (fault_) std::rethrow_exception(std::exchange(fault_, nullptr));
  return !any(stopped_);
}

// No piece is handed out any more.
void RankExecutor::end_early() { link_.set(kNoMore); }

void RankExecutor::failed() {
  {
    const std::lock_guard lock(mutex_);
    if (!fault_) fault_ = std::current_exception();
  }
  end_early();
}

void RankExecutor::work(size_t slot, const std::function<bool()>& stop) {
  try {
    for (;;) {
      if (stop && stop()) return stop_here();
      const int64_t next = link_.fetch_and_add(1);
      if (next >= static_cast<int64_t>(pieces_.size())) return;
      run_piece(static_cast<uint32_t>(next), slot);
    }
  } catch (const Stopped&) {
    stop_here();
  } catch (...) {
    failed();
  }
}

void RankExecutor::stop_here() {
  {
    const std::lock_guard lock(mutex_);
    stopped_ = true;
  }
  end_early();
}

void RankExecutor::run_piece(uint32_t number, size_t slot) {
  const Piece& piece = pieces_[number];
  const Round& round = rounds_[piece.round];
  const Block block = block_of(rounds_, piece);
  std::unique_ptr<Accumulators> sums = sums_.borrow(round.shape);
  if (piece.continues) begin(piece, number, slot, *sums);
  RunStatistics took;
  round.pipeline->run(*round.sensor, *round.capture, round.stream, block, round.to, *sums, Slots::by_place, took);
  if (leads())
    finish(piece, *sums, took);
  else
    send(link_, 0, kResult, pack({number, took}, *sums, block.problems(), block.scrambles));
  sums_.give_back(std::move(sums));
}

// What the problems have already: it stands on rank 0.
void RankExecutor::begin(const Piece& piece, uint32_t number, size_t slot, Accumulators& sums) {
  const Round& round = rounds_[piece.round];
  const Block block = block_of(rounds_, piece);
  if (leads()) {
    for (size_t i = 0; i < block.problems(); ++i)
      sums.join_problem(i, *round.from, problem_at(*round.capture, block, i));
    return;
  }
  const uint32_t asked[2] = {number, static_cast<uint32_t>(slot)};
  MPI_Send(asked, 2, MPI_UINT32_T, 0, kAsk, link_.comm());
  std::vector<std::byte> bytes(pack({}, sums, block.problems(), block.scrambles).size());
  MPI_Request request;
  MPI_Irecv(bytes.data(), count_of(bytes), MPI_BYTE, 0, kAnswer + static_cast<int>(slot), link_.comm(), &request);
  wait_for(request);
  unpack(bytes, block.problems(), block.scrambles, sums);
}

// On rank 0: a piece is done, here or elsewhere.
void RankExecutor::finish(const Piece& piece, const Accumulators& sums, const RunStatistics& took) {
  if (progress_) progress_->add(static_cast<double>(took.paths));
  if (piece.of == 1) return take(piece, sums, took);
  Whole whole;
  {
    const std::lock_guard lock(mutex_);
    const auto [at, fresh] = wholes_.try_emplace({piece.round, piece.block});
    if (fresh) at->second = {sums_.borrow(rounds_[piece.round].shape), {}, piece.of};
    at->second.sums->join(sums);
    at->second.statistics.merge(took);
    if (--at->second.missing > 0) return;
    whole = std::move(at->second);
    wholes_.erase(at);
  }
  take(piece, *whole.sums, whole.statistics);
  sums_.give_back(std::move(whole.sums));
}

void RankExecutor::take(const Piece& piece, const Accumulators& sums, const RunStatistics& took) {
  Round& round = rounds_[piece.round];
  const Block& block = round.blocks[piece.block];
  round.take(block, sums, took);
  const std::lock_guard lock(mutex_);
  round.statistics.merge(took);
  costs_.note(*round.capture, number_of(block, round.capture->columns), took);
}

// On rank 0, beside the threads that work: takes what comes until all ranks are done. It goes on after a failure, so
// that nobody waits in vain.
void RankExecutor::serve() {
  Patience patience;
  for (int busy = processes() - 1; busy > 0;) {
    int there = 0;
    MPI_Message message;
    MPI_Status status;
    MPI_Improbe(MPI_ANY_SOURCE, MPI_ANY_TAG, link_.comm(), &there, &message, &status);
    if (!there) {
      patience.wait();
      continue;
    }
    patience = {};
    busy -= status.MPI_TAG == kDone;
    receive(message, status);
  }
}

void RankExecutor::receive(MPI_Message& message, const MPI_Status& status) {
  int count = 0;
  MPI_Get_count(&status, MPI_BYTE, &count);
  std::vector<std::byte> bytes(static_cast<size_t>(count));
  MPI_Mrecv(bytes.data(), count, MPI_BYTE, &message, MPI_STATUS_IGNORE);
  if (status.MPI_TAG == kDone) return;
  try {
    if (status.MPI_TAG == kAsk) {
      uint32_t asked[2];
      std::memcpy(asked, bytes.data(), sizeof asked);
      const Piece& piece = pieces_[asked[0]];
      const Block block = block_of(rounds_, piece);
      std::unique_ptr<Accumulators> sums = sums_.borrow(rounds_[piece.round].shape);
      begin(piece, asked[0], 0, *sums);
      send(link_, status.MPI_SOURCE, kAnswer + static_cast<int>(asked[1]),
           pack({}, *sums, block.problems(), block.scrambles));
      return sums_.give_back(std::move(sums));
    }
    const Head head = head_of(bytes);
    const Piece& piece = pieces_[head.piece];
    const Block block = block_of(rounds_, piece);
    std::unique_ptr<Accumulators> sums = sums_.borrow(rounds_[piece.round].shape);
    unpack(bytes, block.problems(), block.scrambles, *sums);
    finish(piece, *sums, head.statistics);
    sums_.give_back(std::move(sums));
  } catch (...) {
    failed();
  }
}

}  // namespace suite::cluster
