#include "scheduler/planner.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/parallel.h"
#include "base/stopwatch.h"

namespace suite {

namespace {

// The sample points of a pilot that is thrown away are those of another capture.
constexpr uint64_t kPilotStream = 0x70696c6f74ull << 20;
constexpr double kBetweenSaves = 2;  // s

Accumulators::Shape shape_of(const CaptureWork& work) {
  return {work.capture.problems(), work.values, scrambles_for(work.goals.all.max_paths), work.truth_slots,
          work.pipeline.may_miss(work.capture)};
}

bool unknown(double need) { return std::isnan(need); }

}  // namespace

// Saves blocks as they finish, from whichever thread finishes one.
class CapturePlanner::Saver {
 public:
  Saver(const CaptureWork& work, Saving& saving, const Accumulators& sums, const BlockCounts& counts)
      : work_(work), saving_(saving), sums_(sums), counts_(counts) {}
  void finished(const Block& block) {
    const std::lock_guard lock(saving_.mutex);
    waiting_.push_back(number_of(block, work_.capture.columns));
    if (seconds_since(saving_.last) > kBetweenSaves) save();
  }
  void flush() {
    const std::lock_guard lock(saving_.mutex);
    save();
  }

 private:
  void save() {
    if (waiting_.empty()) return;
    std::sort(waiting_.begin(), waiting_.end());
    waiting_.erase(std::unique(waiting_.begin(), waiting_.end()), waiting_.end());
    saving_.store->save(work_.id, waiting_, sums_, counts_);
    waiting_.clear();
    saving_.last = Stopwatch::now();
  }
  const CaptureWork& work_;
  Saving& saving_;
  const Accumulators& sums_;
  const BlockCounts& counts_;
  std::vector<size_t> waiting_;
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
  SUITE_CHECK(work.mine.empty() || saving.store);
  if (!piloted_ && !saving.store) return;
  sums_ = std::make_unique<Accumulators>(shape_);
  if (!saving.store) return;
  counts_ = std::make_unique<BlockCounts>(work.capture.columns, work.capture.rows, shape_.scrambles);
  saving.store->load(work.id, *sums_, needs_, *counts_);
  statistics_.merge(counts_->total());
}

CapturePlanner::~CapturePlanner() = default;

// Blocks in which some problem lacks samples; of them all, or those that are run here.
std::vector<Block> CapturePlanner::open_blocks(const Accumulators* sums, std::span<const uint32_t> to,
                                               bool mine_only) const {
  std::vector<Block> blocks = blocks_of(work_.capture);
  std::erase_if(blocks, [&](const Block& b) {
    if (mine_only && !mine(number_of(b, work_.capture.columns))) return true;
    for (size_t i = 0; i < b.problems(); ++i)
      if (const size_t problem = problem_at(work_.capture, b, i); !sums || sums->paths(problem) < to[problem])
        return false;
    return true;
  });
  return blocks;
}

// Whether the pilot has told what it has to; where a problem's pilot decides about itself alone, of what is run here.
bool CapturePlanner::decided() const {
  if (needs_.empty()) return false;
  const auto open = [&](const Block& b) {
    if (alone_ && !work_.mine.empty() && !mine(number_of(b, work_.capture.columns))) return false;
    return unknown(needs_[problem_at(work_.capture, b, 0)]);
  };
  const std::vector<Block> blocks = blocks_of(work_.capture);
  return std::none_of(blocks.begin(), blocks.end(), open);
}

std::optional<Round> CapturePlanner::next() {
  switch (stage_) {
    case Stage::begin:
      if (piloted_ && !decided()) return first();
      return rest();
    case Stage::pilot:
      if (decide()) return rest();
      waits_for_pilot_ = true;
      stage_ = Stage::done;
      break;
    case Stage::rest:
      finish();
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
  Round r{&work_.pipeline, &work_.sensor, &work_.capture, stream, open_blocks(sums, to_, true), to_, shape_, sums, {}};
  saver_ = sums && save && saving_.store ? std::make_unique<Saver>(work_, saving_, *sums, *counts_) : nullptr;
  r.take = [this, sums](const Block& block, const Accumulators& part, const RunStatistics& took) {
    if (saver_)
      counts_->add(block, *sums, part, took);
    else if (counts_)
      counts_->add_pilot(block, took);
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
  begun_ = Stopwatch::now();
  std::vector<uint32_t> pilot(shape_.problems);
  for (size_t i = 0; i < pilot.size(); ++i) pilot[i] = work_.goals.of(i).min_paths;
  if (!alone_) return round(std::move(pilot), work_.id, sums_.get(), true);
  thrown_ = std::make_unique<Accumulators>(shape_);
  return round(std::move(pilot), work_.id + kPilotStream, thrown_.get(), false);
}

// From the pilot to the needs; false when others have to run parts of it.
bool CapturePlanner::decide() {
  save();
  if (!alone_ && !open_blocks(sums_.get(), to_, false).empty()) return false;
  if (alone_)
    needs_ = own_needs_of(*thrown_, work_.judged, work_.goals);
  else if (target_)
    needs_ = needs_of(work_.capture, *sums_, work_.judged, work_.goals);
  else
    needs_.assign(shape_.problems, 0.0);
  thrown_.reset();
  std::vector<size_t> known;
  for (const Block& b : blocks_of(work_.capture))
    if (const size_t number = number_of(b, work_.capture.columns); !alone_ || mine(number))
      known.push_back(number);
    else
      for (size_t i = 0; i < b.problems(); ++i) needs_[problem_at(work_.capture, b, i)] = NAN;
  if (saving_.store) {
    const std::lock_guard lock(saving_.mutex);
    saving_.store->save_needs(work_.id, known, needs_, *counts_);
  }
  if (work_.after_pilot) work_.after_pilot(work_, needs_, pilot_paths_, seconds_since(begun_));
  return true;
}

Round CapturePlanner::rest() {
  stage_ = Stage::rest;
  if (!piloted_) return round(plan_of(work_.capture, work_.goals, {}), work_.id, sums_.get(), true);
  std::vector<double> needs = needs_;
  std::replace_if(needs.begin(), needs.end(), unknown, 0.0);  // of blocks that are not run here
  return round(plan_of(work_.capture, work_.goals, needs), work_.id, sums_.get(), true);
}

// Hands over what is there, if it is all.
void CapturePlanner::finish() {
  save();
  const bool known = !piloted_ || std::none_of(needs_.begin(), needs_.end(), unknown);
  whole_ = known && (!sums_ || open_blocks(sums_.get(), to_, false).empty());
  if (sums_)
    parallel_for(0, shape_.problems, 256, [&](size_t begin, size_t end) {
      for (size_t i = begin; whole_ && i < end; ++i) result_.take(i, *sums_, i);
    });
  for (size_t i = 0; known && !whole_ && i < to_.size(); ++i) waits_for_ += to_[i] - std::min(to_[i], sums_->paths(i));
  sums_.reset();
}

}  // namespace suite
