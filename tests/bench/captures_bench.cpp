// A long job: does a capture cost more memory or time the later it comes? 200 captures of a terrain, at rest and with
// something that moves in every window (a tracer of its own for each), with a lamp-free sun and sky. Over captures 50
// to 200 straight lines are fitted to the heap in use and to the CPU seconds of a capture. Usage: captures_bench
// [captures]. Exit code 1 when the memory grows by more than 0.02 % of its mean a capture, or the seconds do, by more
// than their own noise lets doubt (three standard errors of the slope).
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "base/memory.h"
#include "motion/track.h"
#include "support/cpu_clock.h"
#include "tests/bench/terrain.h"

namespace suite {
namespace {

// Frames of 48 x 48 pixels, one every second.
class Frames final : public Sensor {
 public:
  explicit Frames(int count) : bands_({Band::rectangular("b", 0.55, 0.01)}), state_(make_state(bands_, 0.01, 0, 4)) {
    Task task{"frames", {0, static_cast<double>(count)}, {}};
    for (int k = 0; k < count; ++k) {
      Capture c;
      c.name = strf("frame%d", k);
      c.columns = c.rows = 48;
      c.window = {static_cast<double>(k), k + 0.01};
      c.convergence.min_paths = c.convergence.max_paths = 16;
      task.captures.push_back(c);
    }
    tasks_.push_back(task);
  }
  std::string name() const override { return "frames"; }
  std::span<const SpectralState> states() const override { return {&state_, 1}; }
  std::span<const Band> bands(size_t) const override { return bands_; }
  std::span<const Task> tasks() const override { return tasks_; }
  SensorRay ray(const RayRequest& r) const override {
    const double x = (static_cast<double>(r.problem % 48) + r.u[0]) / 48 - 0.5,
                 y = (static_cast<double>(r.problem / 48) + r.u[1]) / 48 - 0.5;
    return {
        {{0, -600, 500}, normalized(Vec3{x, 0.77 + 0.6 * y, -0.64 + 0.77 * y}), r.capture.window.begin + 0.01 * r.u[2]},
        1};
  }
  void accept(CaptureResult&&) override {
    const double now = test::cpu_seconds();
    seconds.push_back(now - last_);
    last_ = now;
    heap.push_back(heap_in_use());
  }
  std::vector<double> seconds, heap;

 private:
  std::vector<Band> bands_;
  SpectralState state_;
  std::vector<Task> tasks_;
  double last_ = test::cpu_seconds();
};

struct Line {
  double slope, error;  // shares of the mean, a capture
};
Line fit(const std::vector<double>& v, size_t from) {
  double n = 0, x1 = 0, y1 = 0, xx = 0, xy = 0;
  for (size_t i = from; i < v.size(); ++i) n += 1, x1 += static_cast<double>(i), y1 += v[i];
  const double x0 = x1 / n, y0 = y1 / n;
  for (size_t i = from; i < v.size(); ++i) {
    const double x = static_cast<double>(i) - x0;
    xx += x * x, xy += x * (v[i] - y0);
  }
  const double slope = xy / xx;
  double rest = 0;
  for (size_t i = from; i < v.size(); ++i) {
    const double r = v[i] - y0 - slope * (static_cast<double>(i) - x0);
    rest += r * r;
  }
  return {slope / y0, std::sqrt(rest / (n - 2) / xx) / y0};
}

bool run(const char* name, int captures, bool moves) {
  const std::shared_ptr<Scene> scene = bench::terrain_scene(200);
  if (moves) {
    scene->primitives.push_back({"ball", PrimitiveKind::sphere, {30}, 0});
    scene->tracks.push_back({"circle", circle_track({{0, 0, 150}, 40, 25, 0, 0, 0, false})});
    Placement p;
    p.kind = TargetKind::primitive;
    p.target = static_cast<uint32_t>(scene->primitives.size() - 1);
    p.track = 0;
    scene->groups[0].placements.push_back(p);
    check_scene(*scene, "terrain");
  }
  JobOptions options;
  options.progress = false;
  std::vector<std::unique_ptr<Sensor>> sensors;
  sensors.push_back(std::make_unique<Frames>(captures));
  run_job(scene, bench::terrain_sources(), sensors, options);
  const Frames& frames = static_cast<const Frames&>(*sensors[0]);
  const auto from = static_cast<size_t>(captures / 4);
  const Line memory = fit(frames.heap, from), seconds = fit(frames.seconds, from);
  std::printf(
      "%s, captures %zu to %d: heap %.2f MB, slope %+.5f %% a capture (+- %.5f); %.1f ms CPU a capture, slope %+.4f %% "
      "(+- %.4f)\n",
      name, from, captures, frames.heap.back() / 1e6, 100 * memory.slope, 100 * memory.error,
      1e3 * frames.seconds.back(), 100 * seconds.slope, 100 * seconds.error);
  return memory.slope < 2e-4 && seconds.slope < 2e-4 + 3 * seconds.error;
}

}  // namespace
}  // namespace suite

int main(int argc, char** argv) {
  const int captures = argc > 1 ? std::atoi(argv[1]) : 200;
  if (captures < 20) return std::fprintf(stderr, "usage: captures_bench [captures], at least 20\n"), 2;
  const bool still = suite::run("at rest", captures, false), moving = suite::run("moving", captures, true);
  return still && moving ? 0 : 1;
}
