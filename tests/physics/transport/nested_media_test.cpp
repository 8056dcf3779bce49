// Many bodies of media in each other, touching and side by side: against closed forms and the same medium uncut.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/media_kit.h"
#include "tests/support/message_of.h"

namespace suite::test::nested_media_test {
namespace {

constexpr double kSigmas = 4.5;  // less than 1e-5 a comparison by chance

enum class Cut { planes, boxes, meshes };
const char* name_of(Cut cut) { return cut == Cut::planes ? "planes" : cut == Cut::boxes ? "boxes" : "meshes"; }

// The slab 0 < z < thickness, cut into n equal sheets that take turns with the media.
std::shared_ptr<Scene> cut_slab(const std::vector<Medium>& media, uint32_t n, double thickness, Cut cut) {
  auto scene = std::make_shared<Scene>();
  scene->groups.push_back({"root", {}});
  scene->media = media;
  const auto height = [&](uint32_t i) { return thickness * i / n; };
  for (uint32_t i = 0; i < n; ++i) {
    scene->materials.push_back(boundary(i % static_cast<uint32_t>(media.size())));
    const Vec3 low{-50, -50, height(i)}, high{50, 50, height(i + 1)};
    if (cut == Cut::boxes) {
      place(*scene, PrimitiveKind::box, {low.x, low.y, low.z, high.x, high.y, high.z}, i);
    } else if (cut == Cut::meshes) {
      scene->meshes.push_back(box(low, high, i, true));
      scene->groups[0].placements.push_back({{}, TargetKind::mesh, i, kNone, kNone});
    }
  }
  if (cut == Cut::planes) {  // from above: each sheet goes on downwards, in the next one, which holds as entered last
    for (uint32_t i = n; i-- > 0;) place(*scene, PrimitiveKind::plane, {0, 0}, i, translation({0, 0, height(i + 1)}));
    Medium nothing;
    nothing.id = "void";
    nothing.priority = 1;
    scene->media.push_back(nothing);
    scene->materials.push_back(boundary(static_cast<uint32_t>(media.size())));
    place(*scene, PrimitiveKind::plane, {0, 0}, n);
  }
  check_scene(*scene, "cut slab");
  return scene;
}

constexpr uint32_t kCounts[] = {1, 2, 3, 5, 8, 12, 13, 16, 40, 200};
const Cut kCuts[] = {Cut::planes, Cut::boxes, Cut::meshes};

SourceSpecs bright() {
  SourceSpecs sources;
  sources.add(uniform_sky(1, true));
  return sources;
}
void expect_alike(const Repeated& a, const Repeated& b, double least) {
  EXPECT_NEAR(a.mean, b.mean, kSigmas * std::hypot(a.error, b.error));
  EXPECT_LT(kSigmas * std::hypot(a.error, b.error), least * b.mean) << "that would not be seen";
}

// Regression: bodies beyond the twelfth were not seen, and neither was one of two surfaces that lie in each other: two
// sheets of a cut slab showed 28 % too much, 200 of them 229 %.
TEST(CutSlab, AbsorbsAsTheSumOfItsSheets) {
  double worst = 0;
  for (const Cut cut : kCuts)
    for (const uint32_t n : kCounts) {
      std::vector<Medium> media;
      double tau = 0, half = 0;
      for (uint32_t i = 0; i < n; ++i) {
        const double a = (1.0 + i % 3) / 2;
        media.push_back(medium(Curve::constant(a), Curve::constant(0)));
        tau += a / n;
        if (i >= n / 2) half += a / n;
      }
      const Dir slant = normalized(Vec3{0.6, 0.1, 0.8}), flat = normalized(Vec3{1, 0.2, 0.3});
      const std::vector<Ray> rays{{{0, 0, 3}, {0, 0, -1}, 0},  // down the edges between the triangles, too
                                  {{0.3, 0.1, 3}, -slant, 0},
                                  {{0.3, 0.1, -3}, slant, 0},
                                  {{0.3, 0.1, -3}, flat, 0},
                                  {{0.3, 0.1, 1.0 * (n / 2) / n + 1e-5}, {0, 0, 1}, 0}};  // from inside
      const auto r = render_cell(cut_slab(media, n, 1, cut), bright(), rays, 2);
      const double expected[] = {tau, tau / slant.z, tau / slant.z, tau / flat.z, half};
      for (size_t i = 0; i < rays.size(); ++i) {
        const double off = r.radiance[i] / std::exp(-expected[i]) - 1;
        EXPECT_NEAR(off, 0, 1e-4) << name_of(cut) << ' ' << n << " sheets, ray " << i;
        worst = std::max(worst, std::fabs(off));
      }
    }
  std::printf("cut slab, absorbing, 1 to 200 sheets: worst %.1e\n", worst);
}

TEST(CutSlab, ScattersAsTheUncut) {
  const auto gas = medium(Curve::constant(0.2), Curve::constant(2), hg(0.5));
  SourceSpecs sources;
  sources.add(SunSpec{dir_from_angles(0.6, 0.3), 0, Curve::constant(3)});
  const std::vector<Ray> rays = repeated({{0.2, 0.1, 3}, normalized(Vec3{0.3, 0.2, -1}), 0});
  const Repeated whole = over_problems(render_cell(cut_slab({gas}, 1, 1, Cut::planes), sources, rays, 1 << 10), 0);
  const auto seen = [&](Cut cut, uint32_t n, uint32_t paths) {
    return over_problems(render_cell(cut_slab({gas}, n, 1, cut), sources, rays, paths, {}, n), 0);
  };
  const auto compare = [&](Cut cut, uint32_t n) {
    SCOPED_TRACE(std::string(name_of(cut)) + ' ' + std::to_string(n));
    const Repeated got = seen(cut, n, n > 40 ? 48 : 224);
    std::printf("cut slab, scattering, %u %s: %.5f +- %.5f, uncut %.5f +- %.5f\n", n, name_of(cut), got.mean, got.error,
                whole.mean, whole.error);
    expect_alike(got, whole, n > 40 ? 0.13 : 0.06);
  };
  compare(Cut::boxes, 200);
  for (const uint32_t n : {2u, 16u, 40u}) {
    compare(Cut::planes, n);
    // Other bodies have the same paths, but for the few that rounding parts: a hundredth of the light is seen by 2048.
    const Repeated same = seen(Cut::planes, n, 32);
    for (const Cut cut : {Cut::boxes, Cut::meshes}) {
      const Repeated got = seen(cut, n, 32);
      std::printf("  %s %.5f, planes %.5f\n", name_of(cut), got.mean, same.mean);
      EXPECT_NEAR(got.mean, same.mean, 0.01 * same.mean) << name_of(cut) << ' ' << n;
    }
  }
}

// n spheres in each other of radii 1/n, 2/n ... 1, that take turns with the media.
std::shared_ptr<Scene> spheres(const std::vector<Medium>& media, uint32_t n) {
  auto scene = std::make_shared<Scene>();
  scene->media = media;
  for (uint32_t i = 0; i < n; ++i) {
    scene->materials.push_back(boundary(i % static_cast<uint32_t>(media.size())));
    place(*scene, PrimitiveKind::sphere, {(i + 1.0) / n}, i);
  }
  check_scene(*scene, "spheres");
  return scene;
}

// Regression: 16 spheres in each other scattered 4.5 % too much.
TEST(NestedBodies, ConcentricSpheres) {
  double worst = 0;
  for (const uint32_t n : kCounts) {
    std::vector<Medium> media;
    double radius = 0;
    for (uint32_t i = 0; i < n; ++i) {
      media.push_back(medium(Curve::constant(0.3 + i % 4 * 0.2), Curve::constant(0)));
      radius += (0.3 + i % 4 * 0.2) / n;
    }
    // From outside through the middle, from the middle, and beside the middle at half the radius, in closed form.
    double chord = 0;
    for (uint32_t i = 0; i < n; ++i) {
      const double inner = 1.0 * i / n, outer = (i + 1.0) / n;
      const auto half = [](double r) { return std::sqrt(std::max(0.0, r * r - 0.5 * 0.5)); };
      chord += 2 * (0.3 + i % 4 * 0.2) * (half(outer) - half(inner));
    }
    const Dir d = normalized(Vec3{0.3, -0.5, 0.7});
    const Vec3 aside = cross(d, normalized(Vec3{1, 1, 0})), off = normalized(aside) * 0.5;
    const auto r =
        render_cell(spheres(media, n), bright(), {{d * -4.0, d, 0}, {{0, 0, 0}, d, 0}, {off - d * 4.0, d, 0}}, 2);
    const double expected[] = {2 * radius, radius, chord};
    for (size_t i = 0; i < 3; ++i) {
      const double relative = r.radiance[i] / std::exp(-expected[i]) - 1;
      EXPECT_NEAR(relative, 0, 1e-4) << n << " spheres, ray " << i;
      worst = std::max(worst, std::fabs(relative));
    }
  }
  std::printf("spheres in each other, absorbing, 1 to 200: worst %.1e\n", worst);
  const auto gas = medium(Curve::constant(0.2), Curve::constant(2), hg(0.5));
  SourceSpecs sources;
  sources.add(SunSpec{dir_from_angles(0.6, 0.3), 0, Curve::constant(3)});
  const std::vector<Ray> rays = repeated({{0.2, 0.1, 3}, normalized(Vec3{0.1, 0.05, -1}), 0});
  const Repeated whole = over_problems(render_cell(spheres({gas}, 1), sources, rays, 1 << 10), 0);
  for (const uint32_t n : {16u, 64u}) {  // every ray is asked for all of them: no box parts spheres in each other
    const Repeated got = over_problems(render_cell(spheres({gas}, n), sources, rays, n > 40 ? 40 : 192, {}, n), 0);
    std::printf("%u spheres, scattering: %.5f +- %.5f, uncut %.5f +- %.5f\n", n, got.mean, got.error, whole.mean,
                whole.error);
    expect_alike(got, whole, n > 40 ? 0.13 : 0.06);
  }
}

// The surface that stops a path may lie in the one that bounds a medium: nothing leaks through it, and its light passes
// the medium on both ways.
TEST(TouchingBodies, SlabOnTheGround) {
  const double a = 0.7, rho = 0.5, m0 = std::cos(0.5), m = 0.8;
  for (const Cut cut : {Cut::boxes, Cut::meshes})
    for (const uint32_t n : {1u, 2u, 40u}) {
      auto scene = cut_slab({medium(Curve::constant(a), Curve::constant(0))}, n, 1, cut);
      scene->materials.push_back(material("ground", lambert(rho)));
      place(*scene, PrimitiveKind::plane, {100, 100}, n);
      check_scene(*scene, "slab on the ground");
      SourceSpecs sources;
      sources.add(SunSpec{dir_from_angles(0.5, 0.3), 0, Curve::constant(2)});
      const auto r =
          render_cell(scene, sources, {{{0.2, 0.1, 3}, {0.6, 0, -0.8}, 0}, {{0.2, 0.1, 3}, {0, 0, -1}, 0}}, 4);
      const double ground = rho / kPi * 2 * m0 * std::exp(-a / m0);
      EXPECT_NEAR(r.radiance[0] / (ground * std::exp(-a / m)), 1, 1e-4) << name_of(cut) << n;
      EXPECT_NEAR(r.radiance[1] / (ground * std::exp(-a)), 1, 1e-4) << name_of(cut) << n;
    }
}

TEST(TouchingBodies, GlassOnASheet) {
  // A plate that refracts rests on an absorbing sheet, straight through: the sheet's light is dimmed once, and the
  // plate's faces transmit what the plate without the sheet transmits.
  const auto scene_with_sheet = [](bool sheet) {
    auto scene = std::make_shared<Scene>();
    scene->media = {medium(Curve::constant(0.1), Curve::constant(0)), medium(Curve::constant(0.9), Curve::constant(0))};
    Material glass = material("glass", ModelSpec{"dielectric", {}, {{"index", Curve::constant(1.5)}}, {}, nullptr});
    glass.inside = 0;
    scene->materials = {glass, boundary(1)};
    place(*scene, PrimitiveKind::box, {-5, -5, 1, 5, 5, 2}, 0);
    if (sheet) place(*scene, PrimitiveKind::box, {-5, -5, 0, 5, 5, 1}, 1);
    check_scene(*scene, "plate");
    return scene;
  };
  const std::vector<Ray> rays = repeated({{0.2, 0.1, 4}, {0, 0, -1}, 0});
  SourceSpecs below;  // bright below the horizon only: what is reflected upwards sees nothing
  below.add(SkySpec{Curve::constant(1), {0, 0, 1}, 3, 1, true});
  const Repeated with = over_problems(render_cell(scene_with_sheet(true), below, rays, 1 << 8), 0),
                 without = over_problems(render_cell(scene_with_sheet(false), below, rays, 1 << 8), 0);
  // Light that is reflected inside the plate leaves it downwards as well: every path passes the sheet once.
  EXPECT_NEAR(with.mean / without.mean, std::exp(-0.9),
              kSigmas * std::hypot(with.error / with.mean, without.error / without.mean) + 1e-4);
}

TEST(TouchingBodies, LayerAsWideAsThePeriod) {
  // Its ends lie in the sides of the cell, so that a copy begins where it ends: rays cross many of them.
  const Periodic cell{{-3, 2}, {10, 8}};
  auto scene = std::make_shared<Scene>();
  scene->media = {medium(Curve::constant(0.05), Curve::constant(0))};
  scene->materials = {boundary(0)};
  place(*scene, PrimitiveKind::box, {-3, 2, 1, 7, 10, 2}, 0);
  check_scene(*scene, "layer");
  std::vector<Ray> rays;
  const std::vector<double> steep{0.9, 0.3, 0.1, 0.02};
  for (const double z : steep) {
    const double level = std::sqrt(1 - z * z);
    rays.push_back({{0.3, 4, 0}, {level * 0.8, level * 0.6, z}, 0});
    rays.push_back({{0.3, 4, 3}, {-level * 0.28, level * 0.96, -z}, 0});
  }
  rays.push_back({{0.3, 4, 1.5}, {0.8, 0, 0.6}, 0});
  const auto r = render_cell(scene, bright(), rays, 2, cell);
  for (size_t i = 0; i < steep.size(); ++i)
    for (const size_t k : {2 * i, 2 * i + 1})
      EXPECT_NEAR(r.radiance[k] / std::exp(-0.05 / steep[i]), 1, 1e-4) << steep[i];
  EXPECT_NEAR(r.radiance.back() / std::exp(-0.025 / 0.6), 1, 1e-4);
}

TEST(TouchingBodies, ABodyThatOverlapsItselfIsCounted) {
  // Two boxes in one mesh: between them the body has been entered twice.
  auto scene = std::make_shared<Scene>();
  scene->media = {medium(Curve::constant(0.4), Curve::constant(0))};
  scene->materials = {boundary(0)};
  Mesh one = box({-1, -1, 0}, {1, 1, 2}, 0, true);
  const Mesh two = box({-1.5, -1.5, 1}, {1.5, 1.5, 3}, 0, true);
  const auto base = static_cast<uint32_t>(one.vertex_count());
  std::vector<float> positions(one.positions.begin(), one.positions.end() - 1);
  std::vector<uint32_t> indices(one.indices.begin(), one.indices.end());
  positions.insert(positions.end(), two.positions.begin(), two.positions.end());
  for (const uint32_t i : two.indices) indices.push_back(base + i);
  one.positions = std::move(positions), one.indices = std::move(indices);
  one.parts[0].triangle_count = static_cast<uint32_t>(one.triangle_count());
  scene->groups.push_back({"root", {}});
  scene->meshes.push_back(one);
  scene->groups[0].placements.push_back({{}, TargetKind::mesh, 0, kNone, kNone});
  check_scene(*scene, "boxes");
  const auto r = render_cell(scene, bright(), {{{0.3, 0.1, 5}, {0, 0, -1}, 0}, {{0.3, 0.1, -5}, {0, 0, 1}, 0}}, 2);
  for (const double L : r.radiance) EXPECT_NEAR(L, std::exp(-0.4 * 3), 1e-5);
}

// Regression: light that goes through the Earth's surface crashed a scene with a medium, as the Earth has no object.
TEST(Earth, LetsLightThroughBesideAMedium) {
  auto scene = std::make_shared<Scene>();
  scene->origin = {47, 11, 600, true};
  scene->media = {medium(Curve::constant(0.1), Curve::constant(0.1))};
  scene->materials = {boundary(0), material("leaf", lambert(0.4, 0.4))};
  place(*scene, PrimitiveKind::sphere, {5}, 0, translation({0, 0, 20}));
  check_scene(*scene, "earth");
  SourceSpecs sources = bright();
  sources.earth = EarthSpec{"leaf", 0.0, {}};
  sources.add(SunSpec{dir_from_angles(0.6, 0.3), 0, Curve::constant(3)});
  const auto r = render_cell(scene, sources, {{{0.2, 0.1, 40}, {0, 0, -1}, 0}, {{80, 0.1, 40}, {0, 0, -1}, 0}}, 64);
  for (const double L : r.radiance) EXPECT_GT(L, 0.1);
  scene->materials[1].inside = 0;
  EXPECT_THAT(message_of([&] {
                render_cell(scene, sources, {{{0.2, 0.1, 40}, {0, 0, -1}, 0}}, 1);
              }),
              testing::HasSubstr("bounds a medium"));
}

}  // namespace
}  // namespace suite::test::nested_media_test
