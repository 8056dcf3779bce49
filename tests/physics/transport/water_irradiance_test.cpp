// Irradiance under water, by the receivers that `point` sensors have: downward and upward on planes, and scalar, of sun
// and sky through a flat surface over a bed, in water that absorbs. Closed forms by quadrature.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "optics/fresnel.h"
#include "tests/support/media_kit.h"

namespace suite::test::water_irradiance_test {
namespace {

constexpr double kIndex = 1.34, kAbsorption = 0.3, kBottom = 3, kSun = 40 * kDegree, kSky = 0.2;

// Planes facing `direction`, or small spheres.
class Receivers final : public RaySensor {
 public:
  Receivers(std::vector<Ray> rays, uint32_t paths, bool sphere)
      : RaySensor(std::move(rays), one_band(), paths), sphere_(sphere) {}
  SensorRay ray(const RayRequest& r) const override {
    SensorRay out{rays_[r.problem], sphere_ ? 4 * kPi : kPi};
    out.receiver = sphere_ ? SensorRay::Receiver::sphere : SensorRay::Receiver::plane;
    return out;
  }

 private:
  bool sphere_;
};

std::shared_ptr<Scene> water(double bed, double absorption, double bottom) {
  auto scene = std::make_shared<Scene>();
  scene->media = {medium(Curve::constant(absorption), Curve::constant(0))};
  scene->media[0].index = Curve::constant(kIndex);
  scene->materials = {material("bed", lambert(bed)),
                      material("surface", {"dielectric", {}, {{"index", Curve::constant(kIndex)}}, {}, nullptr})};
  scene->materials[1].inside = 0;
  place(*scene, PrimitiveKind::plane, {0, 0}, 0, translation({0, 0, -bottom}));
  place(*scene, PrimitiveKind::plane, {0, 0}, 1);
  check_scene(*scene, "water");
  return scene;
}

double integral(const std::function<double(double)>& f) {
  constexpr int n = 20000;
  double sum = 0;
  for (int i = 0; i < n; ++i) sum += f((i + 0.5) / n) / n;
  return sum;
}

struct Light {
  double down = 0, up = 0, scalar = 0;
};
// What sun and sky bring to a depth through the surface alone; c, w: cosines above and below it.
Light through(double depth, double a) {
  const auto below = [](double c) { return std::sqrt(1 - (1 - c * c) / (kIndex * kIndex)); };
  const auto flux = [&](double c) {
    return c * fresnel_dielectric(c, kIndex).transmittance * std::exp(-a * depth / below(c));
  };
  const double s = std::cos(kSun);
  return {flux(s) + 2 * kPi * kSky * integral(flux), 0,
          flux(s) / below(s) + 2 * kPi * kSky * integral([&](double c) { return flux(c) / below(c); })};
}
// With the bed, whose diffuse light the surface sends back in part.
Light closed_form(double depth, double bed, double a) {
  const auto returned = [](double c) { return fresnel_dielectric(c, 1 / kIndex).reflectance; };
  const double inside = integral([&](double c) { return 2 * c * returned(c) * std::exp(-2 * a * kBottom / c); }),
               shines = bed * through(kBottom, a).down / (1 - bed * inside);
  Light l = through(depth, a);
  const auto up = [&](double c) { return std::exp(-a * (kBottom - depth) / c); };
  const auto down = [&](double c) { return returned(c) * std::exp(-a * (kBottom + depth) / c); };
  l.up = shines * integral([&](double c) { return 2 * c * up(c); });
  l.down += shines * integral([&](double c) { return 2 * c * down(c); });
  l.scalar += shines * integral([&](double c) { return 2 * (up(c) + down(c)); });
  return l;
}

Light look(double depth, double bed, Light& error, double absorption = kAbsorption, double bottom = kBottom) {
  SourceSpecs sources;
  sources.add(SunSpec{dir_from_angles(kSun, 0), 0, Curve::constant(1)});
  sources.add(uniform_sky(kSky, false));
  const Vec3 at{0, 0, -depth};
  const auto run = [&](std::vector<Ray> rays, bool sphere) {
    const Rendered r =
        render(water(bed, absorption, bottom), sources, std::make_unique<Receivers>(std::move(rays), 1 << 12, sphere));
    EXPECT_EQ(r.report.statistics.failures, 0u);
    return r.result;
  };
  const CaptureResult planes = run({{at, {0, 0, 1}, 0}, {at, {0, 0, -1}, 0}}, false),
                      sphere = run({{at, {0, 0, 1}, 0}}, true);
  error = {planes.standard_error[0], planes.standard_error[1], sphere.standard_error[0]};
  return {planes.radiance[0], planes.radiance[1], sphere.radiance[0]};
}

TEST(WaterIrradiance, IsThatOfTheClosedForm) {
  for (const double bed : {0.0, 0.5})
    for (const double depth : {0.01, 1.0, 2.5}) {
      Light error;
      const Light seen = look(depth, bed, error), truth = closed_form(depth, bed, kAbsorption),
                  other = closed_form(depth, bed, 1.03 * kAbsorption);
      std::printf("bed %.1f, depth %.2f: Ed %.5f (%.5f +- %.5f), Eu %.5f (%.5f +- %.5f), E0 %.5f (%.5f +- %.5f)\n", bed,
                  depth, truth.down, seen.down, error.down, truth.up, seen.up, error.up, truth.scalar, seen.scalar,
                  error.scalar);
      EXPECT_NEAR(seen.down, truth.down, 4 * error.down + 1e-5);
      EXPECT_NEAR(seen.up, truth.up, 4 * error.up + 1e-5);
      EXPECT_NEAR(seen.scalar, truth.scalar, 4 * error.scalar + 1e-5);
      EXPECT_LT(error.down, 0.005 * truth.down);
      EXPECT_LT(error.scalar, 0.01 * truth.scalar);
      if (depth > 2) {
        EXPECT_GT(truth.down - other.down, 4 * error.down) << "control: 3 % more absorption is seen";
      }
    }
}

// A millimetre and a kilometre of water, and an optical depth of 50, where 1e-24 of the light is left.
TEST(WaterIrradiance, AtItsExtremes) {
  constexpr struct { double depth, absorption; } kCases[] = {{1e-3, 0.3}, {1000, 1e-3}, {1000, 0.05}};
  for (const auto& [depth, absorption] : kCases) {
    Light error;
    const Light seen = look(depth, 0, error, absorption, depth + 1), truth = through(depth, absorption);
    std::printf("depth %g m, absorption %g 1/m: Ed %.5g (%.5g +- %.2g), E0 %.5g (%.5g +- %.2g)\n", depth, absorption,
                truth.down, seen.down, error.down, truth.scalar, seen.scalar, error.scalar);
    EXPECT_NEAR(seen.down, truth.down, 4 * error.down + 1e-4 * truth.down);
    EXPECT_NEAR(seen.scalar, truth.scalar, 4 * error.scalar + 1e-4 * truth.scalar);
    EXPECT_LT(error.down, 0.03 * truth.down);
  }
}

}  // namespace
}  // namespace suite::test::water_irradiance_test
