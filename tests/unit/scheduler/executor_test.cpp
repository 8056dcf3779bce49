// Running apart from deciding: captures do not wait for each other, and neither the number of threads nor who runs
// which part of a block changes a bit of results or of what the log counts.
#include "scheduler/executor.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <thread>

#include "base/parallel.h"
#include "support/media_kit.h"
#include "support/same_counts.h"

namespace suite::test::executor_test {
namespace {

// Lines over a corner under sun and sky, each a capture of its own.
class Lines final : public Sensor {
 public:
  Lines(uint32_t lines, uint32_t columns, Convergence goal) {
    Task task{"lines", {}, {}};
    for (uint32_t k = 0; k < lines; ++k) {
      Capture c;
      c.columns = columns, c.rows = 1;
      c.window = {static_cast<double>(k), static_cast<double>(k)};
      c.convergence = goal;
      task.captures.push_back(c);
    }
    tasks_.push_back(std::move(task));
  }
  std::string name() const override { return "lines"; }
  std::span<const SpectralState> states() const override { return {&state_, 1}; }
  std::span<const Band> bands(size_t) const override { return bands_; }
  std::span<const Task> tasks() const override { return tasks_; }
  std::span<const std::string> truth() const override { return truth_; }
  SensorRay ray(const RayRequest& r) const override {
    if (meet) wait_for_another(r.capture);
    const double x = (static_cast<double>(r.problem) + r.u[0]) / r.capture.columns,
                 y = (r.capture.window.begin + r.u[1]) / static_cast<double>(tasks_[0].captures.size());
    return {{{0, 0, 3}, normalized(Vec3{2 * x - 1, 2 * y - 1, -1}), 0}, 1};
  }
  void accept(CaptureResult&& r) override { results.push_back(std::move(r)); }
  std::vector<CaptureResult> results;
  bool meet = false;  // the first ray waits until one of another capture is asked for, five seconds at most
  mutable std::atomic<bool> met = false;

