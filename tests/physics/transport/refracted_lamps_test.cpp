// Lamps behind flat water and a pane, asked for along bent ways, against conservation of flux: what a point sends into
// a ring of directions falls on a ring of the floor.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "optics/fresnel.h"
#include "tests/support/lamps_kit.h"
#include "tests/support/pipeline_kit.h"

namespace suite::test::refracted_lamps_test {
namespace {

constexpr double kIndex = 1.33, kGlass = 1.5;
constexpr double kReflectance = 1e-6;  // of what is lit: what it throws back does not count

// Between a lamp and a plane: layers with their indices, the lamp's first.
struct Layer {
  double thickness, index;
};

// Where a ray goes that leaves the lamp under an angle, m beside it, and how that changes with the angle.
struct Reached {
  double x = 0, per_angle = 0;
};
Reached reach(const std::vector<Layer>& layers, double angle) {
  Reached r;
  for (const Layer& l : layers) {
    const double s = std::sin(angle) * layers[0].index / l.index, c = std::sqrt(1 - s * s);
    r.x += l.thickness * s / c;
    r.per_angle += l.thickness * std::cos(angle) * layers[0].index / l.index / (c * c * c);
  }
  return r;
}

// W/m2 on the plane, x m beside a lamp of this intensity by angle, for a transmittance by angle.
double irradiance(const std::vector<Layer>& layers, double x, const std::function<double(double)>& intensity,
                  const std::function<double(double)>& transmittance) {
  double low = 0, high = kPi / 2;
  for (const Layer& l : layers) high = std::min(high, std::asin(std::min(1.0, l.index / layers[0].index)));
  high *= 1 - 1e-12;
  for (int i = 0; i < 100; ++i) (reach(layers, 0.5 * (low + high)).x < x ? low : high) = 0.5 * (low + high);
  const double angle = 0.5 * (low + high), per = reach(layers, angle).per_angle;
  const double spread = x < 1e-9 ? per * per : x * per / std::sin(angle);
  return intensity(angle) * transmittance(angle) / spread;
}
double evenly(double) { return 1; }

SourceSpecs one(LampSpec lamp) {
  SourceSpecs s;
  s.add(std::move(lamp));
  return s;
}

std::shared_ptr<Scene> water_over(double bed, double surface) {
  auto scene = std::make_shared<Scene>();
  scene->materials = {material("bed", lambert(kReflectance)),
                      material("water", {"dielectric", {}, {{"index", Curve::constant(kIndex)}}, {}, nullptr}),
                      material("shine", lambert(0))};
  place(*scene, PrimitiveKind::plane, {0, 0}, 0, translation({0, 0, bed}));
  place(*scene, PrimitiveKind::plane, {0, 0}, 1, translation({0, 0, surface}));
  return scene;
}

// The plane z = 0 at distances along x, seen from 1 mm off on the side of `side`.
RaySensor look(const std::vector<double>& at, double side, uint32_t paths) {
  std::vector<Ray> rays;
  for (const double x : at) rays.push_back({{x, 0, side * 1e-3}, {0, 0, -side}, 0});
  return RaySensor(rays, one_band(), paths);
}

void expect(const Seen& r, size_t i, double irradiance, double tolerance = 0.005) {
  const double truth = kReflectance / kPi * irradiance, mean = r.radiance[i], error = r.standard_error[i];
  SCOPED_TRACE(testing::Message() << "place " << i << ": " << mean << " +- " << error << " for " << truth);
  EXPECT_NEAR(mean, truth, tolerance * truth);
  EXPECT_NEAR(mean, truth, 5 * error + 1e-3 * truth);  // p = 0.002; what the plane throws back
  EXPECT_LE(r.missing[i], 1e-3 * truth);               // flagged as not resolved beyond
}

const std::vector<double> kPlaces{0, 0.3, 1, 3, 10};

double into_water(double a) { return fresnel_dielectric(std::cos(a), kIndex).transmittance; }
double out_of_water(double a) { return fresnel_dielectric(std::cos(a), 1 / kIndex).transmittance; }

TEST(RefractedLamps, PointOverWater) {
  for (const double depth : {0.1, 2.0})
    for (const double height : {0.2, 3.0}) {
      const auto scene = water_over(0, depth);
      check_scene(*scene, "bed");
      const auto r = see(scene, one(point_lamp({{0, 0, depth + height}}, 1)), look(kPlaces, 1, 256));
      for (size_t i = 0; i < kPlaces.size(); ++i)
        expect(r, i, irradiance({{height, 1}, {depth, kIndex}}, kPlaces[i], evenly, into_water));
    }
}

// A ceiling in the air over water with a lamp in it.
TEST(RefractedLamps, PointInWater) {
  const auto scene = water_over(0, -1.5);
  check_scene(*scene, "ceiling");
  const auto r = see(scene, one(point_lamp({{0, 0, -2}}, 1)), look(kPlaces, -1, 256));
  for (size_t i = 0; i < kPlaces.size(); ++i)
    expect(r, i, irradiance({{0.5, kIndex}, {1.5, 1}}, kPlaces[i], evenly, out_of_water));
}

// Bent light leaves a spot under other angles than a straight line does: at its edge, places that no straight line
// reaches within its cone are lit.
TEST(RefractedLamps, EdgeOfASpot) {
  const auto scene = water_over(0, 2);
  check_scene(*scene, "bed");
  LampSpec spot = point_lamp({{0, 0, 3}}, 1);
  spot.kind = LampSpec::Kind::spot;
  spot.inner = spot.outer = 0.5;
  const std::vector<Layer> layers{{1, 1}, {2, kIndex}};
  const double edge = reach(layers, 0.5).x;
  const std::vector<double> places{0.2 * edge, 0.98 * edge, 1.02 * edge, 2.99 * std::tan(0.5)};
  const auto r = see(scene, one(spot), look(places, 1, 256));
  for (const size_t i : {0, 1}) expect(r, i, irradiance(layers, places[i], evenly, into_water));
  EXPECT_LT(r.radiance[2], 1e-3 * r.radiance[0]);  // what the bed throws back
  EXPECT_LT(r.radiance[3], 1e-3 * r.radiance[0]) << "a straight line lies just within the cone";
}

// Faces of a pane throw light to and fro: each time its way is that through a pane thicker by two.
TEST(RefractedLamps, PointOverAPane) {
  constexpr double kThick = 0.05;
  auto scene = std::make_shared<Scene>();
  scene->materials = {material("floor", lambert(kReflectance)),
                      material("glass", {"dielectric", {}, {{"index", Curve::constant(kGlass)}}, {}, nullptr})};
  place(*scene, PrimitiveKind::plane, {0, 0}, 0);
  place(*scene, PrimitiveKind::box, {0, 0, 1, 0, 0, 1 + kThick}, 1);
  check_scene(*scene, "pane");
  const auto r = see(scene, one(point_lamp({{0, 0, 2}}, 1)), look(kPlaces, 1, 4096));
  for (size_t i = 0; i < kPlaces.size(); ++i) {
    double all = 0;
    for (int n = 0; n < 40; ++n)
      all += irradiance({{2 - kThick, 1}, {(2 * n + 1) * kThick, kGlass}}, kPlaces[i], evenly, [&](double a) {
        const double reflected = fresnel_dielectric(std::cos(a), kGlass).reflectance;
        return (1 - reflected) * (1 - reflected) * std::pow(reflected, 2 * n);
      });
    expect(r, i, all, 0.01);
  }
}

// A square that glows over water, by quadrature over its places; asked for, met by chance, and never both.
TEST(RefractedLamps, AreaOverWater) {
  constexpr double kSide = 0.4, kHeight = 0.5, kDepth = 1;
  const auto scene = water_over(0, kDepth);
  place(*scene, PrimitiveKind::plane, {kSide, kSide}, 2,
        translation({0, 0, kDepth + kHeight}) * rotation({1, 0, 0}, kPi));
  check_scene(*scene, "panel");
  const std::vector<double> places{0, 0.3, 1, 2};
  std::vector<double> truth;
  constexpr int n = 60;
  for (const double x : places) {
    double sum = 0;
    for (int i = 0; i < n * n; ++i) {
      const double dx = x - ((i % n + 0.5) / n - 0.5) * kSide, dy = ((i / n + 0.5) / n - 0.5) * kSide;
      sum += irradiance(
          {{kHeight, 1}, {kDepth, kIndex}}, std::hypot(dx, dy), [](double a) { return std::cos(a); }, into_water);
    }
    truth.push_back(sum * kSide * kSide / (n * n));
  }
  const auto asked = see(scene, one(glow("shine", 1)), look(places, 1, 4096));
  for (size_t i = 0; i < places.size(); ++i) {
    expect(asked, i, truth[i]);
    EXPECT_LT(asked.standard_error[i], 0.003 * asked.radiance[i]) << "no fireflies";
  }
  PipelineOptions chance;
  chance.refracted_sources = false;
  const auto met = see(scene, one(glow("shine", 1)), look(places, 1, 65536), chance);
  for (size_t i = 0; i < 2; ++i) {
    EXPECT_NEAR(met.radiance[i], kReflectance / kPi * truth[i], 5 * met.standard_error[i]);
    EXPECT_GT(met.standard_error[i], 3 * asked.standard_error[i]) << "with 16 times as many paths";
  }
}

// Negative control: without asking there is nothing, and it is told.
TEST(RefractedLamps, UnaskedPointIsTold) {
  const auto scene = water_over(0, 2);
  check_scene(*scene, "bed");
  PipelineOptions unasked;
  unasked.refracted_sources = false;
  const auto r = see(scene, one(point_lamp({{0, 0, 3}}, 1)), look({0.5}, 1, 256), unasked);
  EXPECT_EQ(r.radiance[0], 0);
  EXPECT_GT(r.missing[0], 0);
}

}  // namespace
}  // namespace suite::test::refracted_lamps_test
