// Seconds to 1 % relative RMSE on the terrain, rays and paths per second, share of time inside Embree.
// Usage: terrain_bench [edge of the image = 512] [paths = 16] [paths of the reference = 512] [bands = 1] [vertices a
// side = 708]
#include <cstdio>
#include <cstdlib>
#include <ctime>

#include "tests/bench/terrain.h"

using namespace suite;
using namespace suite::bench;

namespace {
struct Run {
  CaptureResult result;
  JobReport report;
};
Run render(const std::shared_ptr<Scene>& scene, uint32_t edge, uint32_t paths, size_t bands, uint64_t seed) {
  std::vector<std::unique_ptr<Sensor>> sensors;
  sensors.push_back(std::make_unique<TerrainCamera>(edge, paths, bands));
  JobOptions options;
  options.pipeline.seed = seed;
  options.pipeline.max_nodes = 8;
  options.progress = false;
  Run run;
  run.report = run_job(scene, terrain_sources(), sensors, options);
  run.result = std::move(static_cast<TerrainCamera&>(*sensors[0]).result);
  return run;
}
}  // namespace

int main(int argc, char** argv) {
  auto argument = [&](int i, long otherwise) { return argc > i ? std::atol(argv[i]) : otherwise; };
  const auto edge = static_cast<uint32_t>(argument(1, 512)), paths = static_cast<uint32_t>(argument(2, 16));
  const auto reference_paths = static_cast<uint32_t>(argument(3, 512));
  const auto bands = static_cast<size_t>(argument(4, 1));
  const auto scene = terrain_scene(static_cast<uint32_t>(argument(5, 708)));
  const Run reference = render(scene, edge, reference_paths, bands, 99);
  std::printf("%8s %10s %10s %12s %12s %10s %10s %8s %8s\n", "paths", "seconds", "build s", "Mpaths/s", "Mrays/s",
              "rmse %", "mean", "CPU s", "Embree");
  for (uint32_t n = 4; n <= paths; n *= 2) {
    const std::clock_t begun = std::clock();
    const Run run = render(scene, edge, n, bands, 1);
    // Without building, whose share of the clock on the wall stands for its share of CPU time.
    const double cpu = static_cast<double>(std::clock() - begun) / CLOCKS_PER_SEC *
                       (1 - run.report.build_seconds / run.report.seconds);
    double square = 0, mean = 0, reference_mean = 0;
    for (size_t i = 0; i < run.result.radiance.size(); ++i) {
      const double d = run.result.radiance[i] - reference.result.radiance[i];
      square += d * d;
      mean += run.result.radiance[i];
      reference_mean += reference.result.radiance[i];
    }
    const double count = static_cast<double>(run.result.radiance.size());
    const double seconds = run.report.seconds - run.report.build_seconds;
    std::printf("%8u %10.3f %10.3f %12.2f %12.2f %10.3f %10.5f %8.3f %7.1f%%\n", n, seconds, run.report.build_seconds,
                static_cast<double>(run.report.statistics.paths) / seconds / 1e6,
                static_cast<double>(run.report.statistics.trace.rays) / seconds / 1e6,
                100 * std::sqrt(square / count) / (reference_mean / count), mean / count, cpu,
                100 * run.report.share_in_embree);
  }
}
