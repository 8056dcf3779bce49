// Periodic scenes: a cell that repeats is the same as a wide grid of copies, and conserves energy.
#include <gtest/gtest.h>

#include <cmath>

#include "math/sampling.h"
#include "tests/support/radiometry_kit.h"
#include "trace/tracer.h"

namespace suite::test::periodic_test {
namespace {

std::shared_ptr<Scene> spheres(int copies) {
  // A ground square of 10 m and two spheres, one of them across the side of the cell.
  auto scene = scene_of({mesh_of({{0, 0, 0}, {10, 0, 0}, {10, 10, 0}, {0, 10, 0}}, {0, 1, 2, 0, 2, 3}, 0)},
                        {material("ground", lambert(0.3)), material("ball", lambert(0.6))});
  scene->primitives.push_back({"ball", PrimitiveKind::sphere, {1.5}, 1});
  Group cell = scene->groups[0];
  for (const Vec3 c : {Vec3{4, 5, 2}, Vec3{9.5, 0.3, 3}}) {
    Placement p;
    p.kind = TargetKind::primitive;
    p.to_parent = translation(c);
    cell.placements.push_back(p);
  }
  scene->groups = {Group{"root", {}}, cell};
  for (int x = -copies; x <= copies; ++x)
    for (int y = -copies; y <= copies; ++y) {
      Placement p;
      p.kind = TargetKind::group;
      p.target = 1;
      p.to_parent = translation({10.0 * x, 10.0 * y, 0});
      scene->groups[0].placements.push_back(p);
    }
  check_scene(*scene, "cells");
  return scene;
}

TEST(Periodic, SameHitsAsAGridOfCopies) {
  const Tracer cell(spheres(0), Periodic{{0, 0}, {10, 10}}), grid(spheres(12));
  Pcg32 rng(11);
  TraceStatistics statistics;
  int hits = 0;
  for (int i = 0; i < 5000; ++i) {
    const Vec3 from{10 * rng.uniform(), 10 * rng.uniform(), 8 * rng.uniform()};
    const Ray ray{from, normalized(Vec3{rng.uniform() - 0.5, rng.uniform() - 0.5, 0.3 * (rng.uniform() - 0.6)}), 0};
    Hit a, b;
    cell.nearest({&ray, 1}, {&a, 1}, false, statistics);
    grid.nearest({&ray, 1}, {&b, 1}, false, statistics);
    if (b.hit() && b.distance > 100) continue;  // the grid ends
    ASSERT_EQ(a.hit(), b.hit() || a.distance > 100) << i;
    if (!b.hit()) continue;
    ++hits;
    EXPECT_NEAR(a.distance, b.distance, 2e-4) << i;
    EXPECT_NEAR(a.position.z, b.position.z, 1e-4);
    uint8_t near = 0, far = 0;
    const double before = b.distance - 0.01, behind = b.distance + 0.01;
    cell.occluded({&ray, 1}, {&before, 1}, {&near, 1}, false, statistics);
    cell.occluded({&ray, 1}, {&behind, 1}, {&far, 1}, false, statistics);
    EXPECT_EQ(near, 0) << i;
    EXPECT_EQ(far, 1) << i;
  }
  EXPECT_GT(hits, 2000);
}

// A plane without bounds under or over what repeats itself, or alone: no ray towards it is lost.
TEST(Periodic, PlanesWithoutBoundsAreMet) {
  for (const double height : {-7.0, 0.5, 20.0})
    for (const bool alone : {true, false}) {
      auto scene = scene_of({}, {material("ground", lambert(0.3)), material("ball", lambert(0.6))});
      scene->primitives = {{"plane", PrimitiveKind::plane, {0, 0}, 0}, {"ball", PrimitiveKind::sphere, {1.5}, 1}};
      for (uint32_t i = 0; i < (alone ? 1u : 2u); ++i) {
        Placement p;
        p.kind = TargetKind::primitive;
        p.target = i;
        p.to_parent = translation(i == 0 ? Vec3{0, 0, height} : Vec3{5, 5, 1});
        scene->groups[0].placements.push_back(p);
      }
      const Tracer cell(scene, Periodic{{0, 0}, {10, 10}});
      Pcg32 rng(5);
      TraceStatistics statistics;
      int met = 0;
      for (int i = 0; i < 2000; ++i) {
        const double up = height > 4 ? 1 : -1;
        const Ray ray{{10 * rng.uniform(), 10 * rng.uniform(), 4},
                      normalized(Vec3{rng.uniform() - 0.5, rng.uniform() - 0.5, up * (0.01 + 0.3 * rng.uniform())}),
                      0};
        Hit hit;
        cell.nearest({&ray, 1}, {&hit, 1}, false, statistics);
        ASSERT_TRUE(hit.hit()) << height << " " << i;
        const double plane = (height - 4) / ray.direction.z, beyond = hit.distance + 1e-3, before = hit.distance - 1e-3;
        EXPECT_LE(hit.distance, plane + 1e-6);
        EXPECT_TRUE(hit.position.x >= 0 && hit.position.x <= 10 && hit.position.y >= 0 && hit.position.y <= 10);
        met += std::fabs(hit.distance - plane) < 1e-6;
        uint8_t near = 0, far = 0;
        cell.occluded({&ray, 1}, {&before, 1}, {&near, 1}, false, statistics);
        cell.occluded({&ray, 1}, {&beyond, 1}, {&far, 1}, false, statistics);
        EXPECT_EQ(near, 0);
        EXPECT_EQ(far, 1);
      }
      EXPECT_GT(met, alone ? 1999 : 100);
    }
}

TEST(Periodic, WhiteCellReturnsWhatItGets) {
  // Everything reflects everything: under a uniform sky every view sees the sky's radiance (purist furnace).
  auto scene = spheres(0);
  for (Material& m : scene->materials) m = material(m.id, lambert(1));
  SourceSpecs sources;
  sources.add(uniform_sky(1, false));
  std::vector<Ray> rays;
  for (int i = 0; i < 8; ++i) rays.push_back({{2.0 + i, 3, 50}, normalized(Vec3{0.1 * i, 0.2, -1}), 0});
  JobOptions options;
  options.progress = false;
  options.periodic = Periodic{{0, 0}, {10, 10}};
  options.pipeline.max_nodes = 64;
  std::vector<std::unique_ptr<Sensor>> sensors;
  sensors.push_back(std::make_unique<RaySensor>(rays, one_band(), 256));
  const JobReport report = run_job(scene, sources, sensors, options);
  const CaptureResult& r = static_cast<RaySensor&>(*sensors[0]).result;
  const double cut = report.statistics.truncated / static_cast<double>(report.statistics.paths);
  EXPECT_LT(cut, 1e-4);
  for (const double L : r.radiance) EXPECT_NEAR(L, 1, 1e-5 + 20 * cut);
}

}  // namespace
}  // namespace suite::test::periodic_test
