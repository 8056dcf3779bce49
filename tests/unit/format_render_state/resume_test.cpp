// Runs that stop and go on give the bits of runs that never stopped.
#include "formats/render_state/render_state.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "base/files.h"
#include "formats/hdf5/h5.h"
#include "support/message_of.h"
#include "support/one_state_sensor.h"
#include "support/radiometry_kit.h"
#include "support/temp_folder.h"

namespace suite::test {
namespace {

const StateIdentity kIdentity{{"scene", "abc"}, {"seed", "1"}};

// A sky over a reflecting corner, looked at by a grid of rays: some variance in every problem.
class Grid final : public OneStateSensor {
 public:
  Grid(uint32_t paths, double target)
      : OneStateSensor("grid", two_bands(), make_state(two_bands(), 0.01, 0, 4),
                       {capture(20, paths, target), capture(3, paths, target)}) {}
  SensorRay ray(const RayRequest& r) const override {
    const auto [x, y] = place_of(r);
    SensorRay ray{{{0, 0, 3}, normalized(Vec3{x / 10 - 1, y / 10 - 1, -1}), 0}, 1};
    if (!rejects) return ray;
    ray.spectral = true;
    for (float& w : r.spectral) w = r.u[2] < 0.05 ? NAN : 1;
    return ray;
  }
  void accept(CaptureResult&& r) override { results.push_back(std::move(r)); }
  std::vector<CaptureResult> results;
  bool rejects = false;  // some samples are no number

 private:
  static std::vector<Band> two_bands() {
    return {Band::rectangular("a", 0.5, 0.02), Band::rectangular("b", 0.7, 0.02)};
  }
  static Capture capture(uint32_t columns, uint32_t paths, double target) {
    Capture c;
    c.columns = columns, c.rows = 20;
    c.convergence = {target > 0 ? 32 : paths, paths, target, 0};
    return c;
  }
};

std::shared_ptr<const Scene> corner() {
  return scene_of({quad(2, 0, 0), box({-1, -1, 0}, {0.5, 0.5, 1}, 0, true)}, {material("grey", lambert(0.5))});
}

// The corner under a pane of glass, through which the sun is not found.
std::shared_ptr<const Scene> covered() {
  const ModelSpec glass{"dielectric", {}, {{"index", Curve::constant(1.5)}}, {}, nullptr};
  return scene_of({quad(2, 0, 0), box({-1, -1, 0}, {0.5, 0.5, 1}, 0, true), quad(2, 2, 1)},
                  {material("grey", lambert(0.5)), material("glass", glass)});
}

std::vector<CaptureResult> run(StateStore* store, const Budget& budget, uint32_t paths, double target,
                               bool lacks = false) {
  SourceSpecs sources;
  sources.add(uniform_sky(1, false));
  sources.add(SunSpec{normalized(Vec3{0.3, 0.2, 1}), 0.005, Curve::constant(3)});
  JobOptions options;
  options.progress = false;
  options.budget = budget;
  options.store = store;
  std::vector<std::unique_ptr<Sensor>> sensors;
  auto grid = std::make_unique<Grid>(paths, target);
  grid->rejects = lacks;
  sensors.push_back(std::move(grid));
  run_job(lacks ? covered() : corner(), sources, sensors, options);
  return std::move(static_cast<Grid&>(*sensors[0]).results);
}

void expect_same(const std::vector<CaptureResult>& a, const std::vector<CaptureResult>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].radiance, b[i].radiance);
    EXPECT_EQ(a[i].standard_error, b[i].standard_error);
    EXPECT_EQ(a[i].paths, b[i].paths);
    EXPECT_EQ(a[i].quality, b[i].quality);
    EXPECT_EQ(sha256(std::as_bytes(std::span(a[i].truth))),
              sha256(std::as_bytes(std::span(b[i].truth))));  // NaNs compare too
  }
}

TEST(RenderState, sixty_four_and_sixty_four_is_one_hundred_and_twenty_eight) {
  const TempFolder folder;
  const std::string path = folder / "result.state.h5";
  for (const auto& [first, more] : {std::pair<uint32_t, uint32_t>{64, 64}, {30, 7}, {200, 200}, {256, 400}}) {
    run(make_state(path, StateUse::start, kIdentity, {}).get(), {}, first, 0);
    Budget budget = read_state_budget(path, kIdentity);
    budget.more += more;
    const auto continued = run(make_state(path, StateUse::extend, kIdentity, budget).get(), budget, first, 0);
    expect_same(continued, run(nullptr, {}, first + more, 0));
  }
}

