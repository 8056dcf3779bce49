// Continuations that are guided to light which glossy surfaces throw (gloss_guide.h): densities are those of what is
// drawn, means are those of paths that nobody guides, under every kind of small light and in every kernel; there is far
// less noise, and nothing where nothing is glossy.
#include <gtest/gtest.h>

#include <cmath>

#include "light/environment.h"
#include "math/direction_test.h"
#include "tests/support/lamps_kit.h"
#include "tests/support/media_kit.h"
#include "transport/gloss_guide.h"

namespace suite::test::gloss_guide_test {
namespace {

constexpr double kSigmas = 4.5;  // less than 1e-5 a comparison by chance
const Dir kToSun = dir_from_angles(0.6, 1);

double number(uint64_t a, uint64_t b) { return unit_double(hash_of(0x74657374ull, a, b)); }

// Photons that a ball at (0, 0, 1) has thrown on the plane z = 0, whose heights differ by rounding only, and some that
// have met a post.
std::vector<GlossPhoton> thrown(uint64_t seed, size_t count) {
  std::vector<GlossPhoton> photons;
  for (uint64_t i = 0; photons.size() < count; ++i) {
    const double z = -number(seed, 4 * i), phi = 2 * kPi * number(seed, 4 * i + 1), r = std::sqrt(1 - z * z);
    const Dir normal{r * std::cos(phi), r * std::sin(phi), z};
    const Vec3 from = Vec3{0, 0, 1} + normal * 0.8;
    Vec3 place{1.5 + 0.5 * number(seed, 4 * i + 2), 0.4 * number(seed, 4 * i + 3), i % 2 ? 1e-17 : -1e-17};
    if (i % 40 == 0) place.z = 0.2 * number(seed, 4 * i + 2);
    if (dot(normal, place - from) > 0) photons.push_back({place, from, normal, 1e-4f, 3});
  }
  return photons;
}

// turn: of the directions that are judged, rad.
DirectionHistogram::Verdict judge(const GlossGuide::Cell& cell, Vec3 place, double turn) {
  constexpr uint64_t kDraws = 20000;
  std::vector<Dir> pilot;
  for (uint64_t i = 0; i < kDraws / 4; ++i) pilot.push_back(cell.draw(place, {number(91, i), number(92, i)}));
  DirectionHistogram histogram(pilot, 200);
  for (uint64_t i = 0; i < kDraws; ++i) histogram.add(cell.draw(place, {number(93, i), number(94, i)}));
  const double c = std::cos(turn), s = std::sin(turn);
  return histogram.judge(
      [&](Dir in) {
        return double{cell.density(place, {c * in.x - s * in.z, in.y, s * in.x + c * in.z})};
      },
      kDraws);
}

TEST(GlossGuide, DensityIsThatOfItsDraws) {
  const GlossGuide guide(thrown(1, 2000));
  // The last place is below the plane: photons come from both sides of their facing planes there.
  for (const Vec3 place : {Vec3{1.6, 0.1, 0}, Vec3{1.9, 0.3, 0}, Vec3{1.75, 0.2, -0.005}}) {
    const GlossGuide::Cell* cell = guide.at(place);
    ASSERT_TRUE(cell) << place.x;
    const auto verdict = judge(*cell, place, 0);
    EXPECT_NEAR(verdict.mass, 1, 2e-3);
    EXPECT_GT(verdict.p_value, 1e-4);
    // A density of other directions would be noticed.
    EXPECT_LT(judge(*cell, place, 0.02).p_value, 1e-6);
  }
}

// Bug: cells were parted among photons of one plane, by the rounding of their heights, and half of them never found.
TEST(GlossGuide, PlanesAreNotPartedByRounding) {
  const GlossGuide guide(thrown(2, 2000));
  double share = 0;
  size_t found = 0;
  for (uint64_t i = 0; i < 1000; ++i) {
    const GlossGuide::Cell* cell = guide.at({1.55 + 0.4 * number(5, i), 0.05 + 0.3 * number(6, i), 1e-9});
    if (cell && cell->share() > 0) ++found, share += cell->share();
  }
  EXPECT_GT(found, 950u);
  // 2000 photons of 1e-4 W on 0.2 m2, under a light of 3 W/m2, over that and a tenth: 0.77, at most a half.
  EXPECT_GT(share / static_cast<double>(found), 0.45);
  EXPECT_FALSE(guide.at({4, 0, 0}));
}

TEST(GlossGuide, PhotonsOfOnePlace) {
  std::vector<GlossPhoton> photons(100, {{1, 2, 3}, {1, 2, 4}, {0, 0, -1}, 1, 1});
  const GlossGuide guide(photons);
  const GlossGuide::Cell* cell = guide.at({1, 2, 3});
  ASSERT_TRUE(cell);
  const Dir in = cell->draw({1, 2, 3}, {0.3, 0.4});
  EXPECT_GT(in.z, 0.999);
  EXPECT_TRUE(std::isfinite(cell->density({1, 2, 3}, in)));
  EXPECT_GT(cell->density({1, 2, 3}, in), 1e3f);
}

ModelSpec metal(double roughness) {
  const Curve gold({0.4, 0.5, 0.6, 1.0}, {0.38, 0.5, 0.9, 0.97}, Outside::hold);
  return {"ggx", {{"roughness", roughness}}, {{"f0", gold}}, {}, nullptr};
}

// A ball of rough metal over a plane, or something else; with a ball of thin haze far off, or without.
std::shared_ptr<Scene> ball_over_plane(ModelSpec ball, bool haze = false) {
  auto scene = std::make_shared<Scene>();
  scene->materials = {material("ground", lambert(0.5)), material("ball", std::move(ball)),
                      material("pane", lambert(0))};
  place(*scene, PrimitiveKind::plane, {40, 40}, 0);
  place(*scene, PrimitiveKind::sphere, {1}, 1, translation({0, 0, 1}));
  place(*scene, PrimitiveKind::plane, {0.3, 0.3}, 2, translation(kToSun * 5) * rotation({1, 0, 0}, kPi));
  if (haze) {
    scene->media = {medium(Curve::constant(0.1), Curve::constant(0.1), hg(0.3))};
    scene->materials.push_back(boundary(0));
    place(*scene, PrimitiveKind::sphere, {0.5}, 3, translation({5, 0, 1}));
  }
  check_scene(*scene, "ball over plane");
  return scene;
}

using Bands = std::vector<Repeated>;
// Of the ground on the lit side of the ball.
Bands run(const std::shared_ptr<Scene>& scene, const SourceSpecs& sources, bool guided, uint32_t paths, uint64_t seed) {
  PipelineOptions options;
  if (!guided) options.gloss_photons = 0;
  options.seed = seed;
  std::vector<Band> bands;
  for (const double center : {0.42, 0.6, 0.88}) bands.push_back(Band::rectangular("b", center, 0.01));
  const Dir aside = normalized(Vec3{kToSun.x, kToSun.y, 0});
  const Vec3 from = aside * 5 + Vec3{0, 0, 6};
  const Ray ray{from, normalized(aside * 1.6 - from), 0};
  const auto done = render(scene, sources, std::make_unique<RaySensor>(repeated(ray), bands, paths, 0.01), options);
  EXPECT_EQ(done.report.statistics.failures, 0u);
  Bands result;
  for (size_t b = 0; b < bands.size(); ++b) result.push_back(over_problems(done.result, b));
  return result;
}

// Means must be the same, and known so well that `seen` of them would be seen; the noise of equal paths, in the first
// band, less than `noise` of that without.
void expect_same(const std::shared_ptr<Scene>& scene, const SourceSpecs& sources, double seen, double noise) {
  const Bands guided = run(scene, sources, true, 1 << 10, 1), other = run(scene, sources, false, 1 << 10, 2);
  for (size_t b = 0; b < guided.size(); ++b) {
    const double sum = kSigmas * std::hypot(guided[b].error, other[b].error);
    EXPECT_NEAR(guided[b].mean, other[b].mean, sum) << b;
    EXPECT_LT(sum, seen * other[b].mean) << b;
  }
  EXPECT_LT(guided[0].error, noise * other[0].error);
}

SourceSpecs sun_and_sky(double half_angle) {
  SourceSpecs sources;
  sources.add(SunSpec{kToSun, half_angle, Curve::constant(3)});
  sources.add(uniform_sky(0.1, true));
  return sources;
}

TEST(GlossGuide, SameMeansUnderCollimatedLight) { expect_same(ball_over_plane(metal(0.1)), sun_and_sky(0), 0.02, 0.5); }
TEST(GlossGuide, SameMeansUnderADisk) { expect_same(ball_over_plane(metal(0.1)), sun_and_sky(0.02), 0.02, 0.5); }
TEST(GlossGuide, SameMeansAmongMedia) { expect_same(ball_over_plane(metal(0.1), true), sun_and_sky(0), 0.02, 0.5); }
TEST(GlossGuide, SameMeansUnderLamps) {
  SourceSpecs point, pane;
  point.add(point_lamp({kToSun * 4.5}, 30));
  pane.add(glow("pane", 100));
  expect_same(ball_over_plane(metal(0.1)), point, 0.03, 0.5);
  expect_same(ball_over_plane(metal(0.1)), pane, 0.02, 0.5);
}

// A mirror beside a floor: the light of the sun's disk comes to it twice. Paths meet the disk behind the mirror by
// chance only: L = rho / pi E cos(z) (1 + R). Of 4096 paths by chance 0.16 would meet it.
TEST(GlossGuide, MirrorsThrowLightOfADisk) {
  constexpr double kRho = 0.5, kR = 0.8, kHalfAngle = 0.0047;
  auto scene = std::make_shared<Scene>();
  scene->materials = {material("floor", lambert(kRho)),
                      material("mirror", {"mirror", {}, {{"reflectance", Curve::constant(kR)}}, {}, nullptr})};
  place(*scene, PrimitiveKind::plane, {40, 40}, 0);
  place(*scene, PrimitiveKind::plane, {6, 6}, 1, translation({-1, 0, 3}) * rotation({0, 1, 0}, kPi / 2));
  check_scene(*scene, "mirror");
  const Dir to_sun = normalized(Vec3{1, 0.1, 1});
  SourceSpecs sources;
  sources.add(SunSpec{to_sun, kHalfAngle, Curve::constant(3)});
  const auto look = [] {
    return std::make_unique<RaySensor>(repeated({{0.2, 0, 2}, normalized(Vec3{-0.2, 0, -2}), 0}), one_band(), 1 << 10);
  };
  const Repeated seen = over_problems(render(scene, sources, look()).result, 0);
  EXPECT_NEAR(seen.mean, kRho / kPi * 3 * to_sun.z * (1 + kR), kSigmas * seen.error);
  EXPECT_LT(seen.error, 0.003 * seen.mean);
  PipelineOptions off;
  off.gloss_photons = 0;
  EXPECT_GT(over_problems(render(scene, sources, look(), off).result, 0).error, 5 * seen.error);
}

TEST(GlossGuide, NothingWhereNothingIsGlossy) {
  SpectralState state = make_state(one_band(), 0.01, 0, 1);
  const auto count = [&](ModelSpec ball) {
    const auto scene = ball_over_plane(std::move(ball));
    const Tracer tracer(scene);
    const Optics optics(*scene, state);
    const Surface surface(tracer, optics);
    return gloss_photons(surface, optics, bake_environment(sun_and_sky(0), tracer, false, optics.state()), 32768)
        .size();
  };
  EXPECT_EQ(count(lambert(0.5)), 0u);
  EXPECT_EQ(count(lambert(0.4, 0.4)), 0u);
  // Collimated light that a mirror throws is found by no path.
  EXPECT_EQ(count({"mirror", {}, {{"reflectance", Curve::constant(1)}}, {}, nullptr}), 0u);
  EXPECT_GT(count(metal(0.1)), 1000u);
}

}  // namespace
}  // namespace suite::test::gloss_guide_test
