#include "cluster/rehearsal.h"

#include <algorithm>
#include <cmath>
#include <ctime>

#include "base/parallel.h"
#include "base/stopwatch.h"
#include "cluster/pieces.h"

namespace suite {

namespace {

// Paths of a problem of a block that is run: enough for what they cost; pilots are run whole, for plans follow from
// them.
constexpr uint32_t kMeasured = 16, kPilot = 64;

// Costs have any unit of time.
constexpr double kCyclesPerSecond = 1e9;

// Of the processor, for this thread.
double thread_seconds() {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

// That are to be run of a block.
double paths_of(const Round& round, const Block& block) {
  double paths = 0;
  for (size_t i = 0; i < block.problems(); ++i) {
    const size_t problem = problem_at(*round.capture, block, i);
    const uint32_t there = round.from ? round.from->paths(problem) : 0;
    paths += round.to[problem] - std::min(there, round.to[problem]);
  }
  return paths;
}

}  // namespace

struct Rehearsal::Costs {
  cluster::Costs known;  // as the first rank knows them
};

Rehearsal::Measured::Measured(double blocks, double most)
    : every_(static_cast<size_t>(std::max(1.0, std::floor(blocks / most)))) {}

Rehearsal::Rehearsal(int ranks, int threads, const LinkCosts& link, std::shared_ptr<Measured> measured)
    : ranks_(ranks),
      threads_(threads),
      link_(link),
      measured_(std::move(measured)),
      costs_(std::make_unique<Costs>()) {}
Rehearsal::~Rehearsal() = default;

void Rehearsal::broadcast(std::vector<std::byte>& bytes) {
  found_.gather += cluster::broadcast_seconds(static_cast<double>(bytes.size()), ranks_, link_);
}

float& Rehearsal::per_path(const Round& round, const Block& block) {
  std::vector<float>& known = measured_->per_path_[round.capture];
  known.resize(std::max(known.size(), blocks_of(*round.capture).size()));
  return known[number_of(block, round.capture->columns)];
}

// Runs a block; seconds a path of what the thread computes. The first paths are not timed: they may build or load what
// comes late.
double Rehearsal::run_timed(const Round& round, const Block& block, std::span<const uint32_t> to, Accumulators& sums) {
  std::vector<uint32_t> some(to.begin(), to.end());
  for (size_t i = 0; i < block.problems(); ++i) {
    const uint32_t there = sums.paths(i);
    uint32_t& n = some[problem_at(*round.capture, block, i)];
    n = there + (n - there) / 4;
  }
  RunStatistics first, rest;
  const auto run = [&](std::span<const uint32_t> counts, RunStatistics& took) {
    round.pipeline->run(*round.sensor, *round.capture, round.stream, block, counts, sums, Slots::by_place, took);
  };
  run(some, first);
  const double begun = thread_seconds();
  run(to, rest);
  return rest.paths ? (thread_seconds() - begun) / static_cast<double>(rest.paths) : 0;
}

// Runs the first of some blocks that follow one another, unless only its cost is wanted and is known, and hands out its
// sums as those of all of them.
void Rehearsal::measure_few(Round& round, std::span<const Block> blocks) {
  const Capture& capture = *round.capture;
  const Block& run = blocks.front();
  const std::unique_ptr<Accumulators> sums = sums_.borrow(round.shape);
  std::vector<uint32_t> to(round.to.begin(), round.to.end());
  bool pilot = false;
  for (size_t i = 0; i < run.problems(); ++i) {
    const size_t problem = problem_at(capture, run, i);
    const uint32_t from = round.from ? round.from->paths(problem) : 0;
    if (from) sums->join_problem(i, *round.from, problem);
    pilot = pilot || (!from && round.to[problem] <= kPilot);
    to[problem] = pilot ? round.to[problem] : std::min(round.to[problem], from + kMeasured);
  }
  double cost = 0;
  {
    const std::lock_guard lock(mutex_);
    cost = double{per_path(round, run)};
  }
  if (pilot || cost == 0) {
    const double measured = run_timed(round, run, to, *sums);
    if (cost == 0) cost = measured;
  }
  for (const Block& block : blocks) take_as(round, block, *sums, run.problems(), cost);
}

// Hands out the sums of a block that was run as those of another.
void Rehearsal::take_as(Round& round, const Block& block, const Accumulators& sums, size_t problems, double cost) {
  std::unique_ptr<Accumulators> shown = sums_.borrow(round.shape);
  RunStatistics took;
  for (size_t i = 0; i < block.problems(); ++i) {
    shown->join_problem(i, sums, i % problems);
    shown->set_paths(i, round.to[problem_at(*round.capture, block, i)]);
  }
  took.paths = static_cast<uint64_t>(paths_of(round, block));
  took.cycles = static_cast<uint64_t>(kCyclesPerSecond * cost * static_cast<double>(took.paths));
  round.take(block, *shown, took);
  sums_.give_back(std::move(shown));
  const std::lock_guard lock(mutex_);
  round.statistics.merge(took);
  if (float& known = per_path(round, block); known == 0) known = static_cast<float>(cost);
}

void Rehearsal::measure(Round& round, const std::function<bool()>& stop) {
  const size_t every = measured_->every(), groups = (round.blocks.size() + every - 1) / every;
  parallel_for(0, groups, 1, [&](size_t g, size_t) {
    if (stop && stop()) return;
    const size_t first = g * every;
    measure_few(round, std::span(round.blocks).subspan(first, std::min(every, round.blocks.size() - first)));
  });
}

// Plays the hand-out of pieces. paths: of each.
void Rehearsal::time(std::span<const Round> rounds, std::span<const cluster::Piece> pieces,
                     std::span<const double> paths) {
  std::vector<cluster::TimedPiece> timed;
  for (size_t i = 0; i < pieces.size(); ++i) {
    const cluster::Piece& p = pieces[i];
    const Round& round = rounds[p.round];
    const Block& block = round.blocks[p.block];
    Accumulators::Shape shape = round.shape;
    shape.problems = block.problems();
    const double bytes = static_cast<double>(shape.bytes()) / p.of;
    timed.push_back({paths[i] * double{per_path(round, block)}, bytes, p.continues != 0});
  }
  const cluster::Makespan m = cluster::makespan_of(timed, ranks_, threads_, link_);
  found_.busy += m.busy, found_.trace += m.trace;
  found_.gather +=
      m.whole - m.trace +
      cluster::broadcast_seconds(static_cast<double>(pieces.size() * sizeof(cluster::Piece)), ranks_, link_);
}

bool Rehearsal::run(std::span<Round> rounds, const std::function<bool()>& stop, Progress*) {
  const Stopwatch::time_point begun = Stopwatch::now();
  // What the problems have already changes when results are taken.
  const auto workers = static_cast<size_t>(ranks_) * static_cast<size_t>(threads_);
  const std::vector<cluster::Piece> pieces = cluster::pieces_of(rounds, costs_->known, workers);
  std::vector<double> paths;
  for (const cluster::Piece& p : pieces)
    paths.push_back(paths_of(rounds[p.round], rounds[p.round].blocks[p.block]) / p.of);
  for (Round& round : rounds) measure(round, stop);
  if (stop && stop()) return false;
  time(rounds, pieces, paths);
  for (const Round& round : rounds)
    for (const Block& block : round.blocks) {
      constexpr uint64_t many = 1 << 20;
      RunStatistics took;
      took.paths = many;
      took.cycles = static_cast<uint64_t>(kCyclesPerSecond * double{per_path(round, block)} * many);
      costs_->known.note(*round.capture, number_of(block, round.capture->columns), took);
    }
  costs_->known.keep(rounds);
  found_.here += seconds_since(begun);
  return true;
}

}  // namespace suite
