#include "scheduler/capture_run.h"

#include <algorithm>
#include <chrono>
#include <mutex>

#include "base/parallel.h"
#include "estimate/plan.h"

namespace suite {

namespace {

using Clock = std::chrono::steady_clock;
double seconds_since(Clock::time_point t) { return std::chrono::duration<double>(Clock::now() - t).count(); }

// The sample points of a pilot that is thrown away are those of another capture.
constexpr uint64_t kPilotStream = 0x70696c6f74ull << 20;

// Saves rows of blocks as they finish, from whichever thread finishes one, but not more often than every few seconds:
// a save waits for the disk.
class Saver {
 public:
  Saver(const CaptureWork& work, const Accumulators& sums, std::span<const Block> blocks) : work_(work), sums_(sums) {
    if (!work.store) return;
    for (const Block& b : blocks) {
      if (rows_.empty() || rows_.back().first != b.row) rows_.push_back({b.row, b.rows, 0});
      ++rows_.back().open;
    }
  }
  void finished(const Block& block) {
    if (!work_.store) return;
    const std::lock_guard lock(mutex_);
    auto row = std::find_if(rows_.begin(), rows_.end(), [&](const Row& r) { return r.first == block.row; });
    if (--row->open == 0) waiting_.push_back(*row);
    if (seconds_since(last_) > 2) flush();
  }
  void flush() {
    for (const Row& r : waiting_)
      work_.store->save(work_.id, size_t{r.first} * work_.capture.columns, size_t{r.count} * work_.capture.columns,
                        sums_);
    waiting_.clear();
    last_ = Clock::now();
  }

 private:
  struct Row {
    uint32_t first, count;
    size_t open;
  };
  const CaptureWork& work_;
  const Accumulators& sums_;
  std::vector<Row> rows_, waiting_;
  std::mutex mutex_;
  Clock::time_point last_ = Clock::now();
};

bool stops(const CaptureWork& work) { return work.stop && work.stop(); }

// Continues all problems up to their planned counts. Returns the paths that were run.
double run_stage(const CaptureWork& work, uint64_t stream, std::span<const uint32_t> to, Accumulators& sums,
                 RunStatistics& statistics, bool save) {
  std::vector<Block> blocks = blocks_of(work.capture);
  std::erase_if(blocks, [&](const Block& b) {
    for (uint32_t r = b.row; r < b.row + b.rows; ++r)
      for (uint32_t c = b.column; c < b.column + b.columns; ++c) {
        const size_t problem = size_t{r} * work.capture.columns + c;
        if (sums.paths(problem) < to[problem]) return false;
      }
    return true;
  });
  CaptureWork kept = work;
  if (!save) kept.store = nullptr;
  Saver saver(kept, sums, blocks);
  double paths = 0;
  std::mutex mutex;
  parallel_for(0, blocks.size(), 1, [&](size_t begin, size_t end) {
    for (size_t b = begin; b < end && !stops(work); ++b) {
      RunStatistics mine;
      work.pipeline.run(work.sensor, work.capture, stream, blocks[b], to, sums, Slots::by_problem, mine);
      {
        const std::lock_guard lock(mutex);
        statistics.merge(mine);
        paths += static_cast<double>(mine.paths);
        if (work.progress) work.progress->add(static_cast<double>(mine.paths));
      }
      saver.finished(blocks[b]);
    }
  });
  saver.flush();
  if (stops(work)) throw Stopped{};
  return paths;
}

Accumulators::Shape shape_of(const CaptureWork& work, size_t problems, size_t values, size_t truth_slots) {
  return {problems, values, scrambles_for(work.goals.all.max_paths), truth_slots, work.pipeline.may_miss(work.capture)};
}

std::vector<uint32_t> pilot_of(const CaptureWork& work) {
  std::vector<uint32_t> paths(work.capture.problems());
  for (size_t i = 0; i < paths.size(); ++i) paths[i] = work.goals.of(i).min_paths;
  return paths;
}

// Runs a capture whose counts are known from the start: each block gets its sums, runs, and is done with.
void run_streamed(const CaptureWork& work, size_t values, size_t truth_slots, ResultBuilder& result,
                  RunStatistics& statistics) {
  const std::vector<Block> blocks = blocks_of(work.capture);
  const std::vector<uint32_t> to = plan_of(work.capture, work.goals, {});
  std::mutex mutex;
  std::vector<std::unique_ptr<Accumulators>> idle;
  parallel_for(0, blocks.size(), 1, [&](size_t begin, size_t end) {
    std::unique_ptr<Accumulators> sums;
    {
      const std::lock_guard lock(mutex);
      if (!idle.empty()) sums = std::move(idle.back()), idle.pop_back();
    }
    if (!sums) sums = std::make_unique<Accumulators>(shape_of(work, kBlockEdge * kBlockEdge, values, truth_slots));
    for (size_t b = begin; b < end && !stops(work); ++b) {
      const Block& block = blocks[b];
      RunStatistics mine;
      sums->clear();
      work.pipeline.run(work.sensor, work.capture, work.id, block, to, *sums, Slots::by_place, mine);
      for (uint32_t i = 0; i < block.columns * block.rows; ++i)
        result.take(problem_at(work.capture, block, i), *sums, i);
      const std::lock_guard lock(mutex);
      statistics.merge(mine);
      if (work.progress) work.progress->add(static_cast<double>(mine.paths));
    }
    const std::lock_guard lock(mutex);
    idle.push_back(std::move(sums));
  });
  if (stops(work)) throw Stopped{};
}

}  // namespace

std::vector<uint32_t> plan_of(const Capture& capture, const Goals& goals, std::span<const double> needs) {
  if (!needs.empty()) return paths_for(needs, goals);
  std::vector<uint32_t> paths(capture.problems());
  for (size_t i = 0; i < paths.size(); ++i) paths[i] = goals.of(i).max_paths;
  return paths;
}

void run_capture(CaptureWork& work, size_t values, size_t truth_slots, ResultBuilder& result,
                 RunStatistics& statistics) {
  const bool target = work.goals.all.relative_error > 0, alone = target && !has_neighbours(work.capture);
  const bool piloted = target || work.after_pilot;
  if (!piloted && !work.store) return run_streamed(work, values, truth_slots, result, statistics);

  const size_t problems = work.capture.problems();
  Accumulators sums(shape_of(work, problems, values, truth_slots));
  std::vector<double> needs;
  if (work.store) work.store->load(work.id, sums, needs);
  if (piloted && needs.empty()) {
    const Clock::time_point start = Clock::now();
    const std::vector<uint32_t> pilot = pilot_of(work);
    double paths = 0;
    if (alone) {
      Accumulators thrown(sums.shape());
      paths = run_stage(work, work.id + kPilotStream, pilot, thrown, statistics, false);
      needs = own_needs_of(thrown, work.judged, work.goals);
    } else {
      paths = run_stage(work, work.id, pilot, sums, statistics, true);
      needs = target ? needs_of(work.capture, sums, work.judged, work.goals) : std::vector<double>(problems, 0.0);
    }
    if (work.store) work.store->save_needs(work.id, needs);
    if (work.after_pilot) work.after_pilot(work, needs, paths, seconds_since(start));
  }
  run_stage(work, work.id, plan_of(work.capture, work.goals, piloted ? needs : std::vector<double>{}), sums, statistics,
            true);
  parallel_for(0, problems, 256, [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) result.take(i, sums, i);
  });
}

}  // namespace suite