 private:
  void wait_for_another(const Capture& capture) const {
    const Capture* none = nullptr;
    if (!first_.compare_exchange_strong(none, &capture)) {
      if (none != &capture) met = true;
      return;
    }
    for (int i = 0; i < 500 && !met; ++i) std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  mutable std::atomic<const Capture*> first_ = nullptr;
  std::vector<Band> bands_{Band::rectangular("a", 0.5, 0.02), Band::rectangular("b", 0.7, 0.02)};
  SpectralState state_ = make_state(bands_, 0.01, 0, 4);
  std::vector<Task> tasks_;
  std::vector<std::string> truth_{"material", "material_fraction", "location", "nodes"};
};

struct Ran {
  std::vector<CaptureResult> results;
  JobReport report;
  bool met = false;
};
std::shared_ptr<const Scene> corner() {
  return scene_of({quad(2, 0, 0), box({-1, -1, 0}, {0.5, 0.5, 1}, 0, true), quad(0.3, 1.5, 1)},
                  {material("grey", lambert(0.5)), material("red", lambert(0.9))});
}
// The corner in fog, out of which the lines look.
std::shared_ptr<const Scene> foggy_corner() {
  auto scene = std::make_shared<Scene>(*corner());
  scene->media = {medium(Curve::constant(0.01), Curve::constant(0.1))};
  scene->materials.push_back(boundary(0));
  scene->meshes.push_back(box({-3, -3, -1}, {3, 3, 4}, 2, true));
  scene->groups[0].placements.push_back(scene->groups[0].placements[0]);
  scene->groups[0].placements.back().target = 3;
  check_scene(*scene, "fog");
  return scene;
}

Ran run(uint32_t lines, uint32_t columns, Convergence goal, Executor* executor = nullptr, bool meet = false,
        const std::shared_ptr<const Scene>& scene = corner()) {
  SourceSpecs sources;
  sources.add(SunSpec{normalized(Vec3{0.3, 0.2, 1}), 0.005, Curve::constant(3)});
  sources.add(uniform_sky(1, false));
  JobOptions job;
  job.progress = false;
  job.pipeline.max_nodes = 3;
  job.executor = executor;
  std::vector<std::unique_ptr<Sensor>> sensors;
  auto sensor = std::make_unique<Lines>(lines, columns, goal);
  sensor->meet = meet;
  sensors.push_back(std::move(sensor));
  Ran ran;
  ran.report = run_job(scene, sources, sensors, job);
  Lines& done = static_cast<Lines&>(*sensors[0]);
  ran.results = std::move(done.results), ran.met = done.met;
  return ran;
}

void expect_same(const Ran& a, const Ran& b) {
  ASSERT_EQ(a.results.size(), b.results.size());
  const auto bytes = [](const std::vector<double>& v) {  // NaNs compare too
    return std::string(reinterpret_cast<const char*>(v.data()), v.size() * sizeof(double));
  };
  for (size_t i = 0; i < a.results.size(); ++i) {
    EXPECT_EQ(bytes(a.results[i].radiance), bytes(b.results[i].radiance));
    EXPECT_EQ(bytes(a.results[i].standard_error), bytes(b.results[i].standard_error));
    EXPECT_EQ(bytes(a.results[i].truth), bytes(b.results[i].truth));
    EXPECT_EQ(a.results[i].paths, b.results[i].paths);
    EXPECT_EQ(a.results[i].quality, b.results[i].quality);
    expect_same_counts(a.report.log[i].statistics, b.report.log[i].statistics);
  }
}

// Stands for other processes: every block is computed in parts, by scrambles, from nothing but the block's own sums,
// the last captures first.
class Elsewhere final : public Executor {
 public:
  bool run(std::span<Round> rounds, const std::function<bool()>&, Progress*) override {
    for (auto round = rounds.rbegin(); round != rounds.rend(); ++round)
      for (const Block& block : round->blocks) {
        Accumulators::Shape shape = round->shape;
        shape.problems = block.problems();
        Accumulators whole(shape);
        RunStatistics took;
        for (const Scrambles part : {0xaa, 0x11, 0x44}) {
          Accumulators sums(shape);
          for (size_t i = 0; round->from && i < block.problems(); ++i)
            sums.join_problem(i, *round->from, problem_at(*round->capture, block, i));
          Block mine = block;
          mine.scrambles = part;
          round->pipeline->run(*round->sensor, *round->capture, round->stream, mine, round->to, sums, Slots::by_place,
                               took);
          whole.join(sums);
          ++parts;
        }
        round->take(block, whole, took);
        round->statistics.merge(took);
      }
    return true;
  }
  size_t parts = 0;
};

const Convergence kFixed{20, 20, 0, 0}, kTarget{32, 600, 0.02, 0};

class Threads : public testing::Test {
 protected:
  ~Threads() override { set_threads(0); }
};

TEST_F(Threads, give_the_same_bytes_and_the_same_counts) {
  for (const Convergence& goal : {kFixed, kTarget}) {
    set_threads(1);
    const Ran one = run(12, 20, goal);
    EXPECT_GT(one.report.statistics.truncated, 0) << "nothing was tested";
    for (const int n : {2, 4}) {
      set_threads(n);
      expect_same(run(12, 20, goal), one);
    }
  }
}

// Bug: the first path of each thread asked which fog it starts in, and was told what others had asked; that was
// counted.
TEST_F(Threads, count_the_same_where_paths_start_in_fog) {
  set_threads(1);
  const Ran one = run(12, 20, kFixed, nullptr, false, foggy_corner());
  EXPECT_EQ(one.report.log[0].kernel, "general in media");
  for (const int n : {2, 4}) {
    set_threads(n);
    expect_same(run(12, 20, kFixed, nullptr, false, foggy_corner()), one);
  }
  Elsewhere elsewhere;
  expect_same(run(12, 20, kFixed, &elsewhere, false, foggy_corner()), one);
}

// Captures of one block each: two of them are at work at the same time, which one thread can never do.
TEST_F(Threads, captures_do_not_wait_for_each_other) {
  set_threads(2);
  EXPECT_TRUE(run(64, 8, kFixed, nullptr, true).met);
}

TEST_F(Threads, other_executors_give_the_same_bytes) {
  for (const Convergence& goal : {kFixed, kTarget}) {
    Elsewhere elsewhere;
    expect_same(run(5, 20, goal, &elsewhere), run(5, 20, goal));
    EXPECT_GE(elsewhere.parts, 45u);
  }
}

}  // namespace
}  // namespace suite::test::executor_test
