// What generality costs a scene that needs none of it: the terrain (Lambert, collimated sun, uniform sky, one band)
// through the pipeline's general kernel, through the one it chooses for such a scene (transport/surfaces_matte.h), and
// through a loop written by hand for nothing else: the same estimator on the same sample points through the same
// tracer, but no records of paths, no materials, no spectra, no truth. They alternate in one process; their images must
// agree. Usage: pruning_bench [edge = 192] [paths = 16] [rounds = 20]
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "base/parallel.h"
#include "math/sampling.h"
#include "math/warps.h"
#include "support/cpu_clock.h"
#include "tests/bench/terrain.h"
#include "transport/pipeline.h"

using namespace suite;
using namespace suite::bench;

namespace {

constexpr int kNodes = 8;
constexpr double kAlbedo = 0.5, kSky = 0.3, kSun = 3;

// Up to 64 paths that run together.
struct Stripped {
  Stripped(const Tracer& t, const Sensor& s, const Capture& c) : tracer(t), sensor(s), capture(c) {}
  const Tracer& tracer;
  const Sensor& sensor;
  const Capture& capture;
  TraceStatistics statistics{};
  struct Live {
    Vec3 origin, direction;
    double throughput = 1, radiance = 0;
    SampleStream stream{0, 0};
    uint32_t index = 0;
  } live[64];
  double* target[64] = {};
  size_t count = 0;
  std::vector<uint32_t> active, facing;
  std::vector<Ray> rays, shadow;
  std::vector<Hit> hits;
  std::vector<uint8_t> blocked;
  std::vector<double> far = std::vector<double>(64, INFINITY);

  void start(size_t problem, uint64_t key, uint32_t sample, double* sum) {
    const auto [scramble, index] = deal(sample);
    Live& l = live[count];
    l.stream = SampleStream(key, scramble);
    l.index = index;
    std::array<double, 4> u = l.stream.draw(index, 0);
    const Ray ray = sensor.ray({capture, problem, {u.data(), static_cast<size_t>(sensor.numbers())}, {}}).ray;
    l.origin = ray.origin, l.direction = ray.direction;
    l.throughput = 1, l.radiance = 0;
    target[count++] = sum;
    if (count == 64) finish();
  }

  void finish() {
    const Dir sun = normalized(Vec3{0.5, -0.3, 0.8});
    active.clear();
    for (uint32_t p = 0; p < count; ++p) active.push_back(p);
    for (int depth = 0; !active.empty(); ++depth) {
      rays.clear();
      for (const uint32_t p : active) rays.emplace_back().set(live[p].origin, live[p].direction, 0, 0);
      hits.resize(rays.size());
      tracer.nearest(rays, hits, depth == 0, statistics);
      shadow.clear(), facing.clear();
      size_t kept = 0;
      for (size_t i = 0; i < active.size(); ++i) {
        const uint32_t p = active[i];
        if (!hits[i].hit()) {
          live[p].radiance += live[p].throughput * kSky;
          continue;
        }
        hits[kept] = hits[i];
        active[kept] = p;
        const Hit& hit = hits[kept++];
        if (dot(sun, hit.normal) * -dot(live[p].direction, hit.normal) <= 0) continue;
        shadow.emplace_back().set(tracer.leave(hit, sun), sun, 0, 0);
        facing.push_back(static_cast<uint32_t>(kept - 1));
      }
      active.resize(kept);
      blocked.resize(shadow.size());
      tracer.occluded(shadow, {far.data(), shadow.size()}, blocked, depth == 0, statistics);
      for (size_t i = 0; i < shadow.size(); ++i)
        if (!blocked[i])
          live[active[facing[i]]].radiance +=
              live[active[facing[i]]].throughput * kSun * kAlbedo / kPi * std::fabs(dot(sun, hits[facing[i]].normal));
      kept = 0;
      for (size_t i = 0; i < active.size(); ++i) {
        const uint32_t p = active[i];
        Live& l = live[p];
        l.throughput *= kAlbedo;
        const std::array<double, 4> u = l.stream.draw(l.index, 1 + static_cast<uint32_t>(depth));
        if (depth + 1 > 3) {  // after the third node
          const double survival = std::clamp(l.throughput, 0.05, 1.0);
          if (l.stream.hashed(l.index, 2 + 16 * static_cast<uint32_t>(depth)) >= survival) continue;
          l.throughput /= survival;
        }
        if (depth + 1 >= kNodes) continue;
        const Hit& hit = hits[i];
        Dir in = cosine_hemisphere({u[0], u[1]});
        if (dot(l.direction, hit.normal) > 0) in.z = -in.z;
        l.direction = Frame::around(hit.normal).to_world(in);
        l.origin = tracer.leave(hit, l.direction);
        active[kept++] = p;
      }
      active.resize(kept);
    }
    for (size_t p = 0; p < count; ++p) *target[p] += live[p].radiance;
    count = 0;
  }
};

std::vector<double> stripped(const Tracer& tracer, const Sensor& sensor, uint32_t paths) {
  const Capture& capture = sensor.tasks()[0].captures[0];
  std::vector<double> sums(capture.problems(), 0.0);
  const std::vector<Block> blocks = blocks_of(capture);
  parallel_for(0, blocks.size(), 1, [&](size_t begin, size_t end) {
    const FlushDenormals flush;
    Stripped loop(tracer, sensor, capture);
    for (size_t b = begin; b < end; ++b)
      for (uint32_t group = 0; group < paths; group += 8)
        for (uint32_t r = 0; r < blocks[b].rows; ++r)
          for (uint32_t c = 0; c < blocks[b].columns; ++c) {
            const size_t problem = size_t{blocks[b].row + r} * capture.columns + blocks[b].column + c;
            const uint64_t key = SampleStream::problem_key(1, 0, problem);
            for (uint32_t s = group; s < std::min(group + 8, paths); ++s) loop.start(problem, key, s, &sums[problem]);
          }
    if (loop.count) loop.finish();
  });
  for (double& s : sums) s /= paths;
  return sums;
}

}  // namespace