// What is missing and what was rejected is kept, scramble by scramble, also when a state is widened to more of them.
TEST(RenderState, what_results_lack_goes_on) {
  const TempFolder folder;
  const std::string path = folder / "result.state.h5";
  for (const auto& [first, more] : {std::pair<uint32_t, uint32_t>{64, 64}, {200, 200}}) {
    run(make_state(path, StateUse::start, kIdentity, {}).get(), {}, first, 0, true);
    Budget budget = read_state_budget(path, kIdentity);
    budget.more += more;
    const auto continued = run(make_state(path, StateUse::extend, kIdentity, budget).get(), budget, first, 0, true);
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
  const auto coarse = run(make_state(path, StateUse::start, kIdentity, budget).get(), budget, 2000, 0.05);
  budget = read_state_budget(path, kIdentity);
  budget.relative_error = 0.02;
  const auto fine = run(make_state(path, StateUse::extend, kIdentity, budget).get(), budget, 2000, 0.05);
  expect_same(fine, run(nullptr, budget, 2000, 0.05));
  EXPECT_NE(coarse[0].paths, fine[0].paths);
}

// A store that dies after some saves, as a killed program does: what was saved last stays.
class Dying final : public StateStore {
 public:
  struct Death {};
  Dying(StateStore& store, int saves) : store_(store), saves_(saves) {}
  void begin(const std::vector<CaptureShape>& shapes) override { store_.begin(shapes); }
  void load(size_t c, Accumulators& sums, std::vector<double>& needs) override { store_.load(c, sums, needs); }
  void load_paths(size_t c, std::vector<uint32_t>& paths, std::vector<double>& needs) override {
    store_.load_paths(c, paths, needs);
  }
  void save_needs(size_t c, std::span<const double> needs) override { count(), store_.save_needs(c, needs); }
  void save(size_t c, size_t first, size_t n, const Accumulators& sums) override {
    count(), store_.save(c, first, n, sums);
  }
  uint32_t cap() const override { return store_.cap(); }
  void save_cap(uint32_t paths) override { store_.save_cap(paths); }

 private:
  void count() {
    if (saves_-- == 0) throw Death{};
  }
  StateStore& store_;
  int saves_;
};

TEST(RenderState, a_run_that_died_goes_on_where_it_was) {
  const auto whole = run(nullptr, {}, 1000, 0.03);
  for (int saves = 0; saves < 12; ++saves) {
    const TempFolder folder;
    const std::string path = folder / "result.state.h5";
    {
      const auto store = make_state(path, StateUse::start, kIdentity, {});
      Dying dying(*store, saves);
      try {
        run(&dying, {}, 1000, 0.03);
      } catch (const Dying::Death&) {
      }
    }
    expect_same(run(make_state(path, StateUse::resume, kIdentity, {}).get(), {}, 1000, 0.03), whole);
  }
}

TEST(RenderState, refuses_the_state_of_another_run) {
  const TempFolder folder;
  const std::string path = folder / "result.state.h5";
  run(make_state(path, StateUse::start, kIdentity, {}).get(), {}, 8, 0);
  const StateIdentity other{{"scene", "abc"}, {"seed", "2"}};
  EXPECT_THAT(message_of([&] { read_state_budget(path, other); }),
              testing::HasSubstr("its seed is 1, this run's is 2"));
  // Another shape: the same sensors with another number of columns would be another simulation text.
  const auto store = make_state(path, StateUse::resume, kIdentity, {});
  EXPECT_THAT(message_of([&] { store->begin({{4, 4, 2, 4, 1}}); }), testing::HasSubstr("another shape"));
  const auto first = make_state(path, StateUse::resume, kIdentity, {});
  const auto result = run(first.get(), {}, 8, 0);
  EXPECT_THAT(message_of([&] { run(make_state(path, StateUse::resume, kIdentity, {}).get(), {}, 8, 0); }),
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
  EXPECT_THAT(message_of([&] { read_state_budget(path, kIdentity); }),
              testing::HasSubstr("has version '1', this program reads 4"));
}

TEST(RenderState, refuses_what_is_no_state) {
  const TempFolder folder;
  EXPECT_THAT(message_of([&] { read_state_budget(folder / "missing.h5", kIdentity); }),
              testing::HasSubstr("missing.h5"));
  write_file(folder / "text.h5", std::string_view("not a state"));
  EXPECT_THAT(message_of([&] { read_state_budget(folder / "text.h5", kIdentity); }),
              testing::HasSubstr("not an HDF5 file"));
}

}  // namespace
}  // namespace suite::test
