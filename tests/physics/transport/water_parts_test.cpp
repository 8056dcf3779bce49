// What comes out of water, and what its surface reflects of sun and sky, as channels: closed forms over flat water,
// sources one by one over rough water.
#include <gtest/gtest.h>

#include <cmath>

#include "optics/fresnel.h"
#include "tests/support/even_within.h"
#include "tests/support/media_kit.h"
#include "tests/support/radiometry_kit.h"

namespace suite::test::water_parts_test {
namespace {

constexpr double kIndex = 1.33, kBed = 0.3, kZenith = 30 * kDegree, kSky = 0.2;
enum Part { all, leaving, glint, sky, parts };

class Parts final : public RaySensor {
 public:
  Parts(const Dir& view, uint32_t paths)
      : RaySensor({{view * 20, -view, 0}}, one_band(), paths),
        names_{"radiance", "water_leaving", "glint", "sky_reflection"} {}
  std::span<const std::string> channels() const override { return names_; }

 private:
  std::vector<std::string> names_;
};

// Water 2 m deep over a Lambert bed.
std::shared_ptr<Scene> pond(double roughness, double bed, std::vector<Material> more = {}) {
  auto scene = std::make_shared<Scene>();
  ModelSpec surface{"dielectric", {}, {{"index", Curve::constant(kIndex)}}, {}, nullptr};
  if (roughness > 0) surface.model = "ggx_dielectric", surface.numbers["roughness"] = roughness;
  scene->materials = {material("bed", lambert(bed)), material("water", surface)};
  for (Material& m : more) scene->materials.push_back(std::move(m));
  place(*scene, PrimitiveKind::plane, {0, 0}, 0, translation({0, 0, -2}));
  place(*scene, PrimitiveKind::plane, {0, 0}, 1);
  return scene;
}

SourceSpecs lit(bool with_sun, bool with_sky, double half_angle = 0) {
  SourceSpecs s;
  if (with_sun) s.add(SunSpec{dir_from_angles(kZenith, 0), half_angle, Curve::constant(1)});
  if (with_sky) s.add(uniform_sky(kSky, false));
  return s;
}

struct Value {
  double mean, error;
};
std::array<Value, parts> look(std::shared_ptr<Scene> scene, const SourceSpecs& sources, const Dir& view,
                              uint32_t paths = 1 << 16) {
  check_scene(*scene, "pond");
  const Rendered r = render(scene, sources, std::make_unique<Parts>(view, paths));
  EXPECT_EQ(r.report.statistics.failures, 0u);
  std::array<Value, parts> values;
  for (size_t i = 0; i < parts; ++i) values[i] = {r.result.radiance[i], r.result.standard_error[i]};
  return values;
}

double transmitted(double c) { return fresnel_dielectric(c, kIndex).transmittance; }

// Of a bed that gets `irradiance` through flat water: flux is conserved there, radiance goes by the index squared, bed
// and surface reflect to and fro.
double from_bed(double irradiance, double view) {
  const double inside = reflected_within(kIndex);
  return kBed / kPi * irradiance * transmitted(view) / (kIndex * kIndex * (1 - kBed * inside));
}
// Of a sky of radiance 1, W/m2.
double of_sky() {
  double sum = 0, n = 20000;
  for (int i = 0; i < n; ++i) sum += 2 * kPi * (i + 0.5) / n * transmitted((i + 0.5) / n) / n;
  return sum;
}

TEST(WaterParts, FlatWater) {
  const double v = std::cos(20 * kDegree), s = std::cos(kZenith);
  const double truth = from_bed(s * transmitted(s) + kSky * of_sky(), v);
  const auto seen = look(pond(0, kBed), lit(true, true), dir_from_angles(20 * kDegree, 0.4));
  EXPECT_NEAR(seen[leaving].mean, truth, 4 * seen[leaving].error);
  EXPECT_LT(seen[leaving].error, 0.005 * truth);
  // 1e-6: of floats. The share of paths that the surface mirrors is the same in all scrambles, so nothing varies.
  EXPECT_NEAR(seen[sky].mean, kSky * (1 - transmitted(v)), 4 * seen[sky].error + 1e-6 * kSky);
  EXPECT_LT(seen[sky].error, 0.06 * seen[sky].mean);
  EXPECT_EQ(seen[glint].mean, 0) << "the view is not where the mirror sends the sun";
  EXPECT_NEAR(seen[leaving].mean + seen[sky].mean, seen[all].mean, 1e-6 * seen[all].mean);
  // Negative control: 3 % more would be seen.
  EXPECT_GT(0.03 * truth, 5 * seen[leaving].error);
}

TEST(WaterParts, TheSunInTheMirror) {
  const double half = 5 * kDegree, sine = std::sin(half), s = std::cos(kZenith);
  const auto seen = look(pond(0, kBed), lit(true, true, half), dir_from_angles(kZenith, kPi));
  const double sun = 1 / (kPi * sine * sine), R = 1 - transmitted(s);
  // Strata choose the lobe: all of them alike, but for single paths.
  EXPECT_NEAR(seen[glint].mean, R * sun, 4 * seen[glint].error + 1e-3 * R * sun);
  EXPECT_LT(seen[glint].error, 0.06 * R * sun);
  EXPECT_NEAR(seen[sky].mean, R * kSky, 4 * seen[sky].error + 1e-3 * R * kSky);
  EXPECT_NEAR(seen[leaving].mean + seen[sky].mean + seen[glint].mean, seen[all].mean, 1e-6 * seen[all].mean);
}

// Each part of rough water is what is there when only its source, or only its surface, is.
TEST(WaterParts, RoughWater) {
  const Dir view = dir_from_angles(25 * kDegree, kPi);
  const auto both = look(pond(0.15, kBed), lit(true, true), view), sun = look(pond(0.15, 0), lit(true, false), view),
             dome = look(pond(0.15, 0), lit(false, true), view);
  const auto same = [](const Value& a, const Value& b) {
    EXPECT_NEAR(a.mean, b.mean, 4 * std::hypot(a.error, b.error));
    EXPECT_GT(0.05 * a.mean, 4 * std::hypot(a.error, b.error)) << "control: 5 % would be seen";
  };
  same(both[glint], sun[all]);
  same(both[sky], dome[all]);
  EXPECT_EQ(sun[leaving].mean, 0);
  EXPECT_GT(both[leaving].mean, 20 * both[leaving].error);
  EXPECT_NEAR(both[leaving].mean + both[sky].mean + both[glint].mean, both[all].mean, 1e-6 * both[all].mean);
}

// The opaque sea reflects all that it sends.
TEST(WaterParts, TheSeaFromFar) {
  auto scene = std::make_shared<Scene>();
  scene->materials = {material("sea", {"sea", {{"wind_m_s", 5}}, {}, {}, nullptr})};
  place(*scene, PrimitiveKind::plane, {0, 0}, 0);
  const auto seen = look(scene, lit(true, true), dir_from_angles(20 * kDegree, kPi));
  EXPECT_GT(seen[glint].mean, 20 * seen[glint].error);
  EXPECT_GT(seen[sky].mean, 20 * seen[sky].error);
  EXPECT_NEAR(seen[sky].mean + seen[glint].mean, seen[all].mean, 1e-6 * seen[all].mean);
}

// What the water mirrors of things, and what stands in front of it, is none of its parts.
TEST(WaterParts, ThingsAreNoneOfThem) {
  const Dir view = dir_from_angles(20 * kDegree, 0);
  auto mirrored = pond(0, 0, {material("board", lambert(0.5))});
  place(*mirrored, PrimitiveKind::disk, {3, 0}, 2, translation({-5 * std::tan(20 * kDegree), 0, 5}));
  SourceSpecs sources = lit(true, false);
  sources.add(uniform_sky(kSky, true));  // lights the lower side of the board
  auto seen = look(mirrored, sources, view);
  EXPECT_GT(seen[all].mean, 5 * seen[all].error);
  EXPECT_EQ(seen[sky].mean + seen[glint].mean + seen[leaving].mean, 0);
  auto before = pond(0, kBed, {material("board", lambert(0.5))});
  place(*before, PrimitiveKind::disk, {3, 0}, 2, translation(view * 5));
  seen = look(before, sources, view);
  EXPECT_GT(seen[all].mean, 5 * seen[all].error);
  EXPECT_EQ(seen[sky].mean + seen[glint].mean + seen[leaving].mean, 0);
}

}  // namespace
}  // namespace suite::test::water_parts_test
