// Crowns of thin facets that touch and cross, over trunks and open ground: rays and radiance against an independent
// tracer in double precision, which decides who is right where renderers differ by a tenth of a percent.
#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>

#include "math/sampling.h"
#include "math/stats.h"
#include "tests/support/double_tracer.h"
#include "tests/support/radiometry_kit.h"
#include "trace/tracer.h"

namespace suite::test::crown_test {
namespace {

constexpr double kSunIrradiance = 2, kSkyRadiance = 0.3, kGround = 0.2, kBark = 0.3;
const Dir kSun = normalized(Vec3{0.4, -0.3, 0.8});

struct Leaf {
  double reflectance, transmittance;
};

Vec3 in_ball(Pcg32& rng) {
  for (;;) {
    const Vec3 p{2 * rng.uniform() - 1, 2 * rng.uniform() - 1, 2 * rng.uniform() - 1};
    if (dot(p, p) <= 1) return p;
  }
}

// Lozenges of two triangles each, 12 by 6 cm, at random places and turns in a ball; many cross each other.
Mesh crown(size_t leaves, double radius, double height) {
  Pcg32 rng(11);
  std::vector<Vec3> v;
  std::vector<uint32_t> f;
  for (size_t i = 0; i < leaves; ++i) {
    const Vec3 centre = in_ball(rng) * radius + Vec3{0, 0, height};
    const Frame frame = Frame::around(normalized(in_ball(rng)));
    const double turn = 2 * kPi * rng.uniform();
    const Vec3 along = frame.x * std::cos(turn) + frame.y * std::sin(turn), across = cross(frame.z, along);
    const auto n = static_cast<uint32_t>(v.size());
    for (const Vec3& corner : {along * -0.06, across * 0.03, along * 0.06, across * -0.03})
      v.push_back(centre + corner);
    for (const uint32_t k : {0u, 1u, 2u, 0u, 2u, 3u}) f.push_back(n + k);
  }
  return mesh_of(v, f, 0);
}

// A prism of eight sides from the ground into the crown.
Mesh trunk(double radius, double height) {
  std::vector<Vec3> v;
  std::vector<uint32_t> f;
  for (uint32_t i = 0; i < 8; ++i) {
    const double a = i * kPi / 4;
    for (const double z : {-0.1, height}) v.push_back({radius * std::cos(a), radius * std::sin(a), z});
    const uint32_t j = (i + 1) % 8;
    for (const uint32_t k : {2 * i, 2 * j, 2 * j + 1, 2 * i, 2 * j + 1, 2 * i + 1}) f.push_back(k);
  }
  return mesh_of(v, f, 1);
}

// 16 instanced trees on a square of 24 m.
struct Wood {
  std::shared_ptr<Scene> scene;
  std::unique_ptr<Tracer> tracer;
  std::vector<uint32_t> first;  // of each of the tracer's objects: its first triangle in the exact tracer
  std::unique_ptr<DoubleTracer> exact;
  std::vector<uint32_t> material;  // of each exact triangle

