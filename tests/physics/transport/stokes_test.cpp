// Polarisation along whole paths: closed forms and invariances.
#include <gtest/gtest.h>

#include <complex>
#include <optional>

#include "light/kinds/sky.h"
#include "math/instrument_frame.h"
#include "math/warps.h"
#include "optics/fresnel_mueller.h"
#include "spectral/planck.h"
#include "tests/support/lamps_kit.h"
#include "tests/support/stokes_kit.h"

namespace suite::test::stokes_test {
namespace {

// Standard errors of 4 or 8 groups of samples: Student's t of 3 degrees is beyond 12 with a probability of 1.2e-3, of 7
// with 6e-6.
constexpr double kSignificant = 12;

ModelSpec dielectric(double index) { return {"dielectric", {}, {{"index", Curve::constant(index)}}, {}, nullptr}; }
ModelSpec metal(double roughness) {
  return {"ggx", {{"roughness", roughness}}, {{"n", Curve::constant(1.39)}, {"k", Curve::constant(7.65)}}, {}, nullptr};
}
SourceSpecs sky(bool full_sphere) {
  SourceSpecs sources;
  sources.add(uniform_sky(1, full_sphere));
  return sources;
}
// Looks at the origin along an angle from the vertical, from the side of -x turned about z.
Ray towards_origin(double angle, double azimuth = 0) {
  const Dir d = dir_from_angles(kPi - angle, azimuth);
  return {Vec3{} - d * 5, d, 0};
}
void expect_near(const StokesSeen& seen, const Stokes& wanted, double tolerance) {
  for (size_t c = 0; c < 4; ++c)
    EXPECT_NEAR(seen.S[c], wanted[c], tolerance + kSignificant * seen.error[c]) << "IQUV"[c];
}

const double kBrewster = std::atan(1.5);

// Glass over nothing, under an even sky: (R_p + R_s)/2 of it, polarised across the plane of incidence (Born & Wolf,
// section 1.5). What is refracted goes down into the dark.
TEST(Stokes, GlassReflectsAsFresnelSays) {
  const auto scene = scene_of({quad(100, 0, 0)}, {material("glass", dielectric(1.5))});
  for (const double angle : {0.0, 20 * kDegree, kBrewster, 75 * kDegree}) {
    const PlaneBlocks F = fresnel_reflection(std::cos(angle), 1.5);
    for (const double azimuth : {0.0, 1.0, 2.5}) {
      const auto seen = see_stokes(scene, sky(false), {towards_origin(angle, azimuth)}, 256);
      expect_near(seen[0], {F.a, F.b, 0, 0}, 1e-6);
      EXPECT_NEAR(seen[0].S[1] * F.a, F.b * seen[0].S[0], 1e-6) << "the ratio has no noise";
      EXPECT_EQ(seen[0].depolarised, 0);
    }
  }
}
// Behind a polarizer: Malus, I/2 (1 + cos 2 (angle - AoLP)) of fully polarised light; two crossed ones pass nothing,
// and an analyser of Q = U = 0 light half of it at any angle.
TEST(Stokes, AnalysersObeyMalus) {
  const auto scene = scene_of({quad(100, 0, 0)}, {material("glass", dielectric(1.5))});
  const auto whole = see_stokes(scene, sky(false), {towards_origin(kBrewster)}, 256)[0];
  for (const double angle : {0.0, 30 * kDegree, 90 * kDegree, 135 * kDegree}) {
    Polarimetry how;
    how.analyser = polarizer(angle);
    const auto seen = see_stokes(scene, sky(false), {towards_origin(kBrewster)}, 256, how)[0];
    EXPECT_NEAR(seen.S[0], whole.S[0] * std::pow(std::cos(angle - kPi / 2), 2), 1e-7) << angle;
  }
  Polarimetry how;
  how.analyser = polarizer(1) * polarizer(1 + kPi / 2);
  EXPECT_NEAR(see_stokes(scene, sky(true), {towards_origin(0.5)}, 64, how)[0].S[0], 0, 1e-7);
  how.analyser = polarizer(0) * polarizer(kPi / 4) * polarizer(kPi / 2);
  EXPECT_NEAR(see_stokes(scene_of({quad(1, 50, 0)}, {material("black", lambert(0))}), sky(true),
                         {{{0, 0, 0}, {1, 0, 0}, 0}}, 64, how)[0]
                  .S[0],
              0.125, 1e-6);
}
// Polarised lamps: a glowing wall seen directly, in a mirror and through polarizers. Closed forms: the lamp's Stokes
// vector turned from its axis into the meridian; then Fresnel's matrix.
const Stokes kOfLamps{1, 0.5, -0.6, 0.3};
// A sky from a table, seen by itself and thrown up by a pane: met by chance, as smooth surfaces meet all light.
TEST(Stokes, SkiesArePolarisedAsTheySay) {
  SkySpec sky;
  sky.radiance = Curve::constant(2);
  sky.table = {1, 1, 1, 1, 0.5, 1, 2, 1}, sky.zeniths = 2, sky.azimuths = 4;
  sky.stokes =
      SkyStokes{{0.3, 0.3, 0.3, 0.3, 0.3, 0.3, 0.3, 0.3}, {-0.2, -0.2, -0.2, -0.2, -0.2, -0.2, -0.2, -0.2}, 2, 4};
  SourceSpecs sources;
  sources.add(sky);
  const auto open = scene_of({quad(1, -50, 0)}, {material("far", lambert(0))});
  const auto pane = scene_of({quad(100, 0, 0)}, {material("glass", dielectric(1.5))});
  for (const auto& [angle, turn] : {std::pair{0.3, 0.4}, std::pair{kBrewster, 2.0}, std::pair{1.2, -1.0}}) {
    const Dir up = dir_from_angles(angle, turn);
    const StokesSeen direct = see_stokes(open, sources, {{{}, up, 0}}, 16)[0];
    EXPECT_NEAR(direct.S[1], 0.3 * direct.S[0], 1e-6);
    EXPECT_NEAR(direct.S[2], -0.2 * direct.S[0], 1e-6);
    const Ray ray = {Vec3{0, 0, 1} - Vec3{up.x, up.y, 0}, Dir{up.x, up.y, -up.z}, 0};
    const Stokes thrown =
        ScatteringPlane(-ray.direction, up).matrix(fresnel_reflection(std::cos(angle), 1.5)) * Stokes{1, 0.3, -0.2, 0};
    const StokesSeen mirrored = see_stokes(pane, sources, {ray}, 256)[0];
    for (size_t k = 1; k < 4; ++k)
      EXPECT_NEAR(mirrored.S[k] * thrown[0], thrown[k] * mirrored.S[0], 1e-6) << "the ratio has no noise";
  }
}

TEST(Stokes, LampsArePolarisedAsTheySay) {
  const Stokes given = kOfLamps;
  LampSpec lamp = glow("shine", 2, true);
  lamp.stokes = given, lamp.stokes_axis = Dir{0, 1, 0};
  SourceSpecs sources;
  sources.add(lamp);
  const auto turned = [&](Dir k) { return frame_rotation(frame_about(k, {0, 1, 0}), meridian_frame(k).e1) * given; };
  const auto wall = scene_of({quad(100, 3, 0)}, {material("shine", lambert(0))});
  const auto mirror =
      scene_of({quad(100, 0, 1), quad(100, 3, 0)}, {material("shine", lambert(0)), material("glass", dielectric(1.5))});
  for (const auto& [angle, turn] : {std::pair{0.3, 0.4}, std::pair{kBrewster, 2.0}, std::pair{1.2, -1.0}}) {
    const Dir up = dir_from_angles(angle, turn);
    Stokes direct = turned(-up);
    for (double& s : direct) s *= 2;
    expect_near(see_stokes(wall, sources, {{{}, up, 0}}, 16)[0], direct, 1e-6);
    // From below it goes down and is thrown up: the ray looks down on the pane between.
    const Ray ray = {Vec3{0, 0, 1} - Vec3{up.x, up.y, 0}, Dir{up.x, up.y, -up.z}, 0};
    const Mueller F = ScatteringPlane(-ray.direction, up).matrix(fresnel_reflection(std::cos(angle), 1.5));
    const StokesSeen mirrored = see_stokes(mirror, sources, {ray}, 256)[0];
    const Stokes thrown = F * direct;
    // Whether a path is thrown back is drawn: as many as expected but for two of 256, whatever the scrambles' spread.
    expect_near(mirrored, thrown, 2.0 / 256 * direct[0]);
    for (size_t k = 1; k < 4; ++k)
      EXPECT_NEAR(mirrored.S[k] * thrown[0], thrown[k] * mirrored.S[0], 1e-6) << "the ratio has no noise";
    // Behind a polarizer along its own light, across it, and behind two of them.
    const double axis = 0.5 * std::atan2(direct[2], direct[1]), linear = std::hypot(direct[1], direct[2]);
    for (const double across : {0.0, kPi / 2}) {
      Polarimetry how;
      how.analyser = polarizer(axis + across);
      const double wanted = 0.5 * (direct[0] + (across > 0 ? -linear : linear));
      EXPECT_NEAR(see_stokes(wall, sources, {{{}, up, 0}}, 16, how)[0].S[0], wanted, 1e-6);
      how.analyser = polarizer(axis + across + kPi / 2) * polarizer(axis + across);
      EXPECT_NEAR(see_stokes(wall, sources, {{{}, up, 0}}, 16, how)[0].S[0], 0, 1e-6);
    }
  }
}
// A point over rough metal, from one place: M of the metal times the lamp's vector, with one sample and no noise.
TEST(Stokes, PointsArePolarisedAsTheySay) {
  const Stokes given = kOfLamps;
  const auto floor = scene_of({quad(100, 0, 0)}, {material("metal", metal(0.4))});
  LampSpec point = point_lamp({{1, 2, 3}}, 5);
  const Ray ray = towards_origin(0.6, 0.3);
  const auto lit = [&](const std::optional<Stokes>& stokes) {
    point.stokes = stokes, point.stokes_axis = Dir{0, 1, 0};
    SourceSpecs one;
    one.add(point);
    PipelineOptions once;
    once.max_nodes = 1;
    return see_stokes(floor, one, {ray}, 16, {}, once)[0];
  };
  // The answer is linear in the lamp's light: columns of the matrix from four lamps, in the frame of the lamp's way.
  const StokesSeen even = lit(std::nullopt), q = lit(Stokes{1, 1, 0, 0}), u = lit(Stokes{1, 0, 1, 0}),
                   v = lit(Stokes{1, 0, 0, 1}), mixed = lit(given);
  const Dir to_lamp = normalized(Vec3{1, 2, 3});
  const std::complex<double> index(1.39, 7.65);
  const Dir out = -ray.direction;
  const PlaneBlocks F = fresnel_reflection(dot(out, normalized(out + to_lamp)), index);
  const Mueller M = ScatteringPlane(out, to_lamp).matrix(F * (1 / F.a));
  const Stokes wanted = M * (frame_rotation(frame_about(-to_lamp, {0, 1, 0}), meridian_frame(-to_lamp).e1) * given);
  EXPECT_GT(even.S[0], 0);
  // What several facets do depolarises: it adds to I alone.
  EXPECT_GT(mixed.S[1] * wanted[1], 0);
  for (const size_t k : {2u, 3u})
    EXPECT_NEAR(mixed.S[k] * wanted[1], mixed.S[1] * wanted[k], 1e-6 * even.S[0]) << "IQUV"[k];
  for (size_t k = 0; k < 4; ++k) {
    const double sum = even.S[k] + 0.5 * (q.S[k] - even.S[k]) - 0.6 * (u.S[k] - even.S[k]) + 0.3 * (v.S[k] - even.S[k]);
    EXPECT_NEAR(mixed.S[k], sum, 1e-6 * even.S[0]) << "IQUV"[k];
  }
}
// Turning the camera about its axis turns the angle of polarisation and leaves the rest.
TEST(Stokes, TheImageFrameTurnsWithTheCamera) {
  const auto scene = scene_of({quad(100, 0, 0)}, {material("metal", metal(0.3))});
  SourceSpecs sources;
  sources.add(SunSpec{{dir_from_angles(0.7, 1.0), 0, Curve::constant(1)}});
  const Ray ray = towards_origin(0.8, 0.4);
  StokesSeen seen[2];
  for (const int rolled : {0, 1}) {
    Polarimetry how;
    how.frame = StokesFrame::image;
    const Dir k = -ray.direction;
    const Vec3 up = normalized(Vec3{0, 0, 1} - k * k.z);
    // 30 deg from up towards the left, counter-clockwise as the receiver sees it.
    how.up = rotation(k, rolled * 30 * kDegree).vector(up);
    seen[rolled] = see_stokes(scene, sources, {ray}, 64, how)[0];
  }
  EXPECT_GT(seen[0].dolp(), 0.02);
  EXPECT_NEAR(seen[0].S[0], seen[1].S[0], 1e-9);
  EXPECT_NEAR(seen[0].dolp(), seen[1].dolp(), 1e-6);
  EXPECT_NEAR(std::remainder(seen[0].aolp_deg() - seen[1].aolp_deg() - 30, 180), 0, 1e-4);
  EXPECT_NEAR(seen[0].S[3], seen[1].S[3], 1e-9);
}
// Plates placed where they are, or turned and mirrored by instances into the same place, show one Stokes vector.
TEST(Stokes, InstancesOfOnePlateShowOneStokesVector) {
  SourceSpecs sources;
  sources.add(SunSpec{{dir_from_angles(0.7, 1.0), 0, Curve::constant(1)}});
  std::vector<StokesSeen> seen;
  const Affine3 mirrored{{-1, 0, 0, 0, 1, 0, 0, 0, 1}, {}};
  for (const Affine3& where : {Affine3{}, rotation({0, 0, 1}, 2.0), mirrored, mirrored * rotation({0, 0, 1}, 0.3)}) {
    auto scene = scene_of({quad(100, 0, 0)}, {material("metal", metal(0.3))});
    scene->groups[0].placements[0].to_parent = where;
    seen.push_back(see_stokes(scene, sources, {towards_origin(0.8, 0.4)}, 64)[0]);
  }
  EXPECT_GT(std::fabs(seen[0].S[2]), 1e-4);
  for (const StokesSeen& s : seen)
    for (size_t c = 0; c < 4; ++c) EXPECT_NEAR(s.S[c], seen[0].S[c], 1e-6 * seen[0].S[0]) << "IQUV"[c];
}
// A polarised furnace: with light of radiance 1 from everywhere whatever does not absorb shows (1, 0, 0, 0), although
// what it reflects is polarised, and what it transmits too.
TEST(Stokes, GlassInAFurnaceIsUnpolarised) {
  auto scene = std::make_shared<Scene>();
  scene->materials = {material("glass", dielectric(1.5))};
  place(*scene, PrimitiveKind::sphere, {1}, 0);
  check_scene(*scene, "sphere");
  for (const double height : {0.0, 0.5, 0.9}) {
    const auto seen = see_stokes(scene, sky(true), {{{-5, 0.1, height}, {1, 0, 0}, 0}}, 8192)[0];
    expect_near(seen, {1, 0, 0, 0}, 1e-4);
    EXPECT_LT(seen.error[1], 0.02);
  }
}
// The same of random scenes: spheres of what keeps all light, smooth, rough and matte, that see each other. 20 scenes
// of 24 rays by 4 components at 6 standard errors of 8 groups: by chance one in some thousands of runs fails.
TEST(Stokes, RandomFurnacesAreUnpolarised) {
  Pcg32 random(11);
  const ModelSpec mirror{"mirror", {}, {{"reflectance", Curve::constant(1)}}, {}, nullptr};
  const ModelSpec frosted{"ggx_dielectric", {{"roughness", 0.3}}, {{"index", Curve::constant(1.5)}}, {}, nullptr};
  constexpr uint32_t kPaths = 512;
  double largest = 0;
  for (int world = 0; world < 20; ++world) {
    auto scene = std::make_shared<Scene>();
    scene->materials = {material("glass", dielectric(1 + random.uniform())), material("frosted", frosted),
                        material("mirror", mirror), material("white", lambert(1))};
    for (int i = 0; i < 5; ++i)
      place(*scene, PrimitiveKind::sphere, {0.3 + 0.4 * random.uniform()}, static_cast<uint32_t>(4 * random.uniform()),
            translation({2 * random.uniform() - 1, 2 * random.uniform() - 1, 3.0 * i - 6}));
    check_scene(*scene, "random spheres");
    std::vector<Ray> rays;
    for (int i = 0; i < 24; ++i) {
      const Vec3 at{0.6 * random.uniform() - 0.3, 0.6 * random.uniform() - 0.3, 3.0 * (i % 5) - 6};
      const Dir d = uniform_sphere({random.uniform(), random.uniform()});
      rays.push_back({at - d * 4, d, 0});
    }
    for (const StokesSeen& s : see_stokes(scene, sky(true), rays, kPaths))
      for (size_t k = 0; k < 4; ++k) {
        EXPECT_NEAR(s.S[k], k == 0 ? 1 : 0, kSignificant * s.error[k] + 1.0 / kPaths)
            << "IQUV"[k] << " of world " << world;
        largest = std::max(largest, s.error[k]);
      }
  }
  EXPECT_GT(largest, 1e-3) << "samples are polarised";
}
// Kirchhoff: in a box of 300 K a plate of metal of 300 K shows (B, 0, 0, 0), since what it sends out makes up for what
// it reflects; over a cold sky it is polarised by its own light, in the plane of emission: aluminium at 10 um,
// index 25.3 + 89.8i (Rakic 1998), smooth, at 80 deg (R_s - R_p)/2 over 1 - R is above 0.9.
TEST(Stokes, WarmMetalIsPolarisedByItsOwnLight) {
  const ModelSpec aluminium{
      "ggx", {{"roughness", 0.01}}, {{"n", Curve::constant(25.3)}, {"k", Curve::constant(89.8)}}, {}, nullptr};
  const std::vector<Band> thermal{Band::rectangular("t", 10, 0.1)};
  Material plate = material("plate", aluminium), wall = material("wall", lambert(0.1));
  plate.temperature_k = wall.temperature_k = 300;
  const Ray ray = towards_origin(80 * kDegree, 0.7);
  const double B = planck_radiance(10, 300);
  for (const bool boxed : {false, true}) {
    std::vector<Mesh> meshes{quad(30, 0, 0)};
    if (boxed) meshes.push_back(box({-9, -9, -1}, {9, 9, 9}, 1, false));
    const auto scene = scene_of(std::move(meshes), {plate, wall});
    const auto run =
        render(scene, {}, std::make_unique<StokesRays>(std::vector<Ray>{ray}, 4096, Polarimetry{}, thermal, 0.05));
    const StokesSeen seen = seen_of(run.result)[0];
    const PlaneBlocks F = fresnel_reflection(std::cos(80 * kDegree), {25.3, 89.8});
    if (boxed) {
      expect_near(seen, {B, 0, 0, 0}, 2e-3 * B);
    } else {
      EXPECT_NEAR(seen.S[0], (1 - F.a) * B, 0.02 * (1 - F.a) * B) << "facets lean";
      EXPECT_NEAR(seen.S[1] / seen.S[0], -F.b / (1 - F.a), 0.03) << "facets lean";
      EXPECT_GT(seen.S[1] / seen.S[0], 0.9);
      EXPECT_NEAR(seen.S[2], 0, 0.02 * seen.S[0]);
    }
  }
}
// One direction is drawn of what a rough metal sends out, so single samples behind a polarizer may be negative. None is
// rejected: crossed polarizers add up to all light.
TEST(Stokes, CrossedPolarizersShareThermalLight) {
  const ModelSpec rough{
      "ggx", {{"roughness", 0.3}}, {{"n", Curve::constant(25.3)}, {"k", Curve::constant(89.8)}}, {}, nullptr};
  const std::vector<Band> thermal{Band::rectangular("t", 10, 0.1)};
  Material plate = material("plate", rough);
  plate.temperature_k = 300;
  const auto scene = scene_of({quad(30, 0, 0)}, {plate});
  std::vector<StokesSeen> seen;
  for (const double axis : {-1.0, 0.0, 1.0}) {  // none, along the first axis, across
    Polarimetry how;
    if (axis != 0) how.analyser = Mueller{{0.5, 0.5 * axis, 0, 0, 0.5 * axis, 0.5, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0}};
    const auto run = render(
        scene, {},
        std::make_unique<StokesRays>(std::vector<Ray>{towards_origin(70 * kDegree, 0.7)}, 8192, how, thermal, 0.05));
    EXPECT_EQ(run.report.statistics.failures, 0u);
    seen.push_back(seen_of(run.result)[0]);
  }
  const double error = std::hypot(seen[0].error[0], seen[1].error[0], seen[2].error[0]);
  EXPECT_NEAR(seen[0].S[0] + seen[2].S[0], seen[1].S[0], kSignificant * error);
  EXPECT_LT(error, 0.03 * seen[1].S[0]);
}

// Two reflections by panes that do not lie in one plane, against the product of matrices from the
// sensor to the light. The order matters.
TEST(Stokes, MatricesMultiplyFromTheSensorToTheLight) {
  const auto scene =
      scene_of({quad(100, 0, 0), mesh_of({{3, -9, 0}, {3, 9, 0}, {6, 9, 9}, {6, -9, 9}}, {0, 2, 1, 0, 3, 2}, 1)},
               {material("low", dielectric(1.5)), material("high", dielectric(2.4))});
  // Down at 45 deg obliquely, then the tilted pane; then up to the sky, or down again into the dark.
  const Dir d = normalized(Vec3{1, 0.3, -1});
  const Dir after = {d.x, d.y, -d.z};
  const Vec3 e1{0, 1, 0}, e2 = normalized(Vec3{3, 0, 9});
  const Vec3 n = cross(e1, e2);
  const Dir last = after - n * (2 * dot(after, n));
  const PlaneBlocks F1 = fresnel_reflection(std::fabs(d.z), 1.5),
                    F2 = fresnel_reflection(std::fabs(dot(after, n)), 2.4);
  const Mueller M = ScatteringPlane(-d, after).matrix(F1) * ScatteringPlane(-after, last).matrix(F2);
  SourceSpecs sources;  // a small bright disk where the chain points
  SunSpec sun{{last, 0.02, Curve::constant(kPi * std::pow(std::sin(0.02), 2))}};
  sources.add(sun);
  const auto seen = see_stokes(scene, sources, {{Vec3{} - d * 5, d, 0}}, 1 << 14)[0];
  const Stokes wanted{M(0, 0), M(1, 0), M(2, 0), M(3, 0)};
  ASSERT_GT(seen.S[0], 0);
  for (size_t c = 1; c < 4; ++c) EXPECT_NEAR(seen.S[c] / seen.S[0], wanted[c] / wanted[0], 1e-5) << "IQUV"[c];
  EXPECT_GT(std::fabs(wanted[2] / wanted[0]), 0.05) << "the planes differ";
}
// Straight down on rough metal under an even sky nothing is polarised for symmetry, but every sample is: of 64 paths Q
// and U are noise, which the errors say. Seen from the side the same surface is polarised for certain. With three
// degrees of freedom a degree is beyond three errors in some 6 % of cases (F distribution): 13 of 40 by chance less
// often than once in 10^5.
TEST(Stokes, NoiseIsNotTakenForPolarisation) {
  const auto scene = scene_of({quad(100, 0, 0)}, {material("metal", metal(0.4))});
  constexpr size_t n = 40;
  size_t defined[2] = {};
  for (const size_t aside : {0u, 1u}) {
    std::vector<Ray> rays;
    for (size_t i = 0; i < n; ++i)
      rays.push_back(towards_origin(aside ? 75 * kDegree : 0, 0.1 * static_cast<double>(i)));
    const auto run = render(scene, sky(false), std::make_unique<StokesRays>(rays, 64));
    const auto seen = seen_of(run.result);
    ASSERT_EQ(run.result.stokes_covariance.size(), 6 * n);
    double most = 0;
    for (size_t i = 0; i < n; ++i) {
      const StokesSeen& s = seen[i];
      double C[6];
      std::copy_n(&run.result.stokes_covariance[i * 6], 6, C);
      EXPECT_NEAR(std::sqrt(C[3]), s.error[1], 1e-6 * s.S[0]) << "the variance of Q is that of its error";
      const LinearPolarisation p = linear_polarisation({s.S[0], s.S[1], s.S[2]}, C);
      EXPECT_LE(p.debiased, p.degree);
      most = std::max(most, p.degree);
      defined[aside] += !p.undefined;
    }
    EXPECT_GT(most, 1e-3);
  }
  EXPECT_LE(defined[0], 13u);
  EXPECT_GE(defined[1], 30u);
}
// What models without matrices scatter counts as depolarised, and is told: all of it here.
TEST(Stokes, LightOfModelsWithoutMatricesIsTold) {
  const ModelSpec grooves{"oren_nayar", {{"sigma", 0.3}}, {{"reflectance", Curve::constant(0.5)}}, {}, nullptr};
  for (const bool known : {false, true}) {
    const auto scene = scene_of({quad(100, 0, 0)}, {material("ground", known ? lambert(0.5) : grooves)});
    const auto seen = see_stokes(scene, sky(false), {towards_origin(0.5)}, 64)[0];
    EXPECT_NEAR(seen.depolarised, known ? 0 : seen.S[0], 1e-6);
    EXPECT_EQ(seen.S[1], 0);
  }
}

// Light scattered once by a thin layer of air: I = P11(90 deg...) tau / ..., sun at 60 deg, looked at straight down
// (closed form, depolarisation 0.0279; Hansen & Travis 1974): I/E0 7.369816e-4, degree 0.573657.
TEST(Stokes, AThinLayerOfAirScattersOnce) {
  const ModelSpec rayleigh{"rayleigh", {{"depolarisation", 0.0279}}, {}, {}, nullptr};
  const auto scene = slab_scene(medium(Curve::constant(0), Curve::constant(0.01), rayleigh), 1);
  SourceSpecs sources;
  sources.add(SunSpec{{dir_from_angles(60 * kDegree, 0.6), 0, Curve::constant(1)}});
  PipelineOptions options;
  options.max_scatterings = 1;
  Polarimetry how;
  how.frame = StokesFrame::scattering_plane;
  const auto seen = see_stokes(scene, sources, {{{0, 0, 2}, {0, 0, -1}, 0}}, 1 << 16, how, options)[0];
  EXPECT_NEAR(seen.S[0], 7.369816e-4, 1e-7 + kSignificant * seen.error[0]);
  EXPECT_LT(seen.error[0], 0.02 * seen.S[0]);
  EXPECT_NEAR(seen.S[1] / seen.S[0], -0.573657, 1e-5) << "across the plane of scattering";
  EXPECT_NEAR(seen.S[2] / seen.S[0], 0, 1e-6);
  EXPECT_EQ(seen.depolarised, 0);
}

}  // namespace
}  // namespace suite::test::stokes_test
