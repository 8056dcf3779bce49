// How cost grows: bands, triangles, instances, lamps, cells of a medium, threads; whole renders of the terrain, and how
// long its scene takes to load; as CSV on standard output: bench, x, unit, value (seconds of CPU of this process),
// extra (Mrays/s, share of Embree). Usage: scaling_bench
// [bands|bands_sqt_maps_media|bands_general_kernel|triangles|instances|lamps|media|load|threads|seconds_to_1_percent]...
// (default: all) or bands_in_turn: 224 bands and one in ten alternating pairs, at 16, 64 and 256 paths a pixel;
// quartiles of the ratios of a path's time.
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <filesystem>
#include <string>
#include <vector>

#include "base/error.h"
#include "base/parallel.h"
#include "formats/scene_hdf/scene_hdf.h"
#include "math/sampling.h"
#include "tests/bench/terrain.h"
#include "tests/support/sqt_examples.h"

namespace suite::bench {
namespace {

// CPU time, which a machine that is busy with other things distorts less than the clock on the wall.
double cpu_seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

struct Run {
  CaptureResult result;
  JobReport report;
  double cpu = 0;  // seconds of the job
};
Run render(const std::shared_ptr<Scene>& scene, uint32_t edge, uint32_t paths, size_t bands, uint64_t seed = 1,
           const SourceSpecs& sources = terrain_sources(), size_t captures = 1, bool specialise = true) {
  std::vector<std::unique_ptr<Sensor>> sensors;
  sensors.push_back(std::make_unique<TerrainCamera>(edge, paths, bands, captures));
  JobOptions options;
  options.pipeline.seed = seed;
  options.pipeline.max_nodes = 8;
  options.pipeline.specialise = specialise;
  options.progress = false;
  Run run;
  const double start = cpu_seconds();
  run.report = run_job(scene, sources, sensors, options);
  run.cpu = cpu_seconds() - start;
  auto& camera = static_cast<TerrainCamera&>(*sensors[0]);
  run.result = std::move(camera.result);
  return run;
}

void print(const char* bench, double x, const char* unit, double value, const Run& run) {
  const double seconds = run.report.seconds - run.report.build_seconds;
  std::printf("%s,%g,%s,%.6g,%.3g,%.3f\n", bench, x, unit, value,
              static_cast<double>(run.report.statistics.trace.rays) / seconds / 1e6, run.report.share_in_embree);
  std::fflush(stdout);
}
enum class Kernel { matte, general };
constexpr size_t kMore = 4;
// CPU microseconds a path in that kernel: what some captures more take, for which everything is built and warm
// (captures run beside each other, and have no time of their own).
double per_path(const char* bench, double x, Kernel kernel, const std::shared_ptr<Scene>& scene, uint32_t edge,
                uint32_t paths, size_t bands, const SourceSpecs& sources = terrain_sources(), bool specialise = true,
                size_t more = kMore) {
  const double before = render(scene, edge, paths, bands, 1, sources, 1, specialise).cpu;
  const Run run = render(scene, edge, paths, bands, 1, sources, 1 + more, specialise);
  if (!run.report.log.back().kernel.starts_with(kernel == Kernel::matte ? "matte" : "general"))
    throw Bug(std::string(bench) + " ran in the " + run.report.log.back().kernel + " kernel");
  const double microseconds = 1e6 * (run.cpu - before) / (static_cast<double>(more) * edge * edge * paths);
  print(bench, x, "us/path (CPU)", microseconds, run);
  return microseconds;
}

void bands() {
  const auto scene = terrain_scene(240);
  for (const size_t n : {1u, 4u, 16u, 64u, 224u})
    per_path("bands", static_cast<double>(n), Kernel::matte, scene, 96, 16, n);
}
// The ratio falls with the paths of a pixel: results, their errors and the memory for both are there once a pixel.
void bands_in_turn() {
  const auto scene = terrain_scene(240);
  for (const uint32_t paths : {16u, 64u, 256u}) {
    std::vector<double> ratios;
    for (int pair = 0; pair < 10; ++pair) {
      const auto time = [&](size_t bands) {
        return per_path("bands_in_turn", static_cast<double>(bands), Kernel::matte, scene, 96, paths, bands);
      };
      const double first = time(pair % 2 ? 224 : 1), second = time(pair % 2 ? 1 : 224);
      ratios.push_back(pair % 2 ? first / second : second / first);
    }
    std::sort(ratios.begin(), ratios.end());
    std::printf("bands_in_turn,%u,224 : 1 median %.3f (%.3f to %.3f),%.3f,,\n", paths, (ratios[4] + ratios[5]) / 2,
                ratios[2], ratios[7], (ratios[4] + ratios[5]) / 2);
    std::fflush(stdout);
  }
}
void triangles() {
  // Building ten millions takes seconds that differ from run to run, so that many captures have to stand against them.
  for (const auto& [edge, more] : {std::pair{72u, kMore}, {225u, kMore}, {708u, 4 * kMore}, {2237u, 16 * kMore}})
    per_path("triangles", 2.0 * (edge - 1) * (edge - 1), Kernel::matte, terrain_scene(edge), 128, 16, 1,
             terrain_sources(), true, more);
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
    per_path("instances", side * side, Kernel::matte, scene, 96, 16, 1);
  }
}
// Lamps a few metres over the terrain, of one power in all.
void lamps() {
  const auto scene = terrain_scene(100);
  for (const int n : {1, 10, 100, 1000, 10000})
    per_path("lamps", n, Kernel::matte, scene, 96, 32, 1, lamps_over_terrain(n));
}
// A cloud of optical depth 2 over the terrain, of n cells a side.
void add_cloud(Scene& scene, uint32_t n) {
  Medium m;
  m.id = "cloud";
  m.absorption = Curve::constant(0.001), m.scattering = Curve::constant(0.019);
  m.phase = {"hg", {}, {{"g", Curve::constant(0.6)}}, {}, nullptr};
  check_medium(m);
  scene.media = {m};
  VoxelGrid grid;
  grid.name = "cloud";
  grid.cells = {n, n, n};
  const double low = 150, high = 250;
  grid.to_local = translation({-500, -500, low}) * scaling({1000.0 / n, 1000.0 / n, (high - low) / n});
  grid.media = {0};
  for (uint32_t k = 0; k < n; ++k)
    for (uint32_t j = 0; j < n; ++j)
      for (uint32_t i = 0; i < n; ++i)
        grid.density.push_back(static_cast<float>(1 + std::sin(12.0 * i / n) * std::sin(9.0 * j / n)));
  scene.grids = {std::move(grid)};
  scene.volumes = {{0, Affine3{}}};
}
void media() {
  for (const uint32_t n : {8u, 32u, 128u}) {
    auto scene = terrain_scene(72);
    add_cloud(*scene, n);
    check_scene(*scene, "cloud");
    per_path("media", n, Kernel::general, scene, 96, 16, 1);
  }
}
// The terrain with everything that works per wavelength: a map that mixes a fitted glossy material of four wavelengths
// with a Lambert one of 1000 samples, under a cloud.
std::shared_ptr<Scene> terrain_with_everything() {
  auto scene = terrain_scene(240);
  std::vector<double> um, rho;
  for (int i = 0; i < 1000; ++i) um.push_back(0.4 + 0.0025 * i), rho.push_back(0.4 + 0.2 * std::sin(0.1 * i));
  test::Analytic glossy = test::glossy(0.15, 4);
  glossy.info().wavelength_um = {0.45, 1, 2, 2.8};
  ModelSpec fitted, spotted;
  fitted.model = "sqt";
  fitted.bundle = sqt::make_bundle(test::small_fit(glossy).data);
  spotted.model = "lambert";
  spotted.curves["reflectance"] = Curve(um, rho, Outside::hold);
  check_model(spotted);
  for (const auto& [id, surface] : {std::pair{"gloss", fitted}, std::pair{"spots", spotted}}) {
    Material m;
    m.id = id;
    m.surface = surface;
    scene->materials.push_back(m);
  }
  PropertyMap map;
  map.name = "mix";
  map.width = map.height = 64, map.channels = 2;
  for (int i = 0; i < 64 * 64; ++i) {
    const float share = static_cast<float>(0.5 + 0.5 * std::sin(0.37 * i));
    map.values.push_back(share), map.values.push_back(1 - share);
  }
  map.materials = {1, 2};
  map.drape = {-500, 500, 1000.0 / 64, 1000.0 / 64, Drape::Extend::clamp};
  scene->property_bindings.push_back({0, 0});
  scene->property_maps.push_back(std::move(map));
  add_cloud(*scene, 32);
  check_scene(*scene, "everything");
  return scene;
}
void bands_with_everything() {
  const auto scene = terrain_with_everything();
  for (const size_t n : {1u, 224u})
    per_path("bands_sqt_maps_media", static_cast<double>(n), Kernel::general, scene, 96, 16, n);
}
// The matte terrain of `bands` in the kernel for everything: what the kernel for matte scenes saves.
void bands_in_the_general_kernel() {
  const auto scene = terrain_scene(240);
  for (const size_t n : {1u, 224u})
    per_path("bands_general_kernel", static_cast<double>(n), Kernel::general, scene, 96, 16, n, terrain_sources(),
             false);
}
// Reading and checking a prepared scene, the best of five.
void load() {
  const std::string path = (std::filesystem::temp_directory_path() / strf("scaling_bench_%d.h5", ::getpid())).string();
  for (const uint32_t edge : {72u, 225u, 708u}) {
    write_scene(*terrain_scene(edge), {}, path);
    double best = INFINITY;
    for (int k = 0; k < 5; ++k) {
      const double start = cpu_seconds();
      read_scene(path);
      best = std::min(best, cpu_seconds() - start);
    }
    std::printf("scene_load,%u,ms (CPU),%.6g,,\n", 2 * (edge - 1) * (edge - 1), 1e3 * best);
  }
  std::filesystem::remove(path);
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
                                                    {"bands_sqt_maps_media", bands_with_everything},
                                                    {"bands_general_kernel", bands_in_the_general_kernel},
                                                    {"triangles", triangles},
                                                    {"instances", instances},
                                                    {"lamps", lamps},
                                                    {"media", media},
                                                    {"load", load},
                                                    {"threads", thread_counts},
                                                    {"seconds_to_1_percent", seconds_to_1_percent}};
  const bool in_turn = argc == 2 && std::string(argv[1]) == "bands_in_turn";
  std::puts("bench,x,unit,value,Mrays_per_s,share_in_embree");
  if (in_turn) bands_in_turn();
  for (const auto& [name, run] : all)
    if (argc == 1 ||
        std::any_of(argv + 1, argv + argc, [&](const char* wanted) { return std::string(wanted) == name; }))
      run();
}
