// A run in parts, joined in any order, is the run: results, counts and the state to the byte.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "support/grid_job.h"
#include "support/message_of.h"
#include "support/temp_folder.h"

namespace suite::test::format_render_state_parts_test {
namespace {

using testing::HasSubstr;

class Parts : public testing::Test {
 protected:
  std::string part_path(uint32_t part) const { return folder_ / strf("part%u.h5", part); }
  std::vector<std::string> part_paths(uint32_t parts) const {
    std::vector<std::string> paths;
    for (uint32_t p = 0; p < parts; ++p) paths.push_back(part_path(p));
    return paths;
  }
  // A part of the job, in a state of its own; with_plan: from the joined state.
  JobReport run_part(GridJob job, Share share, bool with_plan = false, const Budget& budget = {}) {
    StateSetup setup{StateUse::start, budget, StatePart{share, with_plan}};
    if (with_plan) setup.from = {joined_};
    const auto store = make_state(part_path(share.part), kIdentity, setup);
    job.options.store = store.get(), job.options.share = share, job.options.budget = budget;
    GridRun run = job.run();
    EXPECT_TRUE(run.results.empty());
    return run.report;
  }
  GridRun join(GridJob job, std::vector<std::string> paths) {
    StateSetup setup{StateUse::start, check_parts(paths, kIdentity)};
    setup.from = std::move(paths);
    const auto store = make_state(joined_, kIdentity, setup);
    job.options.store = store.get(), job.options.share = Share{0, 0}, job.options.budget = setup.budget;
    GridRun run = job.run();
    EXPECT_EQ(run.report.statistics.cycles, 0u) << "joining runs no path";
    return run;
  }
  GridRun run_whole(GridJob job, const std::string& path, const Budget& budget = {}) {
    const auto store = make_state(path, kIdentity, {StateUse::start, budget});
    job.options.store = store.get(), job.options.budget = budget;
    return job.run();
  }
  // All rounds of a job in parts, joined in an order that differs from round to round.
  GridRun run_in(const GridJob& job, uint32_t parts, const Budget& budget = {}) {
    std::vector<std::string> paths = part_paths(parts);
    for (uint32_t p = parts; p-- > 0;) run_part(job, {p, parts}, false, budget);
    std::rotate(paths.begin(), paths.begin() + parts / 2, paths.end());
    GridRun joined = join(job, paths);
    rounds_ = 1;
    if (!joined.report.captures_waiting) return joined;
    EXPECT_GT(joined.report.paths_waiting, 0);
    rounds_ = 2;
    for (uint32_t p = 0; p < parts; ++p) run_part(job, {p, parts}, true, budget);
    std::reverse(paths.begin(), paths.end());
    return join(job, paths);
  }
  const TempFolder folder_;
  const std::string joined_ = folder_ / "joined.h5", whole_ = folder_ / "whole.h5";
  int rounds_ = 0;
};

TEST_F(Parts, joined_are_the_whole) {
  struct Case {
    GridJob job;
    int rounds;
  };
  // Fixed counts, four and eight scrambles; light that is missed and samples that are rejected; a target with a pilot
  // that is kept, and with one that each problem throws away for itself.
  for (const Case& c :
       {Case{{.paths = 24}, 1}, Case{{.paths = 300}, 1}, Case{{.paths = 24, .lacks = true}, 1},
        Case{{.paths = 1000, .target = 0.03}, 2}, Case{{.paths = 1000, .target = 0.03, .neighbours = false}, 1}}) {
    const GridRun whole = run_whole(c.job, whole_);
    for (const uint32_t parts : {1u, 3u, 8u}) {
      SCOPED_TRACE(strf("%u paths, target %g, %u parts", c.job.paths, c.job.target, parts));
      const GridRun joined = run_in(c.job, parts);
      EXPECT_EQ(rounds_, parts == 1 ? 1 : c.rounds);
      EXPECT_EQ(joined.report.captures_waiting, 0u);
      expect_same(joined.results, whole.results);
      expect_same_counts(joined.report.statistics, whole.report.statistics);
      for (size_t i = 0; i < whole.report.log.size(); ++i)
        expect_same_counts(joined.report.log[i].statistics, whole.report.log[i].statistics);
      EXPECT_EQ(read_bytes(joined_), read_bytes(whole_));
    }
  }
}

TEST_F(Parts, joined_go_on_as_the_whole_does) {
  const GridJob job{.paths = 24};
  run_in(job, 3);
  run_whole(job, whole_);
  Budget more;
  more.more = 400;  // with four more scrambles
  const auto go_on = [&](const std::string& path) {
    const auto store = make_state(path, kIdentity, {StateUse::extend, more});
    GridJob again = job;
    again.options.store = store.get(), again.options.budget = more;
    return again.run();
  };
  const GridRun joined = go_on(joined_), whole = go_on(whole_);
  EXPECT_EQ(whole.results[0].paths[0], 424u);
  expect_same(joined.results, whole.results);
  expect_same_counts(joined.report.statistics, whole.report.statistics);
  EXPECT_EQ(read_bytes(joined_), read_bytes(whole_));
  // In parts again, from what was joined, with another number of them.
  more.more = 480;
  for (uint32_t p = 0; p < 2; ++p) run_part(job, {p, 2}, true, more);
  GridJob once = job;
  once.options.budget = more;
  expect_same(join(job, part_paths(2)).results, once.run().results);
}

TEST_F(Parts, that_died_go_on) {
  const GridJob job{.paths = 1000, .target = 0.03};
  const GridRun whole = run_whole(job, whole_);
  for (int saves = 0; saves < 3; ++saves)
    for (const bool with_plan : {false, true}) {
      for (uint32_t p = 0; p < 3; ++p) run_part(job, {p, 3});
      if (with_plan) {
        join(job, part_paths(3));
        for (uint32_t p = 0; p < 3; ++p) run_part(job, {p, 3}, true);
      }
      // The second part dies, and is refused until it has gone on.
      StateSetup setup{StateUse::start, {}, StatePart{{1, 3}, with_plan}};
      if (with_plan) setup.from = {joined_};
      GridJob dies = job;
      dies.options.share = Share{1, 3};
      {
        const auto store = make_state(part_path(1), kIdentity, setup);
        DyingStore dying(*store, saves);
        dies.options.store = &dying;
        try {
          dies.run();
          store->finish();
        } catch (const DyingStore::Death&) {
          EXPECT_THAT(message_of([&] { check_parts(part_paths(3), kIdentity); }),
                      HasSubstr("part 2 of 3 is not finished"));
        }
      }
      {
        const auto store = make_state(part_path(1), kIdentity, {StateUse::resume});
        dies.options.store = store.get();
        dies.run();
      }
      GridRun joined = join(job, part_paths(3));
      if (!with_plan) {
        for (uint32_t p = 0; p < 3; ++p) run_part(job, {p, 3}, true);
        joined = join(job, part_paths(3));
      }
      expect_same(joined.results, whole.results);
      expect_same_counts(joined.report.statistics, whole.report.statistics);
    }
}

TEST_F(Parts, of_different_runs_are_refused) {
  const GridJob job{.paths = 1000, .target = 0.03};
  for (uint32_t p = 0; p < 3; ++p) run_part(job, {p, 3});
  const auto refused = [&](std::vector<std::string> paths, const std::string& message, const std::string& place) {
    const std::string told = message_of([&] { check_parts(paths, kIdentity); });
    EXPECT_THAT(told, HasSubstr(message));
    EXPECT_THAT(told, HasSubstr(place));
  };
  const std::vector<std::string> all = part_paths(3);
  refused({all[0], all[2]}, "is one of 3 parts; missing: 2", "part0.h5");
  refused({all[2]}, "missing: 1, 2", "part2.h5");
  refused({all[0], all[1], all[2], all[1]}, "is part 2 of 3, and so is", "part1.h5");
  EXPECT_THAT(message_of([&] {
                check_parts(all, {{"scene", "abc"}, {"seed", "2"}});
              }),
              HasSubstr("its seed is 1, this run's is 2"));
  run_whole(job, whole_);
  refused({all[0], whole_}, "is the state of a whole run, not of a part", "whole.h5");
  join(job, all);
  run_part(job, {1, 3}, true);
  refused(all, "has run its share of the pilot only, others that of the plan", "part0.h5");
  run_part(job, {1, 2});
  refused(all, "is part 2 of 2, and ", "part1.h5");
  Budget budget;
  budget.max_paths = 900;
  run_part(job, {1, 3}, false, budget);
  refused(all, "was run with another budget", "part1.h5");
}

// Every block has one part, and parts have as many blocks as each other, also of pictures whose lines are as many
// blocks wide as there are parts.
TEST(Share, deals_every_block_once) {
  for (const uint32_t parts : {1u, 2u, 7u, 64u}) {
    std::vector<size_t> of(parts), first_column(parts);
    for (uint64_t block = 0; block < uint64_t{parts} * 100; ++block) {
      size_t takers = 0;
      for (uint32_t p = 0; p < parts; ++p)
        if (Share{p, parts}.takes(block)) ++takers, ++of[p], first_column[p] += block % parts == 0;
      EXPECT_EQ(takers, 1u);
    }
    for (const size_t n : of) EXPECT_EQ(n, 100u);
    // A share that followed the columns would have all 100 of the first one; by lot it has 100 / parts of them, within
    // five standard deviations.
    const double expected = 100.0 / parts;
    for (const size_t n : first_column) EXPECT_LE(static_cast<double>(n), expected + 5 * std::sqrt(expected));
  }
  EXPECT_FALSE((Share{0, 0}.takes(0)));
}

}  // namespace
}  // namespace suite::test::format_render_state_parts_test
