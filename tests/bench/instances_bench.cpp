// A million instances: seconds to load and build, bytes an instance all told, and how fast rays are against the same
// scene with Embree's own instances. Usage: instances_bench [instances = 1000000] [base objects = 20]
#include <embree3/rtcore.h>
#include <malloc.h>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "base/parallel.h"
#include "formats/scene_hdf/scene_hdf.h"
#include "math/sampling.h"
#include "motion/track.h"
#include "scene/scene.h"
#include "tests/bench/memory.h"
#include "tests/bench/traced.h"
#include "trace/tracer.h"

using namespace suite;

namespace {

double now() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

// A lumpy ball of 2 n^2 triangles, about a metre wide.
Mesh ball(uint32_t n, double lumps) {
  Mesh m;
  m.name = "ball";
  std::vector<float> positions;
  std::vector<uint32_t> indices;
  for (uint32_t j = 0; j <= n; ++j)
    for (uint32_t i = 0; i <= n; ++i) {
      const double theta = kPi * j / n, phi = 2 * kPi * i / n, r = 0.5 + 0.1 * std::sin(lumps * phi) * std::sin(theta);
      const Dir d = dir_from_angles(theta, phi) * r;
      for (int a = 0; a < 3; ++a) positions.push_back(static_cast<float>(d[a]));
    }
  positions.push_back(0);
  for (uint32_t j = 0; j < n; ++j)
    for (uint32_t i = 0; i < n; ++i) {
      const uint32_t v = j * (n + 1) + i;
      for (const uint32_t k : {v, v + n + 1, v + 1, v + 1, v + n + 1, v + n + 2}) indices.push_back(k);
    }
  m.positions = std::move(positions), m.indices = std::move(indices);
  m.parts.push_back({"ball", 0, static_cast<uint32_t>(m.triangle_count()), kNone});
  return m;
}

Scene forest(size_t instances, uint32_t bases) {
  Scene s;
  for (uint32_t k = 0; k < bases; ++k) s.meshes.push_back(ball(20, 2 + k));
  s.groups.push_back({"root", {}});
  s.groups[0].placements.reserve(instances);
  Pcg32 rng(1);
  const double side = 2 * std::sqrt(static_cast<double>(instances));
  for (size_t i = 0; i < instances; ++i) {
    Placement p;
    const double scale = 0.5 + rng.uniform();
    p.to_parent = translation({(rng.uniform() - 0.5) * side, (rng.uniform() - 0.5) * side, rng.uniform() * 3}) *
                  rotation(normalized(Vec3{rng.uniform() - 0.5, rng.uniform() - 0.5, 1}), 6 * rng.uniform()) *
                  scaling({scale, scale, scale * (1 + rng.uniform())});
    p.target = static_cast<uint32_t>(rng.uniform() * bases);
    s.groups[0].placements.push_back(p);
  }
  return s;
}

// From above in pixel order, and random ones between random places.
std::vector<Ray> rays_of(double side, bool coherent) {
  std::vector<Ray> rays;
  Pcg32 rng(2);
  for (size_t b = 0; b < 16384; ++b)
    for (size_t k = 0; k < 64; ++k) {
      const double x = (static_cast<double>(b % 128 * 8 + k % 8) / 1024 - 0.5) * side * 0.5,
                   y = (static_cast<double>(b / 128 * 8 + k / 8) / 1024 - 0.5) * side * 0.5;
      Ray r{{x, y, 60}, normalized(Vec3{0.2, 0.1, -1}), 0};
      if (!coherent) {
        r.origin.z = 4 * rng.uniform();
        r.direction = normalized(Vec3{rng.uniform() - 0.5, rng.uniform() - 0.5, 0.5 * (rng.uniform() - 0.5)});
      }
      rays.push_back(r);
    }
  return rays;
}

// The same with one Embree instance each, rays in float, hits rebuilt in double as the tracer does.
struct Stock {
  RTCDevice device = rtcNewDevice("isa=avx2,threads=0");
  RTCScene top = rtcNewScene(device);
  const Scene& scene;
  double seconds = 0;

  explicit Stock(const Scene& s) : scene(s) {
    const double start = now();
    std::vector<RTCScene> meshes;
    for (const Mesh& m : s.meshes) {
      RTCScene one = rtcNewScene(device);
      rtcSetSceneFlags(one, RTC_SCENE_FLAG_ROBUST);
      rtcSetSceneBuildQuality(one, RTC_BUILD_QUALITY_HIGH);
      RTCGeometry g = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
      rtcSetSharedGeometryBuffer(g, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, m.positions.data(), 0, 12,
                                 m.vertex_count());
      rtcSetSharedGeometryBuffer(g, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, m.indices.data(), 0, 12,
                                 m.triangle_count());
      rtcCommitGeometry(g);
      rtcAttachGeometry(one, g);
      rtcReleaseGeometry(g);
      rtcCommitScene(one);
      meshes.push_back(one);
    }
    rtcSetSceneFlags(top, RTC_SCENE_FLAG_ROBUST);
    rtcSetSceneBuildQuality(top, RTC_BUILD_QUALITY_HIGH);
    for (const Placement& p : s.groups[0].placements) {
      RTCGeometry g = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_INSTANCE);
      rtcSetGeometryInstancedScene(g, meshes[p.target]);
      const Affine3 map = p.to_parent * translation(s.meshes[p.target].origin);
      float m[12];
      for (size_t r = 0; r < 3; ++r) {
        for (size_t c = 0; c < 3; ++c) m[4 * r + c] = static_cast<float>(map.a[3 * r + c]);
        m[4 * r + 3] = static_cast<float>(map.b[static_cast<int>(r)]);
      }
      rtcSetGeometryTransform(g, 0, RTC_FORMAT_FLOAT3X4_ROW_MAJOR, m);
      rtcCommitGeometry(g);
      rtcAttachGeometry(top, g);
      rtcReleaseGeometry(g);
    }
    rtcCommitScene(top);
    seconds = now() - start;
  }
  ~Stock() {
    rtcReleaseScene(top);
    rtcReleaseDevice(device);
  }

