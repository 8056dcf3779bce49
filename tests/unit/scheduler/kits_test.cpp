// Optics and lights by value: shared where values are equal, given up by age where room is short, few tables for many
// states.
#include "scheduler/kits.h"

#include <gtest/gtest.h>

#include "bench/memory.h"
#include "motion/track.h"
#include "scheduler/items.h"
#include "support/radiometry_kit.h"

namespace suite::test::kits_test {
namespace {

using Kind = KitCache::Kind;

TEST(KitCache, the_least_recently_used_goes_and_what_is_in_use_stays) {
  if (heap_in_use() == 0) GTEST_SKIP() << "the allocator does not tell";
  constexpr size_t large = size_t{1} << 20;
  KitCache cache(5 * large / 2);
  int made = 0;
  const auto get = [&](size_t state) {
    return cache.get<std::vector<char>>({Kind::optics, state}, [&] {
      ++made;
      return std::make_shared<const std::vector<char>>(large);
    });
  };
  const auto used = get(0);
  for (const size_t state : {1, 0, 2}) get(state);  // 1 goes
  EXPECT_EQ(made, 3);
  EXPECT_EQ(cache.held(Kind::optics), 2u);
  EXPECT_TRUE(cache.has({Kind::optics, 0}) && cache.has({Kind::optics, 2}));
  EXPECT_NEAR(cache.bytes() / large, 2, 0.01);
  for (const size_t state : {2, 3}) get(state);  // 0 is the oldest, but in use: 2 goes
  EXPECT_TRUE(cache.has({Kind::optics, 0}) && cache.has({Kind::optics, 3}));
  EXPECT_EQ(get(0), used);
  EXPECT_EQ(made, 4);
  get(2);
  EXPECT_EQ(made, 5) << "what went is made anew";
  cache.drop(0), cache.drop(2), cache.drop(3);
  EXPECT_EQ(cache.bytes(), 0);
  EXPECT_EQ(used->size(), large) << "and those who use it keep it";
}

TEST(StateNumbers, are_those_of_the_values) {
  const std::vector<Band> bands = one_band();
  const SpectralState a = make_state(bands, 0.002);
  StateNumbers numbers;
  EXPECT_EQ(numbers.of(a), numbers.of(make_state(bands, 0.002)));
  SpectralState b = a, c = a, d = a, e = a;
  b.bins[1].g = 1;
  c.bins[1].weight = 0.5;
  d.knots = {a.knots[0]};
  e.bins[0].low_um += 1e-12;
  for (const SpectralState& other : {b, c, d, e}) EXPECT_NE(numbers.of(a), numbers.of(other));
  SpectralState f = a;
  f.shares.assign(a.size(), 1.0 / static_cast<double>(a.size()));
  EXPECT_EQ(numbers.of(a), numbers.of(f)) << "what bands make of the bins is no matter of optics";
}

// A sensor that looks down once in each of many narrow bands, in two windows.
class Sweep final : public Sensor {
 public:
  explicit Sweep(size_t states) {
    Task task{"sweep", {}, {}};
    for (size_t i = 0; i < states; ++i) {
      bands_.push_back({Band::rectangular("b", 0.4 + 0.001 * static_cast<double>(i), 0.001)});
      states_.push_back(make_state(bands_.back(), 1e-5, 0, 4));  // 100 bins
    }
    for (const double t : {0.0, 1.0})
      for (size_t i = 0; i < states; ++i) {
        Capture c;
        c.state = i;
        c.columns = c.rows = 1;
        c.window = {t, t};
        c.convergence.min_paths = c.convergence.max_paths = 4;
        task.captures.push_back(c);
      }
    tasks_.push_back(std::move(task));
  }
  std::string name() const override { return "sweep"; }
  std::span<const SpectralState> states() const override { return states_; }
  std::span<const Band> bands(size_t state) const override { return bands_[state]; }
  std::span<const Task> tasks() const override { return tasks_; }
  SensorRay ray(const RayRequest& r) const override {
    return {{{0.1, 0.1, 5}, normalized(Vec3{0.02, 0.01, -1}), r.capture.window.begin}, 1};
  }
  void accept(CaptureResult&& r) override {
    radiance.push_back(r.radiance[0]);
    heap.push_back(heap_in_use());
    resident.push_back(bench::memory("VmRSS:"));
  }
  std::vector<double> radiance, heap, resident;

