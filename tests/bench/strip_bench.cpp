// A strip of captures of one line each, as push-brooms take it: seconds and the share of the cores that was busy, with
// fixed counts and with a pilot. Usage: strip_bench [captures [columns [paths]]]
#include <chrono>
#include <cstdio>
#include <cstdlib>

#include "base/parallel.h"
#include "support/cpu_clock.h"
#include "tests/bench/terrain.h"

namespace suite {
namespace {

class Strip final : public Sensor {
 public:
  Strip(int lines, uint32_t columns, uint32_t paths, double target)
      : bands_({Band::rectangular("b", 0.55, 0.01)}), state_(make_state(bands_, 0.01, 0, 4)) {
    Task task{"strip", {0, static_cast<double>(lines)}, {}};
    for (int k = 0; k < lines; ++k) {
      Capture c;
      c.columns = columns, c.rows = 1;
      c.window = {static_cast<double>(k), k + 0.01};
      c.convergence = {target > 0 ? 16 : paths, paths, target, 0};
      task.captures.push_back(c);
    }
    tasks_.push_back(std::move(task));
  }
  std::string name() const override { return "strip"; }
  std::span<const SpectralState> states() const override { return {&state_, 1}; }
  std::span<const Band> bands(size_t) const override { return bands_; }
  std::span<const Task> tasks() const override { return tasks_; }
  SensorRay ray(const RayRequest& r) const override {
    const double x = (static_cast<double>(r.problem) + r.u[0]) / r.capture.columns - 0.5,
                 y = (r.capture.window.begin + r.u[1]) / static_cast<double>(tasks_[0].captures.size()) - 0.5;
    return {{{900 * x, 900 * y, 500}, {0, 0, -1}, 0}, 1};
  }
  void accept(CaptureResult&& r) override {
    for (const double L : r.radiance) sum += L;
  }
  double sum = 0;

 private:
  std::vector<Band> bands_;
  SpectralState state_;
  std::vector<Task> tasks_;
};

void run(const char* name, const std::shared_ptr<const Scene>& scene, int lines, uint32_t columns, uint32_t paths,
         double target) {
  JobOptions options;
  options.progress = false;
  std::vector<std::unique_ptr<Sensor>> sensors;
  sensors.push_back(std::make_unique<Strip>(lines, columns, paths, target));
  const auto begun = std::chrono::steady_clock::now();
  const double cpu = test::cpu_seconds();
  const JobReport report = run_job(scene, bench::terrain_sources(), sensors, options);
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
  std::printf(
      "%s: %d captures of %u, %.2e paths, %.3f s (%.3f s to build), %.3f s CPU, %.1f %% of %d threads, sum %.17g\n",
      name, lines, columns, static_cast<double>(report.statistics.paths), seconds, report.build_seconds,
      test::cpu_seconds() - cpu, 100 * (test::cpu_seconds() - cpu) / seconds / threads(), threads(),
      static_cast<const Strip&>(*sensors[0]).sum);
}

}  // namespace
}  // namespace suite

int main(int argc, char** argv) {
  const int lines = argc > 1 ? std::atoi(argv[1]) : 2000;
  const auto columns = static_cast<uint32_t>(argc > 2 ? std::atol(argv[2]) : 64),
             paths = static_cast<uint32_t>(argc > 3 ? std::atol(argv[3]) : 16);
  const auto scene = suite::bench::terrain_scene(200);
  suite::run("fixed counts", scene, lines, columns, paths, 0);
  suite::run("with a pilot", scene, lines, columns, 4 * paths, 0.05);
}
