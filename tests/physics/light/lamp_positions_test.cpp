// Samples of lamps and their densities agree wherever the lit place is: inside a shape, on it within rounding, just
// above it, far off. Each sample's density is that of the ray which goes the same way, and the densities of rays of all
// directions add up to the share of samples that are seen (densities 10 % off must be refused). Furnaces: in a cavity
// of any shape whose walls glow with L and reflect r, every radiance is L / (1 - r).
#include <gtest/gtest.h>

#include <cmath>

#include "math/sampling.h"
#include "math/warps.h"
#include "tests/support/lamps_kit.h"
#include "trace/tracer.h"

namespace suite::test::lamp_positions_test {
namespace {

enum class Shape { sphere, scaled_sphere, disk, plane, mesh };
constexpr Shape kShapes[] = {Shape::sphere, Shape::scaled_sphere, Shape::disk, Shape::plane, Shape::mesh};
const char* const kShapeNames[] = {"sphere", "scaled sphere", "disk", "plane", "mesh"};

// A scene of one glowing thing, or of several.
std::shared_ptr<Scene> scene_of_exact(const std::vector<std::pair<Primitive, Affine3>>& parts, double reflectance) {
  auto scene = scene_of({}, {material("lamp", lambert(reflectance))});
  for (const auto& [primitive, place] : parts) {
    scene->primitives.push_back(primitive);
    Placement p;
    p.kind = TargetKind::primitive, p.target = static_cast<uint32_t>(scene->primitives.size() - 1), p.to_parent = place;
    scene->groups[0].placements.push_back(p);
  }
  check_scene(*scene, "exact lamps");
  return scene;
}

// About 1 m across.
std::shared_ptr<Scene> scene_of_shape(Shape shape) {
  const Affine3 lean = translation({3, -2, 1}) * rotation(normalized(Vec3{1, 2, 3}), 0.7);
  if (shape == Shape::mesh) {
    auto scene = scene_of({box({-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5}, 0, true)}, {material("lamp", lambert(0))});
    scene->groups[0].placements[0].to_parent = lean;
    return scene;
  }
  if (shape == Shape::disk) return scene_of_exact({{{"d", PrimitiveKind::disk, {0.5, 0}, 0}, lean}}, 0);
  if (shape == Shape::plane) return scene_of_exact({{{"p", PrimitiveKind::plane, {1, 0.7}, 0}, lean}}, 0);
  const double scale = shape == Shape::scaled_sphere ? -25 : 1;
  return scene_of_exact({{{"s", PrimitiveKind::sphere, {0.5 / std::fabs(scale)}, 0},
                          lean * scaling({scale, std::fabs(scale), std::fabs(scale)})}},
                        0);
}

struct Lit {
  std::shared_ptr<Scene> scene;
  Tracer tracer;
  FlushDenormals flush;
  std::vector<LampSpec> specs;
  Lamps lamps;
  Lit(Shape shape, bool both_sides)
      : scene(scene_of_shape(shape)),
        tracer(scene),
        specs{glow("lamp", 1, both_sides)},
        lamps(specs, tracer, make_state(one_band(), 0.01, 0, 1)) {}
  // Density of the lamps' samples along a ray; 0 when it meets nothing that glows. distance: to the hit.
  double density(const LightReceiver& from, Dir direction, double& distance) const {
    const Ray ray{from.position, direction, 0};
    Hit hit;
    TraceStatistics statistics;
    tracer.nearest({&ray, 1}, {&hit, 1}, false, statistics);
    distance = hit.distance;
    if (!hit.hit()) return 0;
    const auto met = lamps.met_surface(from, hit, 0, direction, hit.distance, -dot(direction, hit.normal), 0);
    return met ? met->density : 0;
  }
};

struct Sums {
  int samples = 0, other = 0;
  double by_samples = 0, by_rays = 0, error = 0;
};
Sums compare(const Lit& lit, Vec3 at, int n) {
  const LightReceiver from{at, {}, true};
  Pcg32 rng(9);
  Sums sums;
  double seen = 0, mean = 0, square = 0;
  // From outside, rays into the cone around the shape's corners do.
  constexpr double kAround = 0.87;
  const Vec3 way = Vec3{3, -2, 1} - at;
  const double sine = kAround / (length(way) + 1e-300), drop = sine < 1 ? 1 - std::sqrt(1 - sine * sine) : 0;
  const Frame around = Frame::around(drop > 0 ? normalized(way) : Dir{0, 0, 1});
  for (int i = 0; i < n; ++i) {
    if (const auto s = lit.lamps.sample(from, {rng.uniform(), rng.uniform(), rng.uniform(), rng.uniform()}, 0)) {
      double distance = 0;
      const double density = lit.density(from, s->direction, distance);
      const double tolerance = 1e-5 * (s->distance + 0.02);
      if (density > 0 && std::fabs(distance - s->distance) < tolerance) {
        ++seen, ++sums.samples;
        // (Grazing ones feel the rounding of the place that was hit.)
        if (std::fabs(density / s->density - 1) > 2e-3) ++sums.other;
      }
    }
    double distance = 0;
    const Vec2 u{rng.uniform(), rng.uniform()};
    const Dir to = drop > 0 ? around.to_world(uniform_cone(u, drop)) : uniform_sphere(u);
    const double d = (drop > 0 ? 2 * kPi * drop : 4 * kPi) * lit.density(from, to, distance);
    mean += d, square += d * d;
  }
  seen /= n, mean /= n, square /= n;
  sums.by_samples = seen, sums.by_rays = mean;
  sums.error = std::sqrt((seen * (1 - seen) + square - mean * mean) / n);
  return sums;
}

TEST(LampPositions, SamplesAndDensitiesAgree) {
  int refused = 0, cells = 0;
  for (const Shape shape : kShapes)
    for (const bool both_sides : {false, true}) {
      const Lit lit(shape, both_sides);
      const Affine3 lean = translation({3, -2, 1}) * rotation(normalized(Vec3{1, 2, 3}), 0.7);
      const bool round = shape == Shape::sphere || shape == Shape::scaled_sphere, flat = !round && shape != Shape::mesh;
      // Heights over the surface, in m; below 0: inside, or behind.
      for (const double height : {-0.5, -0.2, -1e-3, -1e-6, -1e-12, 0.0, 1e-12, 1e-9, 1e-6, 1e-3, 0.1, 2.0, 30.0}) {
        if (height <= -0.5 && flat) continue;
        const double middle = flat ? 0 : 0.5;
        const Dir up = round ? normalized(Vec3{0.3, 0.5, 0.7}) : Dir{0, 0, 1};
        const Vec3 at = lean.point(up * (middle + height) + (round ? Vec3{} : Vec3{0.11, -0.07, 0}));
        SCOPED_TRACE(strf("%s, %s, %g m over it", kShapeNames[static_cast<int>(shape)],
                          both_sides ? "both sides" : "front", height));
        const Sums sums = compare(lit, at, 20000);
        EXPECT_LE(sums.other, sums.samples / 500 + 3);
        // Just above a surface the densities of rays along it have no variance to speak of.
        const bool near = std::fabs(height) < 0.05 && !(round && height < 1e-7 && height > -1e-7);
        if (near) continue;
        EXPECT_NEAR(sums.by_samples, sums.by_rays, 4.5 * sums.error + 1e-9);
        if (sums.by_samples > 0) ++cells, refused += std::fabs(sums.by_samples - 1.1 * sums.by_rays) > 4.5 * sums.error;
      }
    }
  EXPECT_GT(cells, 20);
  EXPECT_GT(refused, 0.8 * cells);
}

// Cavities: what they are, and a place inside.
struct Cavity {
  const char* name;
  std::shared_ptr<Scene> scene;
  Vec3 inside;
};
std::vector<Cavity> cavities(double r) {
  using K = PrimitiveKind;
  const Affine3 at = translation({30, -20, 10}), lean = at * rotation(normalized(Vec3{1, 2, 3}), 0.7);
  const auto one = [&](const char* name, K kind, std::vector<double> q, const Affine3& m, Vec3 local) {
    return Cavity{name, scene_of_exact({{{name, kind, std::move(q), 0}, m}}, r), m.point(local)};
  };
  const Affine3 top = translation({0, 0, 2}), flip{{1, 0, 0, 0, -1, 0, 0, 0, -1}, {}};
  std::vector<std::pair<Primitive, Affine3>> can{{{"side", K::cylinder, {1, 2, 0}, 0}, lean},
                                                 {{"floor", K::disk, {1, 0}, 0}, lean},
                                                 {{"lid", K::disk, {1, 0}, 0}, lean * top * flip}};
  std::vector<std::pair<Primitive, Affine3>> planes;
  for (const Vec3 axis : {Vec3{0, 0, 1}, Vec3{1, 0, 0}, Vec3{0, 1, 0}})
    for (const double side : {1.0, -1.0}) {
      const Affine3 turn = axis.z ? Affine3{} : rotation(axis.x ? Vec3{0, 1, 0} : Vec3{-1, 0, 0}, kPi / 2);
      planes.push_back({{"wall", K::plane, {2, 2}, 0}, translation(axis * side) * turn});
    }
  auto mesh = scene_of({box({-1, -1, -1}, {1, 1, 1}, 0, false)}, {material("lamp", lambert(r))});
  auto turned = scene_of({box({-1, -1, -1}, {1, 1, 1}, 0, true)}, {material("lamp", lambert(r))});
  turned->groups[0].placements[0].to_parent = lean;
  return {one("sphere", K::sphere, {25}, Affine3{}, {3, 0, 15}),
          one("sphere away", K::sphere, {0.7}, lean, {0.1, 0.2, 0.3}),
          one("scaled sphere", K::sphere, {0.1}, lean * scaling({7, -7, 7}), {0.01, 0.02, 0.03}),
          one("ellipsoid", K::sphere, {1}, lean * scaling({1, 2, 3}), {0.1, 0.2, 0.3}),
          one("box", K::box, {-1, -1, -1, 1, 1, 1}, lean, {0.1, 0.2, 0.3}),
          one("cylinder", K::cylinder, {1, 2, 1}, lean, {0.1, 0.2, 0.3}),
          one("cone", K::cone, {1, 0.3, 2, 1}, lean, {0.1, 0.2, 0.3}),
          {"can with disks", scene_of_exact(can, r), lean.point({0.1, 0.2, 0.3})},
          {"six planes", scene_of_exact(planes, r), {0.1, 0.2, 0.3}},
          {"mesh", mesh, {0.1, 0.2, 0.3}},
          {"turned mesh", turned, lean.point({0.1, 0.2, 0.3})}};
}

TEST(LampPositions, Furnaces) {
  const double L = 0.5, r = 0.5, truth = L / (1 - r);
  SourceSpecs sources;
  sources.add(std::vector<LampSpec>{glow("lamp", L, true)});
  for (const Cavity& c : cavities(r)) {
    SCOPED_TRACE(c.name);
    std::vector<Ray> rays;
    Pcg32 rng(4);
    for (int i = 0; i < 24; ++i) rays.push_back({c.inside, uniform_sphere({rng.uniform(), rng.uniform()}), 0});
    const Rendered run = render(c.scene, sources, std::make_unique<RaySensor>(rays, one_band(), 256));
    double mean = 0, variance = 0;
    for (size_t i = 0; i < rays.size(); ++i)
      mean += run.result.radiance[i] / 24, variance += std::pow(run.result.standard_error[i] / 24, 2);
    const double error = std::sqrt(variance);
    EXPECT_NEAR(mean, truth, 4.5 * error + 1e-5);
    EXPECT_LT(4.5 * error, 0.02 * truth);  // 2 % off is refused
  }
}

}  // namespace
}  // namespace suite::test::lamp_positions_test