 private:
  std::vector<std::vector<Band>> bands_;
  std::vector<SpectralState> states_;
  std::vector<Task> tasks_;
};

// Thirty materials, glass whose index changes with wavelength among them.
std::shared_ptr<const Scene> many_materials() {
  std::vector<Mesh> meshes;
  std::vector<Material> materials;
  for (uint32_t i = 0; i < 30; ++i) {
    meshes.push_back(quad(1 + 0.1 * i, -0.1 * i, i));
    ModelSpec spec = lambert(0.5);
    if (i % 3 == 0)
      spec = {"ggx_dielectric",
              {{"roughness", 0.3}},
              {{"index", Curve({0.3, 1.0}, {1.55, 1.5}, Outside::hold)}},
              {},
              nullptr};
    materials.push_back(material("m" + std::to_string(i), spec));
  }
  auto scene = scene_of(std::move(meshes), std::move(materials));
  // Something moves, so that all states are asked for in one window, then all of them in the other.
  scene->tracks.push_back({"circle", circle_track({{0, 0, -50}, 4, 25, 0, 0, 0, false})});
  scene->groups[0].placements.back().track = 0;
  check_scene(*scene, "many materials");
  return scene;
}

struct Swept {
  std::vector<double> radiance, heap, resident;
  JobReport report;
};
Swept sweep(size_t states, size_t kit_bytes) {
  SourceSpecs sources;
  sources.add(uniform_sky(1, false));
  JobOptions job;
  job.progress = false;
  job.kit_bytes = kit_bytes;
  std::vector<std::unique_ptr<Sensor>> sensors;
  sensors.push_back(std::make_unique<Sweep>(states));
  Swept s;
  s.report = run_job(many_materials(), sources, sensors, job);
  const Sweep& sensor = static_cast<const Sweep&>(*sensors[0]);
  s.radiance = sensor.radiance, s.heap = sensor.heap, s.resident = sensor.resident;
  return s;
}

TEST(Kits, memory_of_300_states_stays_flat_after_the_budget) {
  if (heap_in_use() == 0) GTEST_SKIP() << "the allocator does not tell";
  constexpr size_t states = 300, budget = size_t{4} << 20;
  sweep(states, SIZE_MAX);  // tables that all states share are there from now on
  const Swept kept = sweep(states, SIZE_MAX), flat = sweep(states, budget);
  const auto grown = [](const std::vector<double>& v, size_t from, size_t to) { return (v[to] - v[from]) / 1e6; };
  std::printf("heap from capture 100 to 300: %.2f MB with room for all, %.2f MB with room for 4 MiB\n",
              grown(kept.heap, 100, 299), grown(flat.heap, 100, 299));
  std::printf("resident set from capture 100 to 600: %.2f MB with room for 4 MiB, %.1f MB in all\n",
              grown(flat.resident, 100, 599), flat.resident[599] / 1e6);
  EXPECT_GT(grown(kept.heap, 100, 299), 10) << "nothing was tested";
  EXPECT_LT(grown(flat.heap, 100, 299), 1);
  EXPECT_LT(grown(flat.heap, 100, 599), 1);
  EXPECT_LT(grown(flat.resident, 100, 599), 10) << "fragments";
  EXPECT_EQ(kept.report.optics_bakes, states);
  EXPECT_GT(flat.report.optics_bakes, 3 * states / 2) << "the price of a budget that holds few of them";
  EXPECT_EQ(kept.radiance, flat.radiance);
}

}  // namespace
}  // namespace suite::test::kits_test