  bench::Seen trace(std::span<const Ray> rays, bool coherent) const {
    const FlushDenormals flush;
    bench::Seen seen;
    const double start = test::cpu_seconds();
    for (size_t i = 0; i < rays.size(); i += 8) {
      RTCIntersectContext context;
      rtcInitIntersectContext(&context);
      context.flags = coherent ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
      alignas(32) RTCRayHit8 rh;
      alignas(32) int valid[8];
      for (size_t k = 0; k < 8; ++k) {
        const Ray& r = rays[i + k];
        valid[k] = -1;
        rh.ray.org_x[k] = static_cast<float>(r.origin.x), rh.ray.org_y[k] = static_cast<float>(r.origin.y),
        rh.ray.org_z[k] = static_cast<float>(r.origin.z);
        rh.ray.dir_x[k] = static_cast<float>(r.direction.x), rh.ray.dir_y[k] = static_cast<float>(r.direction.y),
        rh.ray.dir_z[k] = static_cast<float>(r.direction.z);
        rh.ray.tnear[k] = 0, rh.ray.tfar[k] = INFINITY, rh.ray.time[k] = 0, rh.ray.mask[k] = ~0u, rh.ray.id[k] = 0,
        rh.ray.flags[k] = 0;
        rh.hit.geomID[k] = rh.hit.instID[0][k] = RTC_INVALID_GEOMETRY_ID;
      }
      rtcIntersect8(valid, top, &context, &rh);
      for (size_t k = 0; k < 8; ++k) {
        if (rh.hit.geomID[k] == RTC_INVALID_GEOMETRY_ID) continue;
        const Placement& p = scene.groups[0].placements[rh.hit.instID[0][k]];
        const Mesh& m = scene.meshes[p.target];
        Vec3 v[3];
        for (size_t c = 0; c < 3; ++c) {
          const float* f = &m.positions[3 * size_t{m.indices[3 * size_t{rh.hit.primID[k]} + c]}];
          v[c] = {f[0], f[1], f[2]};
        }
        const Vec3 at = p.to_parent.point(m.origin + v[0] + (v[1] - v[0]) * double{rh.hit.u[k]} +
                                          (v[2] - v[0]) * double{rh.hit.v[k]});
        const Vec3 normal = normalized(p.to_parent.normal(cross(v[1] - v[0], v[2] - v[0])));
        ++seen.hits;
        seen.distance += dot(at - rays[i + k].origin, rays[i + k].direction) + 0 * normal.x;
      }
    }
    seen.seconds = test::cpu_seconds() - start;
    return seen;
  }
};

}  // namespace

int main(int argc, char** argv) try {
  const size_t instances = argc > 1 ? static_cast<size_t>(std::atol(argv[1])) : 1000000;
  const auto bases = static_cast<uint32_t>(argc > 2 ? std::atol(argv[2]) : 20);
  const std::string path = "instances_bench.h5";
  write_scene(forest(instances, bases), {}, path);
  malloc_trim(0);
  // What the base objects and the program take is measured first and taken off.
  const auto count = static_cast<double>(instances);
  {
    const Tracer warm(std::make_shared<Scene>(forest(bases, bases)));
    const double before = bench::memory("VmRSS:"), start = now();
    const auto scene = std::make_shared<const Scene>(read_scene(path));
    const double loaded = now();
    const Tracer tracer(scene);
    const double built = now();
    malloc_trim(0);
    std::printf("%zu instances of %u objects, %zu triangles unfolded, %zu tiles\n", instances, bases,
                tracer.triangles(), tracer.tiles());
    std::printf("load %.3f s, build %.3f s, together %.3f s; resident %.0f B an instance, at the peak %.0f B\n",
                loaded - start, built - loaded, built - start, (bench::memory("VmRSS:") - before) / count,
                (bench::memory("VmHWM:") - before) / count);
    const double between = bench::memory("VmRSS:");
    const Stock stock(*scene);
    malloc_trim(0);
    std::printf("Embree's own instances: build %.3f s, %.0f B an instance besides the scene\n", stock.seconds,
                (bench::memory("VmRSS:") - between) / count);
    const double side = 2 * std::sqrt(count);
    for (const bool coherent : {true, false}) {
      const std::vector<Ray> rays = rays_of(side, coherent);
      bench::Seen a = bench::trace(tracer, rays, coherent), b = stock.trace(rays, coherent);
      for (int k = 0; k < 2; ++k) {
        const bench::Seen x = bench::trace(tracer, rays, coherent), y = stock.trace(rays, coherent);
        if (x.seconds < a.seconds) a = x;
        if (y.seconds < b.seconds) b = y;
      }
      const double millions = static_cast<double>(rays.size()) / 1e6;
      std::printf(
          "%s: %.2f Mrays/s a thread, Embree's own %.2f (%+.1f %%); hits %zu and %zu, mean distance %.6f and %.6f m\n",
          coherent ? "coherent" : "incoherent", millions / a.seconds, millions / b.seconds,
          100 * (b.seconds / a.seconds - 1), a.hits, b.hits, a.distance / static_cast<double>(a.hits),
          b.distance / static_cast<double>(b.hits));
    }
  }
  std::remove(path.c_str());
  return 0;
} catch (const std::exception& e) {
  std::fprintf(stderr, "%s\n", e.what());
  return 1;
}
