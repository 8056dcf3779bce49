// The same wood from one, two and three levels of groups: memory, seconds to build, and processor time a ray at equal
// hits. Usage: nesting_bench [placements a level = 100] [rounds = 5]. With more than 200 a level the wood of one level
// is left out.
#include <malloc.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <map>

#include "math/sampling.h"
#include "scene/scene.h"
#include "tests/bench/memory.h"
#include "tests/bench/traced.h"
#include "trace/tracer.h"

using namespace suite;

namespace {

// A leaf of two triangles that are bent against each other, 20 cm wide.
Mesh leaf() {
  Mesh m;
  m.name = "leaf";
  m.positions = {-0.1f, -0.1f, 0, 0.1f, -0.1f, 0, 0.1f, 0.1f, 0.03f, -0.1f, 0.1f, 0, 0};
  m.indices = {0, 1, 2, 0, 2, 3};
  m.parts.push_back({"leaf", 0, 2, kNone});
  return m;
}

// Where a level places `count` of the next one: on a jittered grid of this step, or in a ball (leaves).
std::vector<Affine3> places(size_t count, double step, uint64_t seed) {
  Pcg32 rng(seed);
  const auto side = static_cast<size_t>(std::ceil(std::sqrt(static_cast<double>(count))));
  std::vector<Affine3> all;
  for (size_t k = 0; k < count; ++k) {
    if (step > 0) {
      const double x = static_cast<double>(k % side) + 0.2 * rng.uniform(),
                   y = static_cast<double>(k / side) + 0.2 * rng.uniform();
      const double turn = std::floor(4 * rng.uniform()) * kPi / 2, half = static_cast<double>(side) / 2;
      all.push_back(translation({(x - half) * step, (y - half) * step, 0}) * rotation({0, 0, 1}, turn));
      continue;
    }
    Vec3 p;
    do p = Vec3{rng.uniform(), rng.uniform(), rng.uniform()} * 2 - Vec3{1, 1, 1};
    while (length(p) > 1);
    all.push_back(translation(p * 1.5 + Vec3{0, 0, 2}) *
                  rotation(normalized(Vec3{rng.uniform() - 0.5, rng.uniform() - 0.5, 1}), 6 * rng.uniform()));
  }
  return all;
}

// The levels that are left are groups; those above are unfolded into the root, their transforms composed.
std::shared_ptr<const Scene> wood(size_t count, size_t levels) {
  const double tree = 4, forest = tree * std::ceil(std::sqrt(static_cast<double>(count)));
  const std::vector<Affine3> of[3] = {places(count, forest, 1), places(count, tree, 2), places(count, 0, 3)};
  auto s = std::make_shared<Scene>();
  s->meshes.push_back(leaf());
  const size_t unfolded = 3 - levels;
  s->groups.resize(levels);
  for (size_t g = 0; g < levels; ++g) {
    s->groups[g].name = strf("level%zu", g);
    std::vector<Affine3> here = g ? of[g + unfolded] : of[0];
    for (size_t above = 1; !g && above <= unfolded; ++above) {
      std::vector<Affine3> next;
      for (const Affine3& a : here)
        for (const Affine3& b : of[above]) next.push_back(a * b);
      here = std::move(next);
    }
    for (const Affine3& place : here) {
      Placement p;
      p.to_parent = place;
      if (g + 1 < levels) p.kind = TargetKind::group, p.target = static_cast<uint32_t>(g) + 1;
      s->groups[g].placements.push_back(p);
    }
  }
  return s;
}

std::vector<Ray> rays_of(const Box3& box, bool coherent) {
  std::vector<Ray> rays;
  Pcg32 rng(2);
  const Vec3 middle = box.center();
  for (size_t k = 0; k < (1u << 18); ++k) {
    const double x = static_cast<double>(k % 512) / 512 - 0.5, y = static_cast<double>(k / 512) / 512 - 0.5;
    Ray r{{middle.x + x * 60, middle.y + y * 60, 60}, normalized(Vec3{0.2, 0.1, -1}), 0};
    if (!coherent) {
      r.origin.z = 4 * rng.uniform();
      r.direction = normalized(Vec3{rng.uniform() - 0.5, rng.uniform() - 0.5, 0.5 * (rng.uniform() - 0.5)});
    }
    rays.push_back(r);
  }
  return rays;
}

}  // namespace

int main(int argc, char** argv) try {
  const size_t count = argc > 1 ? static_cast<size_t>(std::atol(argv[1])) : 100;
  const int rounds = argc > 2 ? std::atoi(argv[2]) : 5;
  std::map<size_t, std::unique_ptr<Tracer>> tracers;
  for (size_t levels = 3; levels >= (count > 200 ? 2 : 1); --levels) {
    malloc_trim(0);
    const double before = bench::memory("VmRSS:"), start = test::cpu_seconds();
    const auto scene = wood(count, levels);
    const double made = test::cpu_seconds();
    // All groups that save anything are shared; the wood of one level has none.
    tracers[levels] = std::make_unique<Tracer>(scene, std::nullopt, TimeSpan{}, nullptr, TileLimit{}, 0);
    const double built = test::cpu_seconds() - made;
    malloc_trim(0);
    std::printf("%zu levels: %.4g leaves, %.4g triangles; built in %.3f s (the scene in %.3f s), resident %.1f MB\n",
                levels, static_cast<double>(tracers[levels]->object_count()),
                static_cast<double>(tracers[levels]->triangles()), built, made - start,
                (bench::memory("VmRSS:") - before) / 1e6);
  }
  for (const bool coherent : {true, false}) {
    const std::vector<Ray> rays = rays_of(tracers[3]->bounds(), coherent);
    std::map<size_t, std::vector<double>> seconds;
    std::map<size_t, bench::Seen> seen;
    for (int round = 0; round < rounds; ++round)
      for (const auto& [levels, tracer] : tracers)
        seconds[levels].push_back((seen[levels] = bench::trace(*tracer, rays, coherent)).seconds);
    for (auto& [levels, all] : seconds) {
      std::sort(all.begin(), all.end());
      const double median = all[all.size() / 2];
      const auto less = seconds.find(levels - 1);
      std::printf(
          "%s, %zu levels: %.3f us a ray (%.3f to %.3f), %zu hits, mean distance %.6f m%s\n",
          coherent ? "coherent" : "incoherent", levels, 1e6 * median / static_cast<double>(rays.size()),
          1e6 * all.front() / static_cast<double>(rays.size()), 1e6 * all.back() / static_cast<double>(rays.size()),
          seen[levels].hits, seen[levels].distance / static_cast<double>(seen[levels].hits),
          less != seconds.end() ? strf("; %.2f times one level less", median / less->second[all.size() / 2]).c_str()
                                : "");
    }
  }
  return 0;
} catch (const std::exception& e) {
  std::fprintf(stderr, "%s\n", e.what());
  return 1;
}
