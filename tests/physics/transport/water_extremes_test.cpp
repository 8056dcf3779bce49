// Water at its extremes: pixels across the edge of total reflection, resolved waves of no wind and of a storm,
// collectors a millimetre and a kilometre deep, and under an optical depth of 50.
#include <gtest/gtest.h>

#include <functional>

#include "optics/fresnel.h"
#include "tests/support/media_kit.h"
#include "water/waves.h"

namespace suite::test::water_extremes_test {
namespace {

constexpr double kIndex = 1.34;
const double kCritical = std::asin(1 / kIndex);

double integral(const std::function<double(double)>& f, double from, double to, int n = 200000) {
  double sum = 0;
  for (int i = 0; i < n; ++i) sum += f(from + (i + 0.5) / n * (to - from));
  return sum * (to - from) / n;
}

Material water_surface() {
  return material("surface", {"dielectric", {}, {{"index", Curve::constant(kIndex)}}, {}, nullptr});
}

// A Lambert bed under flat water, a sky that shines alike: clear, or water as a medium that takes next to nothing.
std::shared_ptr<Scene> flat_water(double bed, bool as_medium) {
  auto scene = std::make_shared<Scene>();
  scene->materials = {material("bed", lambert(bed)), water_surface()};
  if (as_medium) {
    scene->media = {medium(Curve::constant(1e-9), Curve::constant(0))};
    scene->media[0].index = Curve::constant(kIndex);
    scene->materials[1].inside = 0;
  }
  place(*scene, PrimitiveKind::plane, {0, 0}, 0, translation({0, 0, -2}));
  place(*scene, PrimitiveKind::plane, {0, 0}, 1);
  check_scene(*scene, "flat water");
  return scene;
}

// A pixel of `half` to both sides of a zenith angle, looking up from a metre under the surface.
class Pixel final : public RaySensor {
 public:
  Pixel(double zenith, double half, uint32_t paths)
      : RaySensor(repeated({{0, 0, -1}, {0, 0, 1}, 0}), one_band(), paths), zenith_(zenith), half_(half) {}
  SensorRay ray(const RayRequest& r) const override {
    return {{rays_[r.problem].origin, dir_from_angles(zenith_ + (2 * r.u[0] - 1) * half_, 0.3), 0}, 1};
  }
  int numbers() const override { return 1; }

