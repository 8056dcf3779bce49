// How cost grows: bands, triangles, instances, threads, spectral width; whole renders of the terrain, as CSV on
// standard output: bench, x, unit, value (seconds of CPU of this process), extra (Mrays/s, share of Embree). Usage:
// scaling_bench [bands|triangles|instances|threads|seconds_to_1_percent]...   (default: all)
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <string>
#include <vector>

#include "base/parallel.h"
#include "tests/bench/terrain.h"

namespace suite::bench {
namespace {

// CPU time, which a machine that is busy with other things distorts less than the clock on the wall.
double cpu_seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

struct Run {
  CaptureResult result;
  JobReport report;
  double cpu = 0;
};
Run render(const std::shared_ptr<Scene>& scene, uint32_t edge, uint32_t paths, size_t bands, uint64_t seed = 1) {
  std::vector<std::unique_ptr<Sensor>> sensors;
  sensors.push_back(std::make_unique<TerrainCamera>(edge, paths, bands));
  JobOptions options;
  options.pipeline.seed = seed;
  options.pipeline.max_nodes = 8;
  options.progress = false;
  Run run;
  const double start = cpu_seconds();
  run.report = run_job(scene, terrain_sources(), sensors, options);
  run.cpu = cpu_seconds() - start;
  run.result = std::move(static_cast<TerrainCamera&>(*sensors[0]).result);
  return run;
}

// CPU microseconds a path, building taken off by a run of fewer paths.
void print(const char* bench, double x, const char* unit, double value, const Run& run) {
  const double seconds = run.report.seconds - run.report.build_seconds;
  std::printf("%s,%g,%s,%.6g,%.3g,%.3f\n", bench, x, unit, value,
              static_cast<double>(run.report.statistics.trace.rays) / seconds / 1e6, run.report.share_in_embree);
  std::fflush(stdout);
}
void per_path(const char* bench, double x, const std::shared_ptr<Scene>& scene, uint32_t edge, uint32_t paths,
              size_t bands) {
  const Run few = render(scene, edge, 4, bands), many = render(scene, edge, 4 + paths, bands);
  print(bench, x, "us/path (CPU)", 1e6 * (many.cpu - few.cpu) / (static_cast<double>(edge) * edge * paths), many);
}

void bands() {
  const auto scene = terrain_scene(240);
  for (const size_t n : {1u, 4u, 16u, 64u, 224u}) per_path("bands", static_cast<double>(n), scene, 96, 16, n);
}
void triangles() {
  for (const uint32_t edge : {72u, 225u, 708u, 2237u})
    per_path("triangles", 2.0 * (edge - 1) * (edge - 1), terrain_scene(edge), 128, 16, 1);
}
// The terrain many times over, side by side in 1 km steps; only the middle one is seen.
void instances() {
  for (const int side : {1, 10, 100}) {
    auto scene = terrain_scene(72);
    scene->groups[0].placements.clear();
    for (int j = 0; j < side; ++j)
      for (int i = 0; i < side; ++i) {
        Placement p;
        p.to_parent = translation({1000.0 * (i - side / 2), 1000.0 * (j - side / 2), 0});
        scene->groups[0].placements.push_back(p);
      }
    per_path("instances", side * side, scene, 96, 16, 1);
  }
}
// Seconds on the wall of the rendering alone.
void thread_counts() {
  const auto scene = terrain_scene(225);
  for (const int n : {1, 2}) {
    set_threads(n);
    const Run run = render(scene, 192, 32, 1);
    print("threads", n, "s (wall)", run.report.seconds - run.report.build_seconds, run);
  }
  set_threads(0);
}
// From the error at 16 paths and its slope between 8 and 16.
void seconds_to_1_percent() {
  const auto scene = terrain_scene(708);
  const uint32_t edge = 256;
  const Run reference = render(scene, edge, 256, 1, 99);
  auto error = [&](const Run& run) {
    double square = 0, mean = 0;
    for (size_t i = 0; i < run.result.radiance.size(); ++i) {
      const double d = run.result.radiance[i] - reference.result.radiance[i];
      square += d * d, mean += reference.result.radiance[i];
    }
    const auto n = static_cast<double>(run.result.radiance.size());
    return std::sqrt(square / n) / (mean / n);
  };
  const Run half = render(scene, edge, 8, 1), full = render(scene, edge, 16, 1);
  const double a = error(half), b = error(full), slope = std::log2(b / a);
  const double scale = std::pow(0.01 / b, 1 / slope);
  print("error_at_16_paths", 16, "relative RMSE", b, full);
  print("seconds_to_1_percent", edge * edge, "s (CPU)", scale * 16 / 8 * (full.cpu - half.cpu), full);
}

}  // namespace
}  // namespace suite::bench

int main(int argc, char** argv) {
  using namespace suite::bench;
  const std::pair<const char*, void (*)()> all[] = {{"bands", bands},
                                                    {"triangles", triangles},
                                                    {"instances", instances},
                                                    {"threads", thread_counts},
                                                    {"seconds_to_1_percent", seconds_to_1_percent}};
  std::puts("bench,x,unit,value,Mrays_per_s,share_in_embree");
  for (const auto& [name, run] : all)
    if (argc == 1 ||
        std::any_of(argv + 1, argv + argc, [&](const char* wanted) { return std::string(wanted) == name; }))
      run();
}
