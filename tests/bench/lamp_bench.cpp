// Cost and noise of a path among 1 to 10 000 lamps over a floor, per lamp count: CPU time per path, rays per path,
// and the relative standard deviation of one path. Usage: lamp_bench [paths = 256]
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>

#include "math/sampling.h"
#include "tests/bench/terrain.h"

using namespace suite;
using namespace suite::bench;

int main(int argc, char** argv) {
  const auto paths = static_cast<uint32_t>(argc > 1 ? std::atol(argv[1]) : 256);
  const auto scene = terrain_scene(100);
  std::printf("%8s %14s %12s %14s\n", "lamps", "CPU us/path", "rays/path", "sd of a path");
  for (const int n : {1, 10, 100, 1000, 10000}) {
    std::vector<std::unique_ptr<Sensor>> sensors;
    sensors.push_back(std::make_unique<TerrainCamera>(64, paths));
    JobOptions options;
    options.pipeline.max_nodes = 2;
    options.progress = false;
    const std::clock_t begun = std::clock();
    const JobReport report = run_job(scene, lamps_over_terrain(n), sensors, options);
    const std::clock_t used = std::clock() - begun;
    const CaptureResult& r = static_cast<TerrainCamera&>(*sensors[0]).result;
    double error = 0, mean = 0;
    for (size_t i = 0; i < r.radiance.size(); ++i)
      error += r.standard_error[i] * r.standard_error[i], mean += r.radiance[i];
    const double count = static_cast<double>(r.radiance.size()), done = static_cast<double>(report.statistics.paths);
    std::printf("%8d %14.3f %12.2f %14.3f\n", n, 1e6 * static_cast<double>(used) / CLOCKS_PER_SEC / done,
                static_cast<double>(report.statistics.trace.rays) / done,
                std::sqrt(error / count * paths) / (mean / count));
  }
}
