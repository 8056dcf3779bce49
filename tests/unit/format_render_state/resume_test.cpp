// Runs that stop and go on give the bits of runs that never stopped.
#include "formats/render_state/render_state.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "base/files.h"
#include "base/version.h"
#include "formats/hdf5/h5.h"
#include "support/grid_job.h"
#include "support/message_of.h"
#include "support/temp_folder.h"

namespace suite::test::format_render_state_resume_test {
namespace {

GridRun run_whole(StateStore* store, const Budget& budget, uint32_t paths, double target, bool lacks = false,
                  bool neighbours = true) {
  GridJob job{.paths = paths, .target = target, .lacks = lacks, .neighbours = neighbours};
  job.options.budget = budget, job.options.store = store;
  return job.run();
}
std::vector<CaptureResult> run(StateStore* store, const Budget& budget, uint32_t paths, double target,
                               bool lacks = false) {
  return run_whole(store, budget, paths, target, lacks).results;
}

std::unique_ptr<StateStore> make(const std::string& path, StateUse use, const Budget& budget = {}) {
  return make_state(path, kIdentity, {use, budget});
}

TEST(RenderState, sixty_four_and_sixty_four_is_one_hundred_and_twenty_eight) {
  const TempFolder folder;
  const std::string path = folder / "result.state.h5";
  for (const auto& [first, more] : {std::pair<uint32_t, uint32_t>{64, 64}, {30, 7}, {200, 200}, {256, 400}}) {
    run(make(path, StateUse::start).get(), {}, first, 0);
    Budget budget = read_state_head(path, kIdentity).budget;
    budget.more += more;
    const auto continued = run(make(path, StateUse::extend, budget).get(), budget, first, 0);
    expect_same(continued, run(nullptr, {}, first + more, 0));
  }
}

// What is missing and what was rejected is kept, scramble by scramble, also when a state is widened to more of them.
TEST(RenderState, what_results_lack_goes_on) {
  const TempFolder folder;
  const std::string path = folder / "result.state.h5";
  for (const auto& [first, more] : {std::pair<uint32_t, uint32_t>{64, 64}, {200, 200}}) {
    run(make(path, StateUse::start).get(), {}, first, 0, true);
    Budget budget = read_state_head(path, kIdentity).budget;
    budget.more += more;
    const auto continued = run(make(path, StateUse::extend, budget).get(), budget, first, 0, true);
    expect_same(continued, run(nullptr, {}, first + more, 0, true));
    const std::vector<uint8_t>& quality = continued[0].quality;
    EXPECT_GT(std::count_if(quality.begin(), quality.end(), [](uint8_t q) { return q & quality_unresolved; }), 100);
    EXPECT_GT(std::count_if(quality.begin(), quality.end(), [](uint8_t q) { return q & quality_failures; }), 300);
  }
}

TEST(RenderState, a_finer_target_is_planned_from_the_same_pilot) {
  const TempFolder folder;
  const std::string path = folder / "result.state.h5";
  Budget budget;
  budget.relative_error = 0.05, budget.min_paths = 32, budget.max_paths = 2000;
  const auto coarse = run(make(path, StateUse::start, budget).get(), budget, 2000, 0.05);
  budget = read_state_head(path, kIdentity).budget;
  budget.relative_error = 0.02;
  const auto fine = run(make(path, StateUse::extend, budget).get(), budget, 2000, 0.05);
  expect_same(fine, run(nullptr, budget, 2000, 0.05));
  EXPECT_NE(coarse[0].paths, fine[0].paths);
}

// Results and what is counted, also where a pilot is thrown away.
TEST(RenderState, a_run_that_died_goes_on_where_it_was) {
  for (const bool neighbours : {true, false}) {
    const GridRun whole = run_whole(nullptr, {}, 1000, 0.03, false, neighbours);
    size_t kept = 0;
    bool died = true;
    for (int saves = 0; died; ++saves) {
      const TempFolder folder;
      const std::string path = folder / "result.state.h5";
      died = false;
      try {
        const auto store = make(path, StateUse::start);
        DyingStore dying(*store, saves);
        run_whole(&dying, {}, 1000, 0.03, false, neighbours);
      } catch (const DyingStore::Death&) {
        died = true;
      }
      const GridRun again = run_whole(make(path, StateUse::resume).get(), {}, 1000, 0.03, false, neighbours);
      expect_same(again.results, whole.results);
      expect_same_counts(again.report.statistics, whole.report.statistics);
      kept += died && again.report.paths_kept > 0;
    }
    EXPECT_GE(kept, 2u) << "nothing was tested";
  }
}

TEST(RenderState, refuses_the_state_of_another_run) {
  const TempFolder folder;
  const std::string path = folder / "result.state.h5";
  run(make(path, StateUse::start).get(), {}, 8, 0);
  const StateIdentity other{{"scene", "abc"}, {"seed", "2"}};
  EXPECT_THAT(message_of([&] { read_state_head(path, other); }), testing::HasSubstr("its seed is 1, this run's is 2"));
  // Another shape: the same sensors with another number of columns would be another simulation text.
  const auto store = make(path, StateUse::resume);
  EXPECT_THAT(message_of([&] { store->begin({{4, 4, 2, 4, 1}}); }), testing::HasSubstr("another shape"));
  const auto first = make(path, StateUse::resume);
  const auto result = run(first.get(), {}, 8, 0);
  EXPECT_THAT(message_of([&] { run(make(path, StateUse::resume).get(), {}, 8, 0); }),
              testing::HasSubstr("in use by another run"));
}

TEST(RenderState, refuses_an_older_version) {
  const TempFolder folder;
  const std::string path = folder / "result.state.h5";
  {
    h5::Writer old(path, path);
    old.attribute("format", std::string("dirsig-render state"));
    old.attribute("version", std::string("1"));
    old.close();
  }
  EXPECT_THAT(message_of([&] { read_state_head(path, kIdentity); }),
              testing::HasSubstr(std::string("is of version '1', suite ") + kVersion + " reads version 6"));
}

TEST(RenderState, refuses_what_is_no_state) {
  const TempFolder folder;
  EXPECT_THAT(message_of([&] { read_state_head(folder / "missing.h5", kIdentity); }), testing::HasSubstr("missing.h5"));
  write_file(folder / "text.h5", std::string_view("not a state"));
  EXPECT_THAT(message_of([&] { read_state_head(folder / "text.h5", kIdentity); }),
              testing::HasSubstr("not an HDF5 file"));
}

}  // namespace
}  // namespace suite::test::format_render_state_resume_test