  Wood() {
    scene = std::make_shared<Scene>();
    scene->materials = {test::material("leaf", lambert(0)), test::material("bark", lambert(kBark)),
                        test::material("soil", lambert(kGround))};
    scene->meshes = {crown(6000, 1.5, 3.5), trunk(0.15, 3), quad(12, 0, 2)};
    Group tree, root;
    tree.name = "tree", root.name = "root";
    for (uint32_t mesh = 0; mesh < 2; ++mesh) {
      Placement p;
      p.target = mesh;
      tree.placements.push_back(p);
    }
    Placement ground;
    ground.target = 2;
    root.placements.push_back(ground);
    Pcg32 rng(5);
    for (int i = 0; i < 16; ++i) {
      Placement p;
      p.kind = TargetKind::group;
      p.target = 1;
      p.to_parent = translation({20 * rng.uniform() - 10, 20 * rng.uniform() - 10, 0}) *
                    rotation({0, 0, 1}, 2 * kPi * rng.uniform()) * scaling({1, 1, 0.8 + 0.4 * rng.uniform()});
      root.placements.push_back(p);
    }
    scene->groups = {root, tree};
    check_scene(*scene, "wood");
    tracer = std::make_unique<Tracer>(scene);
    std::vector<DoubleTracer::Triangle> all;
    for (uint32_t n = 0; n < tracer->object_count(); ++n) {
      const TracedObject o = tracer->object(n);
      const Affine3 place = tracer->place(n);
      const Mesh& m = scene->meshes[o.mesh];
      first.push_back(static_cast<uint32_t>(all.size()));
      for (size_t t = 0; t < m.triangle_count(); ++t) {
        const auto vertex = [&](size_t c) {
          const float* q = &m.positions[3 * size_t{m.indices[3 * t + c]}];
          return place.point(m.origin + Vec3{q[0], q[1], q[2]});
        };
        all.push_back({vertex(0), vertex(1), vertex(2)});
        material.push_back(m.parts[0].material);
      }
    }
    exact = std::make_unique<DoubleTracer>(std::move(all));
  }
  // The same with such leaves.
  std::shared_ptr<const Scene> with(Leaf leaf) const {
    auto other = std::make_shared<Scene>(*scene);
    other->materials[0] = test::material("leaf", lambert(leaf.reflectance, leaf.transmittance));
    return other;
  }
  uint32_t number(const Hit& hit) const {
    return hit.hit() ? first[hit.object] + hit.triangle : DoubleTracer::kNothing;
  }
};

const Wood& wood() {
  static const Wood one;
  return one;
}

std::vector<Ray> views(size_t count, uint64_t seed) {
  Pcg32 rng(seed);
  std::vector<Ray> rays;
  const Dir towards = normalized(Vec3{0.3, 0.2, 1});
  for (size_t i = 0; i < count; ++i) {
    const Vec3 target{20 * rng.uniform() - 10, 20 * rng.uniform() - 10, 3};
    rays.push_back({target + towards * 100.0, -towards, 0});
  }
  return rays;
}

struct Compared {
  size_t rays = 0, only_ours = 0, only_exact = 0, another = 0;
};

// What is seen from points of the scene in random directions. aside: how much further off the surface than the tracer
// says the rays start, m.
Compared compare(const Wood& wood, size_t count, double aside) {
  TraceStatistics statistics;
  const std::vector<Ray> rays = views(count, 3);
  std::vector<Hit> hits(count);
  wood.tracer->nearest(rays, hits, true, statistics);
  Pcg32 rng(17);
  std::vector<Ray> away;
  for (Hit& hit : hits) {
    const Dir d = normalized(in_ball(rng));
    hit.step += static_cast<float>(aside);
    away.push_back({hit.hit() ? wood.tracer->leave(hit, d) : Vec3{0, 0, 1e6}, d, 0});
  }
  std::vector<Hit> next(count);
  wood.tracer->nearest(away, next, false, statistics);
  Compared c;
  for (size_t i = 0; i < count; ++i) {
    if (!hits[i].hit()) continue;
    const uint32_t ours = wood.number(next[i]);
    const uint32_t theirs = wood.exact->meet(hits[i].position, away[i].direction, wood.number(hits[i])).triangle;
    ++c.rays;
    if (ours == theirs) continue;
    if (theirs == DoubleTracer::kNothing)
      ++c.only_ours;
    else if (ours == DoubleTracer::kNothing)
      ++c.only_exact;
    else
      ++c.another;
  }
  return c;
}

TEST(Crown, RaysMeetWhatDoublePrecisionMeets) {
  const Compared c = compare(wood(), 50000, 0), wrong = compare(wood(), 50000, 1e-3);
  for (const Compared& one : {c, wrong})
    std::printf("%zu rays between facets: %zu met something only here, %zu only in double, %zu something else\n",
                one.rays, one.only_ours, one.only_exact, one.another);
  // Rays within an ulp of an edge may pass on either side.
  EXPECT_LE(c.only_ours + c.only_exact + c.another, c.rays / 2000);
  // Negative control: a millimetre off the surface passes through facets that touch it.
  EXPECT_GE(wrong.only_ours + wrong.only_exact + wrong.another, c.rays / 500);
}

// Radiance along each line of sight by plain path tracing in double: the sun at every node, the sky where paths leave,
// no roulette, independent numbers. At most 64 nodes (0.9^64 = 0.1 % of what is left there, which is dark).
std::vector<double> exact_radiance(const Wood& wood, Leaf leaf, const std::vector<Ray>& rays, uint32_t paths) {
  Pcg32 rng(23);
  const std::array<Leaf, 3> coefficients{leaf, Leaf{kBark, 0}, Leaf{kGround, 0}};
  const auto path = [&](Vec3 origin, Dir direction) {
    uint32_t on = DoubleTracer::kNothing;
    double carried = 1, sum = 0;
    for (int node = 0; node < 64; ++node) {
      const auto met = wood.exact->meet(origin, direction, on);
      if (met.triangle == DoubleTracer::kNothing) return sum + (direction.z > 0 ? carried * kSkyRadiance : 0);
      on = met.triangle;
      origin = origin + direction * met.distance;
      const auto& q = wood.exact->triangle(on);
      Dir normal = normalized(cross(q.b - q.a, q.c - q.a));
      if (dot(normal, direction) > 0) normal = -normal;
      const Leaf here = coefficients[wood.material[on]];
      const double cosine = dot(normal, kSun), scattered = cosine > 0 ? here.reflectance : here.transmittance;
      if (scattered > 0 && wood.exact->meet(origin, kSun, on, INFINITY, true).triangle == DoubleTracer::kNothing)
        sum += carried * scattered / kPi * std::fabs(cosine) * kSunIrradiance;
      const double albedo = here.reflectance + here.transmittance;
      const bool through = rng.uniform() * albedo >= here.reflectance;
      const double z = std::sqrt(rng.uniform()), r = std::sqrt(1 - z * z), turn = 2 * kPi * rng.uniform();
      const Frame frame = Frame::around(through ? -normal : normal);
      direction = normalized(frame.x * (r * std::cos(turn)) + frame.y * (r * std::sin(turn)) + frame.z * z);
      carried *= albedo;
    }
    return sum;
  };
  std::vector<double> means;
  for (const Ray& view : rays) {
    double sum = 0;
    for (uint32_t s = 0; s < paths; ++s) sum += path(view.origin, view.direction);
    means.push_back(sum / paths);
  }
  return means;
}

class CrownRadiance : public testing::TestWithParam<Leaf> {};

// Renderers of single precision with large offsets let light through where facets touch and come out 0.1 % brighter.
TEST_P(CrownRadiance, IsThatOfPlainPathTracingInDouble) {
  const Leaf leaf = GetParam();
  const bool longer = std::getenv("SUITE_LONG");
  // The same lines of sight for both: only what the paths do afterwards is compared.
  const std::vector<Ray> rays = views(longer ? 100000 : 1300, 29);
  SourceSpecs sources;
  sources.add(SunSpec{kSun, 0, Curve::constant(kSunIrradiance)});
  sources.add(uniform_sky(kSkyRadiance, false));
  PipelineOptions options;
  options.max_nodes = 64;
  const uint32_t paths = longer ? 128 : 64;
  const Rendered ours =
      render(wood().with(leaf), sources, std::make_unique<RaySensor>(rays, one_band(), paths), options);
  const std::vector<double> theirs = exact_radiance(wood(), leaf, rays, paths);
  RunningStats difference, level;
  for (size_t i = 0; i < rays.size(); ++i) difference.add(ours.result.radiance[i] - theirs[i]), level.add(theirs[i]);
  const double relative = difference.mean() / level.mean(), error = difference.stderr_of_mean() / level.mean();
  std::printf("leaf %.2f/%.2f: ours - double = %+.4f +- %.4f %% of %.5f\n", leaf.reflectance, leaf.transmittance,
              100 * relative, 100 * error, level.mean());
  EXPECT_LE(std::fabs(relative), 3.3 * error);  // two-sided 0.1 %
  EXPECT_LE(error, longer ? 2e-4 : 2e-3);       // sharp enough to tell
}

INSTANTIATE_TEST_SUITE_P(Leaves, CrownRadiance, testing::Values(Leaf{0.45, 0.45}, Leaf{0.5, 0}));

}  // namespace
}  // namespace suite::test::crown_test
