// A small job for tests of states: two pictures of a corner, of one kind of count or another.
#pragma once
#include <gtest/gtest.h>

#include "base/files.h"
#include "formats/render_state/render_state.h"
#include "support/one_state_sensor.h"
#include "support/radiometry_kit.h"
#include "support/same_counts.h"

namespace suite::test {

inline const StateIdentity kIdentity{{"scene", "abc"}, {"seed", "1"}};

// A sky over a reflecting corner, looked at by a grid of rays: some variance in every problem.
class Grid final : public OneStateSensor {
 public:
  Grid(uint32_t paths, double target, bool neighbours)
      : OneStateSensor("grid", two_bands(), make_state(two_bands(), 0.01, 0, 4),
                       {capture(20, paths, target, neighbours), capture(3, paths, target, neighbours)}) {}
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
  static Capture capture(uint32_t columns, uint32_t paths, double target, bool neighbours) {
    Capture c;
    c.neighbours = neighbours;
    c.columns = columns, c.rows = 20;
    c.convergence = {target > 0 ? 32 : paths, paths, target, 0};
    return c;
  }
};

inline std::shared_ptr<const Scene> corner() {
  return scene_of({quad(2, 0, 0), box({-1, -1, 0}, {0.5, 0.5, 1}, 0, true)}, {material("grey", lambert(0.5))});
}

// The corner under a pane of glass, through which the sun is not found unless it is asked for.
inline std::shared_ptr<const Scene> covered() {
  const ModelSpec glass{"dielectric", {}, {{"index", Curve::constant(1.5)}}, {}, nullptr};
  return scene_of({quad(2, 0, 0), box({-1, -1, 0}, {0.5, 0.5, 1}, 0, true), quad(2, 2, 1)},
                  {material("grey", lambert(0.5)), material("glass", glass)});
}

struct GridRun {
  std::vector<CaptureResult> results;
  JobReport report;
};

// options.progress is switched off.
struct GridJob {
  uint32_t paths = 8;
  double target = 0;
  bool lacks = false;      // light, and some samples are rejected
  bool neighbours = true;  // problems that lie beside each other look at neighbouring places
  JobOptions options = {};
  GridRun run() {
    SourceSpecs sources;
    sources.add(uniform_sky(1, false));
    sources.add(SunSpec{normalized(Vec3{0.3, 0.2, 1}), 0.005, Curve::constant(3)});
    options.progress = false;
    // Asked for, the sun behind the glass would be found, and nothing would be missed that goes on.
    if (lacks) options.pipeline.refracted_sources = false;
    std::vector<std::unique_ptr<Sensor>> sensors;
    auto grid = std::make_unique<Grid>(paths, target, neighbours);
    grid->rejects = lacks;
    sensors.push_back(std::move(grid));
    JobReport report = run_job(lacks ? covered() : corner(), sources, sensors, options);
    return {std::move(static_cast<Grid&>(*sensors[0]).results), std::move(report)};
  }
};

inline void expect_same(const std::vector<CaptureResult>& a, const std::vector<CaptureResult>& b) {
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

// A store that dies after some saves, as a killed program does: what was saved last stays.
class DyingStore final : public StateStore {
 public:
  struct Death {};
  DyingStore(StateStore& store, int saves) : store_(store), saves_(saves) {}
  void begin(const std::vector<CaptureShape>& shapes) override { store_.begin(shapes); }
  void load(size_t c, Accumulators& sums, std::vector<double>& needs, BlockCounts& counts) override {
    store_.load(c, sums, needs, counts);
  }
  void load_paths(size_t c, std::vector<uint32_t>& paths, std::vector<double>& needs) override {
    store_.load_paths(c, paths, needs);
  }
  void save_needs(size_t c, std::span<const size_t> blocks, std::span<const double> needs,
                  const BlockCounts& counts) override {
    count(), store_.save_needs(c, blocks, needs, counts);
  }
  void save(size_t c, std::span<const size_t> blocks, const Accumulators& sums, const BlockCounts& counts) override {
    count(), store_.save(c, blocks, sums, counts);
  }
  uint32_t cap() const override { return store_.cap(); }
  void save_cap(uint32_t paths) override { store_.save_cap(paths); }
  void finish() override { store_.finish(); }

 private:
  void count() {
    if (saves_-- == 0) throw Death{};
  }
  StateStore& store_;
  int saves_;
};

}  // namespace suite::test
