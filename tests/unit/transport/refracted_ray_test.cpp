// Derivatives of rays that smooth interfaces bend, against differences of rays that are traced beside.
#include "transport/refracted/sight.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <vector>

#include "optics/models.h"
#include "scene/scene.h"
#include "tests/support/media_kit.h"

namespace suite::test::refracted_ray_test {
namespace {

constexpr double kIndex = 1.5;

ModelSpec smooth(double index) { return {"dielectric", {}, {{"index", Curve::constant(index)}}, {}, nullptr}; }

struct World {
  explicit World(std::shared_ptr<Scene> s)
      : scene(std::move(s)),
        tracer(scene),
        optics(*scene, make_state(one_band(), 0.01, 0, 4)),
        surface(tracer, optics),
        interfaces(*scene, optics) {}
  std::shared_ptr<Scene> scene;
  Tracer tracer;
  Optics optics;
  Surface surface;
  SmoothInterfaces interfaces;

  // Through as many interfaces, of which `mirrors` (a bit each) reflect; nothing where there are fewer.
  std::optional<BentRay> run(Vec3 from, const Frame& across, int crossings, uint32_t mirrors = 0) {
    BentRay ray = BentRay::from(from, across);
    Interaction at, beside;
    TraceStatistics statistics;
    Vec3 origin = from;
    for (int i = 0; i < crossings; ++i) {
      const Ray r{origin, ray.direction, 0};
      Hit hit;
      tracer.nearest({&r, 1}, {&hit, 1}, false, statistics);
      if (!hit.hit()) return std::nullopt;
      surface.interact(hit, -ray.direction, at);
      const NormalTurn turn = normal_turn(surface, hit, -ray.direction, at, beside);
      if (mirrors >> i & 1 ? !reflect(ray, hit, at, turn) : !bend(ray, hit, at, interfaces.index(at.material, 0), turn))
        return std::nullopt;
      origin = tracer.leave(hit, ray.direction);
    }
    return ray;
  }
  // Largest difference of derivatives from central differences of step h, over the size of the derivatives.
  double error(Vec3 from, Dir towards, int crossings, double h, uint32_t mirrors = 0) {
    const Frame across = Frame::around(normalized(towards));
    const auto ray = run(from, across, crossings, mirrors);
    if (!ray) return INFINITY;
    double off = 0, size = 0;
    for (int i : {0, 1}) {
      const Vec3 step = (i ? across.y : across.x) * h;
      const auto more = run(from, Frame::around(normalized(across.z + step)), crossings, mirrors),
                 less = run(from, Frame::around(normalized(across.z - step)), crossings, mirrors);
      if (!more || !less) return INFINITY;
      const Vec3 difference = (more->direction - less->direction) / (2 * h);
      off = std::fmax(off, length(difference - ray->d_direction[i]));
      size = std::fmax(size, length(difference));
    }
    return off / size;
  }
};

std::shared_ptr<Scene> exact(PrimitiveKind kind, std::vector<double> parameters, const Affine3& where = {}) {
  auto scene = std::make_shared<Scene>();
  scene->materials = {material("glass", smooth(kIndex))};
  place(*scene, kind, std::move(parameters), 0, where);
  check_scene(*scene, "exact");
  return scene;
}

TEST(RefractedRay, IndicesComeFromTheModel) {
  auto scene = std::make_shared<Scene>();
  const auto of = [](ModelSpec spec) { return material("m", std::move(spec)); };
  const Curve dispersive({0.4, 0.7}, {1.36, 1.32}, Outside::hold);
  scene->materials = {of(smooth(1.33)),
                      of(lambert(0.5)),
                      of({"dielectric", {}, {{"index", dispersive}}, {}, nullptr}),
                      of({"mirror", {}, {{"reflectance", Curve::constant(0.9)}}, {}, nullptr}),
                      of(smooth(1 + 1e-6)),
                      of(smooth(1))};
  scene->groups.push_back({"root", {}});
  const std::vector<Band> wide{Band::rectangular("a", 0.55, 0.2)};
  const Optics optics(*scene, make_state(wide, 0.01, 0, 4));
  const SmoothInterfaces interfaces(*scene, optics);
  EXPECT_TRUE(interfaces.has(0) && interfaces.has(2) && interfaces.has(4) && interfaces.has(5));
  EXPECT_FALSE(interfaces.has(1) || interfaces.has(3) || interfaces.has(kNone));
  EXPECT_NEAR(interfaces.index(0, 0), 1.33, 1e-6);  // curves are float
  EXPECT_NEAR(interfaces.index(4, 0), 1 + 1e-6, 1e-7);
  ASSERT_EQ(interfaces.set_of().size(), optics.state().knots.size());
  EXPECT_EQ(interfaces.set_of()[0], 0u);
  EXPECT_EQ(interfaces.set_of()[1], 1u) << "the dispersive one parts them";
}

TEST(RefractedRay, ExactSurfaces) {
  // Rays leave a surface some float steps off it, derivatives on it: seen at the second interface.
  constexpr double kOffSurface = 1e-5;
  const Affine3 turned = translation({0.1, 0.2, 2}) * rotation(normalized(Vec3{1, 2, 3}), 0.7);
  const Dir up = normalized(Vec3{0.05, 0.1, 1});
  World ball(exact(PrimitiveKind::sphere, {0.5}, turned));
  EXPECT_LT(ball.error({}, up, 1, 1e-5), 1e-7);
  EXPECT_LT(ball.error({}, up, 2, 1e-5), kOffSurface);
  EXPECT_LT(ball.error({}, up, 1, 1e-5, 1), 1e-7) << "reflected outside";
  EXPECT_LT(ball.error({}, up, 4, 1e-5, 6), kOffSurface) << "twice inside";
  World rod(exact(PrimitiveKind::cylinder, {0.4, 3, 1}, translation({0.1, 1.5, 2}) * rotation({1, 0, 0}, kPi / 2)));
  EXPECT_LT(rod.error({}, up, 2, 1e-5), kOffSurface);
  World cone(exact(PrimitiveKind::cone, {0.5, 0.2, 3, 1}, translation({0.1, 1.5, 2}) * rotation({1, 0, 0}, kPi / 2)));
  EXPECT_LT(cone.error({}, up, 2, 1e-5), kOffSurface);
  World waves(exact(PrimitiveKind::sinusoid, {20, 20, 0.05, 4, 3, 0.2, 0.02, -9, 5, 0.1}, translation({0, 0, 2})));
  EXPECT_LT(waves.error({}, up, 1, 1e-5), 1e-6);
  EXPECT_LT(waves.error({0, 0, 4}, -up, 1, 1e-5), 1e-6);
  World pane(exact(PrimitiveKind::box, {0, 0, 1, 0, 0, 1.1}));
  EXPECT_LT(pane.error({}, normalized(Vec3{1, 0.2, 0.8}), 2, 1e-5), 1e-7);
}

// Straight through a pane the direction stays, and so does the spread of directions.
TEST(RefractedRay, PaneChangesNoDirection) {
  World pane(exact(PrimitiveKind::box, {0, 0, 1, 0, 0, 1.1}));
  const Frame across = Frame::around(normalized(Vec3{0.5, 0.2, 0.8}));
  const auto ray = pane.run({}, across, 2);
  ASSERT_TRUE(ray);
  EXPECT_LT(length(ray->direction - across.z), 1e-14);
  EXPECT_LT(length(ray->d_direction[0] - across.x), 1e-13);
  EXPECT_LT(length(ray->d_direction[1] - across.y), 1e-13);
}

TEST(RefractedRay, TotalReflectionIsNoWay) {
  World water(exact(PrimitiveKind::plane, {0, 0}, translation({0, 0, 1})));
  const double critical = std::asin(1 / kIndex);
  EXPECT_TRUE(water.run({}, Frame::around(dir_from_angles(critical - 1e-6, 0)), 1));
  EXPECT_FALSE(water.run({}, Frame::around(dir_from_angles(critical + 1e-6, 0)), 1));
}

TEST(RefractedRay, UnbentIsTheOtherWayRound) {
  const Dir n{0, 0, 1}, beyond = dir_from_angles(1.2, 0.7);
  const auto inside = unbent(beyond, n, 1 / kIndex);
  ASSERT_TRUE(inside);
  EXPECT_NEAR(std::sin(polar_angle(*inside)) * kIndex, std::sin(1.2), 1e-14);
  World water(exact(PrimitiveKind::plane, {0, 0}, translation({0, 0, 1})));
  const auto out = water.run({}, Frame::around(*inside), 1);
  ASSERT_TRUE(out);
  EXPECT_LT(length(out->direction - beyond), 1e-6);  // the model's index is float
  EXPECT_FALSE(unbent(dir_from_angles(1.2, 0.7), n, kIndex));
}

// Vertex normals of a dome, and the same shape flat: places and barycentrics are float, and so are differences.
TEST(RefractedRay, Meshes) {
  const auto scene = [](bool normals) {
    auto s = scene_of({dome(4)}, {material("glass", smooth(kIndex))});
    Mesh& m = s->meshes[0];
    std::vector<uint32_t> packed;
    for (size_t i = 0; i < m.vertex_count(); ++i)
      packed.push_back(oct_encode(
          normalized(Vec3{2 * double{m.positions[3 * i]} / 40, 2 * double{m.positions[3 * i + 1]} / 40, 1})));
    if (normals) m.normals = std::move(packed);
    return s;
  };
  World round(scene(true)), flat(scene(false));
  const Vec3 from{0.313, 0.272, -1};
  const Dir up = normalized(Vec3{0.05, 0.1, 1});
  EXPECT_LT(round.error(from, up, 1, 2e-4), 5e-3);
  EXPECT_LT(flat.error(from, up, 1, 2e-4), 1e-3);
  const Frame across = Frame::around(up);
  const double bent = length(round.run(from, across, 1)->d_direction[0] - flat.run(from, across, 1)->d_direction[0]);
  EXPECT_GT(bent, 1e-2) << "negative control: curvature shows";
}

// ---- ways to a far light

// All ways from a place to a far light: each ray of the search is traced as it asks for it.
std::vector<RefractedWay> find(World& w, RefractedSight& sight, Vec3 from, Dir light, uint64_t seed) {
  RefractedSearch search;
  WayStart node;
  node.place = from;
  TraceStatistics statistics;
  Hit hit;
  for (bool waits = sight.begin(search, node, {light, {}}, 0, seed); waits; waits = sight.step(search, hit))
    w.tracer.nearest({&search.leg.ray, 1}, {&hit, 1}, false, statistics);
  return {search.all().begin(), search.all().end()};
}

// Mean over seeds of spreading x trials: over all ways, of solid angle at the node a solid angle at the light.
double mean_spreading(World& w, Vec3 from, Dir light, int seeds, int crossings) {
  RefractedSight sight(w.surface, w.optics);
  double sum = 0;
  for (int seed = 0; seed < seeds; ++seed) {
    for (const RefractedWay& way : find(w, sight, from, light, mix64(static_cast<uint64_t>(seed)))) {
      if (way.mirrors() != 0) continue;
      EXPECT_EQ(way.events, crossings);
      EXPECT_FALSE(way.doubtful);
      sum += way.spreading * way.trials;
    }
  }
  return sum / seeds;
}

TEST(RefractedSight, FlatWaterHasOneWay) {
  World water(exact(PrimitiveKind::plane, {0, 0}, translation({0, 0, 1})));
  RefractedSight sight(water.surface, water.optics);
  for (const double zenith : {0.0, 0.5, 1.0, 1.3, 1.55}) {
    const Dir light = dir_from_angles(zenith, 0.3);
    const double n = sight.interfaces().index(0, 0), inside = std::asin(std::sin(zenith) / n);
    const auto ways = find(water, sight, {}, light, 7);
    ASSERT_EQ(ways.size(), 1u) << zenith;
    const double spreading = ways[0].spreading;
    EXPECT_LT(length(ways[0].direction - dir_from_angles(inside, 0.3)), 1e-8);
    EXPECT_NEAR(spreading, std::cos(zenith) / (n * n * std::cos(inside)), 1e-7);
    // Every start finds it.
    EXPECT_NEAR(mean_spreading(water, {}, light, 200, 1) / spreading, 1, 0.12) << zenith;
  }
  EXPECT_TRUE(find(water, sight, {}, dir_from_angles(100 * kDegree, 0), 7).empty());
}

// Each sequence of faces that reflect is one way, found with a probability of its own; each counts once in the mean.
TEST(RefractedSight, ReflectionsInAPane) {
  World pane(exact(PrimitiveKind::box, {0, 0, 1, 0, 0, 1.1}));
  RefractedSight sight(pane.surface, pane.optics);
  constexpr int kSeeds = 20000;
  double counted[3] = {};  // without, with two, with four reflections
  for (uint64_t seed = 0; seed < kSeeds; ++seed)
    for (const RefractedWay& way : find(pane, sight, {}, dir_from_angles(75 * kDegree, 1), mix64(seed))) {
      const int mirrors = std::popcount(way.mirrors());
      EXPECT_EQ(way.events, 2 + mirrors);
      EXPECT_NEAR(way.spreading, 1, 1e-6);
      if (mirrors < 6) counted[mirrors / 2] += way.trials / kSeeds;
    }
  EXPECT_NEAR(counted[0], 1, 1e-12) << "every start finds it";
  EXPECT_NEAR(counted[1], 1, 0.12);  // found with p = 0.1: 4 errors
  EXPECT_NEAR(counted[2], 1, 0.9);   // with 0.015, one in three of them followed up
}

// Behind the focus of a ball three ways cross in the plane of the axis; all of them count. The reference adds up what
// rays started on a fine lattice of directions find by their own spreading.
TEST(RefractedSight, AllWaysThroughABallCount) {
  World ball(exact(PrimitiveKind::sphere, {0.4}, translation({0, 0, 1.5})));
  const Dir light = normalized(Vec3{0.02, 0.01, 1});
  // Density of ends by counting: solid angle of starts whose ends lie in a small cone about the light.
  const double reach = 0.45, cone = 0.01;
  constexpr int n = 1500;
  double expected = 0;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      const double x = ((i + 0.5) / n * 2 - 1) * reach, y = ((j + 0.5) / n * 2 - 1) * reach;
      const auto ray = ball.run({}, Frame::around(normalized(Vec3{x, y, 1})), 2);
      if (ray && length(ray->direction - light) < cone)
        expected += std::pow(1 + x * x + y * y, -1.5) * std::pow(2 * reach / n, 2) / (kPi * cone * cone);
    }
  double sum = 0;
  constexpr int m = 64;
  for (int k = 0; k < m; ++k) {  // lights spread over the same cone
    const double r = cone * std::sqrt((k + 0.5) / m), phi = 2.399963 * k;
    const Frame about = Frame::around(light);
    const Dir to = normalized(about.z + about.x * (r * std::cos(phi)) + about.y * (r * std::sin(phi)));
    sum += mean_spreading(ball, {}, to, 64, 2) / m;
  }
  EXPECT_NEAR(sum, expected, 0.05 * expected);
}

}  // namespace
}  // namespace suite::test::refracted_ray_test