 private:
  double zenith_, half_;
};

// Within it the sky shines through the window, times the index squared; beyond the surface mirrors the bed alone.
TEST(WaterExtremes, PixelsAcrossTheEdgeOfTotalReflection) {
  constexpr double kBed = 0.4;
  const auto mirrored = [](double c) { return fresnel_dielectric(c, 1 / kIndex).reflectance; };
  const double down =
                   integral([](double c) { return 2 * kPi * c * fresnel_dielectric(c, kIndex).transmittance; }, 0, 1),
               back = integral([&](double c) { return 2 * c * mirrored(c); }, 0, 1),
               bed = kBed / kPi * down / (1 - kBed * back);
  const auto seen = [&](double zenith) {
    const double r = mirrored(std::cos(zenith));
    return kIndex * kIndex * (1 - r) + r * bed;
  };
  SourceSpecs sources;
  sources.add(uniform_sky(1, false));
  for (const double half : {1.0, 0.01, 1e-6, 1e-12})
    for (const double aside : {0.0, 0.5, -2.0}) {
      const double zenith = kCritical + aside * half * kDegree, h = half * kDegree;
      const double truth = (integral(seen, zenith - h, kCritical) + integral(seen, kCritical, zenith + h)) / (2 * h);
      const uint32_t paths = half == 1 ? 1024 : half == 0.01 ? 640 : 320;  // the wider, the more differs within
      for (const bool as_medium : {false, true}) {
        const auto r = render(flat_water(kBed, as_medium), sources, std::make_unique<Pixel>(zenith, h, paths));
        EXPECT_EQ(r.report.statistics.failures, 0u);
        const Repeated got = over_problems(r.result, 0);
        std::printf("pixel of +- %g deg, %+.1f of it aside: %.5f +- %.5f of %.5f\n", half, aside, got.mean, got.error,
                    truth);
        EXPECT_NEAR(got.mean, truth, 4 * got.error + 1e-4 * truth);
        EXPECT_LT(got.error, 0.003 * truth);
      }
    }
  // Negative control: a pixel that lies a half of itself aside is told apart.
  const double h = kDegree;
  EXPECT_GT(integral(seen, kCritical - 1.5 * h, kCritical + 0.5 * h) / integral(seen, kCritical - h, kCritical + h),
            1.1);
}

// Waves of a wind over a short fetch, as facets; as scene-prep makes them.
struct Facets {
  Mesh mesh;
  double steepest = 0;
};
constexpr int kVertices = 241;  // a side
constexpr double kStep = 0.25;  // m
Facets facets_of(double wind) {
  constexpr int n = kVertices;
  constexpr double step = kStep;
  SeaState sea;
  sea.wind_m_s = wind, sea.fetch_m = 2000;
  const Waves waves(sea, kPi / (2 * step), 200, 3);
  std::vector<float> row(n);
  std::vector<Vec3> v;
  std::vector<uint32_t> f;
  double steepest = 0;
  for (uint32_t j = 0; j < n; ++j) {
    const double y = (j - 0.5 * (n - 1)) * step;
    waves.row(-0.5 * (n - 1) * step, y, step, 0, row);
    for (uint32_t i = 0; i < n; ++i) {
      v.push_back({(i - 0.5 * (n - 1)) * step, y, double{row[i]}});
      if (i > 0) steepest = std::fmax(steepest, std::fabs(row[i] - row[i - 1]) / step);
    }
  }
  for (uint32_t j = 0; j + 1 < n; ++j)
    for (uint32_t i = 0; i + 1 < n; ++i) {
      const uint32_t a = j * n + i;
      for (const uint32_t k : {a, a + 1, a + n + 1, a, a + n + 1, a + n}) f.push_back(k);
    }
  return {mesh_of(v, f, 1), steepest};
}
const Facets& storm() {
  static const Facets of_30_m_s = facets_of(30);
  return of_30_m_s;
}

// Over a bed, in a basin whose walls rise to a height, lest light leave under the edge of the surface.
std::shared_ptr<Scene> over_bed(const Facets& waves, double bed, double wall = 3) {
  constexpr double kWall = 0.49 * (kVertices - 1) * kStep;
  std::vector<Vec3> corners;
  for (int i = 0; i < 8; ++i) corners.push_back({i & 1 ? kWall : -kWall, i & 2 ? kWall : -kWall, i & 4 ? wall : -3.0});
  const Mesh basin =
      mesh_of(corners, {0, 1, 3, 0, 3, 2, 0, 4, 5, 0, 5, 1, 2, 3, 7, 2, 7, 6, 0, 2, 6, 0, 6, 4, 1, 5, 7, 1, 7, 3}, 0);
  return scene_of({waves.mesh, basin}, {material("bed", lambert(bed)), water_surface()});
}

// Looks down from above at places spread over some metres.
class Footprint final : public RaySensor {
 public:
  Footprint(Dir view, uint32_t paths) : RaySensor(repeated({view * 60, -view, 0}), one_band(), paths) {}
  SensorRay ray(const RayRequest& r) const override {
    Ray ray = rays_[r.problem];
    ray.origin += Vec3{4 * r.u[0] - 2, 4 * r.u[1] - 2, 0};
    return {ray, 1};
  }
};

// A furnace: nothing is lost or found between steep waves, at grazing views either.
TEST(WaterExtremes, WavesOfAStormKeepEnergy) {
  SourceSpecs sources;
  sources.add(uniform_sky(1, true));
  // A loss of 0.4 % is seen at 3.5 standard errors by 12,000 paths.
  for (const double wind : {0.0, 30.0}) {
    const Facets waves = wind > 0 ? storm() : facets_of(wind);
    const double steepest = waves.steepest;
    const auto scene = over_bed(waves, 1);
    std::printf("wind %g m/s, slopes up to %.2f\n", wind, steepest);
    if (wind > 0)
      EXPECT_GT(steepest, 0.3);
    else
      EXPECT_EQ(steepest, 0);
    for (const double zenith : {0.0, 70.0}) {
      const auto r = render(scene, sources, std::make_unique<Footprint>(dir_from_angles(zenith * kDegree, 0.7), 192));
      EXPECT_EQ(r.report.statistics.failures, 0u);
      const Repeated seen = over_problems(r.result, 0);
      std::printf("  %g deg: %.5f +- %.5f\n", zenith, seen.mean, seen.error);
      EXPECT_NEAR(seen.mean, 1, 0.002 + 3.5 * seen.error);
      EXPECT_LT(seen.error, 0.002);
    }
  }
  // Negative control: walls that end below the surface let light out.
  const auto r = render(over_bed(storm(), 1, -2), sources, std::make_unique<Footprint>(Dir{0, 0, 1}, 64));
  EXPECT_LT(over_problems(r.result, 0).mean, 0.99);
}

// A wide sun that is asked for through such waves, and one that is met by chance.
TEST(WaterExtremes, TheSunThroughWavesOfAStorm) {
  const auto scene = over_bed(storm(), 0.5);
  SourceSpecs sources;
  sources.add(SunSpec{dir_from_angles(40 * kDegree, 2), 10 * kDegree, Curve::constant(1)});
  Repeated seen[2];
  for (const bool asked : {true, false}) {
    PipelineOptions options;
    options.refracted_sources = asked;
    const auto r = render(scene, sources,
                          std::make_unique<Footprint>(dir_from_angles(20 * kDegree, 0.7), asked ? 256 : 2048), options);
    EXPECT_EQ(r.report.statistics.failures, 0u);
    seen[asked] = over_problems(r.result, 0);
    std::printf("%s: %.5f +- %.5f\n", asked ? "asked" : "by chance", seen[asked].mean, seen[asked].error);
    EXPECT_LT(seen[asked].error, 0.02 * seen[asked].mean);
  }
  EXPECT_NEAR(seen[0].mean, seen[1].mean, 3.5 * std::hypot(seen[0].error, seen[1].error));
}

}  // namespace
}  // namespace suite::test::water_extremes_test
