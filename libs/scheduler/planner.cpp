#include "scheduler/planner.h"

#include <algorithm>

#include "base/parallel.h"

namespace suite {

namespace {

using Clock = std::chrono::steady_clock;
double seconds_since(Clock::time_point t) { return std::chrono::duration<double>(Clock::now() - t).count(); }

// The sample points of a pilot that is thrown away are those of another capture.
constexpr uint64_t kPilotStream = 0x70696c6f74ull << 20;
constexpr double kBetweenSaves = 2;  // s

Accumulators::Shape shape_of(const CaptureWork& work) {
  return {work.capture.problems(), work.values, scrambles_for(work.goals.all.max_paths), work.truth_slots,
          work.pipeline.may_miss(work.capture)};
}

// Blocks in which some problem lacks samples.
std::vector<Block> open_blocks(const Capture& capture, const Accumulators* sums, std::span<const uint32_t> to) {
  std::vector<Block> blocks = blocks_of(capture);
  if (!sums) return blocks;
  std::erase_if(blocks, [&](const Block& b) {
    for (size_t i = 0; i < b.problems(); ++i)
      if (const size_t problem = problem_at(capture, b, i); sums->paths(problem) < to[problem]) return false;
    return true;
  });
  return blocks;
}

}  // namespace

// Saves rows of blocks as they finish, from whichever thread finishes one.
class CapturePlanner::Saver {
 public:
  Saver(const CaptureWork& work, Saving& saving, const Accumulators& sums, std::span<const Block> blocks)
      : work_(work), saving_(saving), sums_(sums) {
    for (const Block& b : blocks) {
      if (rows_.empty() || rows_.back().first != b.row) rows_.push_back({b.row, b.rows, 0});
      ++rows_.back().open;
    }
  }
  void finished(const Block& block) {
    const std::lock_guard lock(saving_.mutex);
    const auto row = std::find_if(rows_.begin(), rows_.end(), [&](const Row& r) { return r.first == block.row; });
    if (--row->open == 0) waiting_.push_back(*row);
    if (seconds_since(saving_.last) > kBetweenSaves) save();
  }
  void flush() {
    const std::lock_guard lock(saving_.mutex);
    save();
  }

 private:
  struct Row {
    uint32_t first, count;
    size_t open;
  };
  void save() {
    for (const Row& r : waiting_)
      saving_.store->save(work_.id, size_t{r.first} * work_.capture.columns, size_t{r.count} * work_.capture.columns,
                          sums_);
    waiting_.clear();
    saving_.last = Clock::now();
  }
  const CaptureWork& work_;
  Saving& saving_;
  const Accumulators& sums_;
  std::vector<Row> rows_, waiting_;
};

void shorten_pilots(Goals& goals) {
  auto shorten = [](Convergence& goal) {
    if (goal.relative_error == 0) goal.min_paths = std::min(kDefaultPilot, goal.max_paths);
  };
  shorten(goals.all);
  for (Convergence& goal : goals.own) {
    shorten(goal);
    goals.all.min_paths = std::min(goals.all.min_paths, goal.min_paths);
  }
}

std::vector<uint32_t> plan_of(const Capture& capture, const Goals& goals, std::span<const double> needs) {
  if (!needs.empty()) return paths_for(needs, goals);
  std::vector<uint32_t> paths(capture.problems());
  for (size_t i = 0; i < paths.size(); ++i) paths[i] = goals.of(i).max_paths;
  return paths;
}

CapturePlanner::CapturePlanner(CaptureWork& work, ResultBuilder& result, Saving& saving)
    : work_(work),
      result_(result),
      saving_(saving),
      target_(work.goals.all.relative_error > 0),
      alone_(target_ && !has_neighbours(work.capture)),
      piloted_(target_ || work.after_pilot),
      shape_(shape_of(work)) {
  if (!piloted_ && !saving.store) return;
  sums_ = std::make_unique<Accumulators>(shape_);
  if (saving.store) saving.store->load(work.id, *sums_, needs_);
}

CapturePlanner::~CapturePlanner() = default;

std::optional<Round> CapturePlanner::next() {
  switch (stage_) {
    case Stage::begin:
      if (piloted_ && needs_.empty()) return first();
      return rest();
    case Stage::pilot:
      decide();
      return rest();
    case Stage::rest:
      save();
      if (sums_)
        parallel_for(0, shape_.problems, 256, [&](size_t begin, size_t end) {
          for (size_t i = begin; i < end; ++i) result_.take(i, *sums_, i);
        });
      sums_.reset();
      stage_ = Stage::done;
      break;
    case Stage::done:
      break;
  }
  return std::nullopt;
}

void CapturePlanner::ran(const Round& round) {
  statistics_.merge(round.statistics);
  if (stage_ == Stage::pilot) pilot_paths_ = static_cast<double>(round.statistics.paths);
}

void CapturePlanner::save() {
  if (saver_) saver_->flush();
}

Round CapturePlanner::round(std::vector<uint32_t> to, uint64_t stream, Accumulators* sums, bool save) {
  to_ = std::move(to);
  Round r{&work_.pipeline,
          &work_.sensor,
          &work_.capture,
          stream,
          open_blocks(work_.capture, sums, to_),
          to_,
          shape_,
          sums,
          {}};
  saver_ = sums && save && saving_.store ? std::make_unique<Saver>(work_, saving_, *sums, r.blocks) : nullptr;
  r.take = [this, sums](const Block& block, const Accumulators& part) {
    for (size_t i = 0; i < block.problems(); ++i) {
      const size_t problem = problem_at(work_.capture, block, i);
      if (sums)
        sums->join_problem(problem, part, i);
      else
        result_.take(problem, part, i);
    }
    if (saver_) saver_->finished(block);
  };
  return r;
}

Round CapturePlanner::first() {
  stage_ = Stage::pilot;
  begun_ = Clock::now();
  std::vector<uint32_t> pilot(shape_.problems);
  for (size_t i = 0; i < pilot.size(); ++i) pilot[i] = work_.goals.of(i).min_paths;
  if (!alone_) return round(std::move(pilot), work_.id, sums_.get(), true);
  thrown_ = std::make_unique<Accumulators>(shape_);
  return round(std::move(pilot), work_.id + kPilotStream, thrown_.get(), false);
}

void CapturePlanner::decide() {
  save();
  if (alone_)
    needs_ = own_needs_of(*thrown_, work_.judged, work_.goals);
  else if (target_)
    needs_ = needs_of(work_.capture, *sums_, work_.judged, work_.goals);
  else
    needs_.assign(shape_.problems, 0.0);
  thrown_.reset();
  if (saving_.store) {
    const std::lock_guard lock(saving_.mutex);
    saving_.store->save_needs(work_.id, needs_);
  }
  if (work_.after_pilot) work_.after_pilot(work_, needs_, pilot_paths_, seconds_since(begun_));
}

Round CapturePlanner::rest() {
  stage_ = Stage::rest;
  return round(plan_of(work_.capture, work_.goals, piloted_ ? needs_ : std::vector<double>{}), work_.id, sums_.get(),
               true);
}

}  // namespace suite