int main(int argc, char** argv) {
  const auto edge = static_cast<uint32_t>(argc > 1 ? std::atol(argv[1]) : 192);
  const auto paths = static_cast<uint32_t>(argc > 2 ? std::atol(argv[2]) : 16);
  const int rounds = argc > 3 ? std::atoi(argv[3]) : 20;
  const auto scene = terrain_scene(708);
  const TerrainCamera sensor(edge, paths);
  const Capture& capture = sensor.tasks()[0].captures[0];
  const Tracer tracer(scene);
  const Optics optics(*scene, sensor.states()[0]);
  const Environment environment = bake_environment(terrain_sources(), tracer, false, optics.state());
  const BandProjection projection(optics.state(), sensor.bands(0));
  const TruthPlan truth({}, {tracer, optics.state(), 0, sensor.bands(0), projection, environment});
  const ChannelPlan channels(sensor.channels());
  const Surface surface(tracer, optics);
  PipelineOptions options;
  options.max_nodes = kNodes;
  const Pipeline matte(surface, optics, environment, optics.state(), projection, 0, truth, channels, options);
  options.specialise = false;
  const Pipeline general(surface, optics, environment, optics.state(), projection, 0, truth, channels, options);
  const std::vector<Block> blocks = blocks_of(capture);
  const std::vector<uint32_t> to(capture.problems(), paths);
  // As the scheduler runs captures whose counts are known: a block gets its sums, runs, and is done with.
  const auto whole = [&](const Pipeline& pipeline) {
    std::vector<double> image(capture.problems());
    parallel_for(0, blocks.size(), 64, [&](size_t begin, size_t end) {
      RunStatistics statistics;
      Accumulators sums({kBlockEdge * kBlockEdge, 1, scrambles_for(paths), truth.slots()});
      for (size_t b = begin; b < end; ++b) {
        const Block& block = blocks[b];
        sums.clear();
        pipeline.run(sensor, capture, 0, block, to, sums, Slots::by_place, statistics);
        for (uint32_t i = 0; i < block.columns * block.rows; ++i) {
          double error = 0;
          sums.estimate(
              i, 0, image[(size_t{block.row} + i / block.columns) * capture.columns + block.column + i % block.columns],
              error);
        }
      }
    });
    return image;
  };
  std::vector<double> seconds[3], over_hand, over_general;
  double difference = 0, mean = 0;
  for (int r = 0; r < rounds; ++r) {
    const double t0 = test::cpu_seconds();
    const std::vector<double> one = whole(general);
    const double t1 = test::cpu_seconds();
    const std::vector<double> two = whole(matte);
    const double t2 = test::cpu_seconds();
    const std::vector<double> three = stripped(tracer, sensor, paths);
    const double t3 = test::cpu_seconds();
    seconds[0].push_back(t1 - t0), seconds[1].push_back(t2 - t1), seconds[2].push_back(t3 - t2);
    over_hand.push_back((t2 - t1) / (t3 - t2)), over_general.push_back((t2 - t1) / (t1 - t0));
    if (r > 0) continue;
    for (size_t i = 0; i < one.size(); ++i) {
      difference = std::max({difference, std::fabs(one[i] - three[i]), std::fabs(two[i] - three[i])});
      mean += one[i] / static_cast<double>(one.size());
    }
  }
  for (auto* v : {&seconds[0], &seconds[1], &seconds[2], &over_hand, &over_general}) std::sort(v->begin(), v->end());
  const auto middle = static_cast<size_t>(rounds / 2);
  const double scale = 1e6 / (static_cast<double>(capture.problems()) * paths);
  std::printf("%u x %u pixels, %u paths, %d rounds: mean radiance %.5f, largest difference of a pixel %.2g of it\n",
              edge, edge, paths, rounds, mean, difference / mean);
  std::printf("CPU us/path, median: general %.4f, %s %.4f, by hand %.4f; least: %.4f, %.4f, %.4f\n",
              scale * seconds[0][middle], matte.kernel(), scale * seconds[1][middle], scale * seconds[2][middle],
              scale * seconds[0][0], scale * seconds[1][0], scale * seconds[2][0]);
  std::printf("%s over by hand: median %.3f, least %.3f, most %.3f; over general: median %.3f, most %.3f\n",
              matte.kernel(), over_hand[middle], over_hand.front(), over_hand.back(), over_general[middle],
              over_general.back());
}
