// Sunlight and sky on faces: closed forms.
#include <gtest/gtest.h>

#include <cmath>

#include "support/heated_scene_kit.h"
#include "support/slab_kit.h"

namespace suite::sunlit_test {
namespace {

using namespace test;

constexpr double kDisk = 0.00465;  // rad, of the sun

// A black wall on an endless, perfectly white, even ground, facing a sun at 30 degrees of elevation with irradiance E:
// it takes E cos 30 from the sun and half of the E sin 30 that the ground returns.
TEST(Sunlit, BlackWallOverWhiteGround) {
  HeatedScene s;
  const uint32_t wall = s.heated(1, heat()), ground = s.given(0, 300);
  s.plane(0, 0, ground);
  s.plane(3, 3, wall, with_axes({0, 1, 0}, {0, 0, 1}, {0, 0, 1.5}));  // faces east
  const HeatKit kit(std::move(s), 16);
  const double up = 30 * kDegree, exact = std::cos(up) + std::sin(up) / 2;
  const auto absorbed = [&](double elevation, double disk) {
    const std::vector<double> moments{0, 600, 1200};
    const Sunlight sun =
        kit.sunlight(still_sun({std::cos(elevation), 0, std::sin(elevation)}, disk, moments), {8, 512, 1});
    double sum = 0, area = 0;
    for (size_t e = 0; e < kit.elements->size(); ++e) {
      area += (*kit.elements)[e].area;
      for (size_t k = 0; k < 3; ++k) sum += (*kit.elements)[e].area * sun.beam.at(e, k) / 3;
    }
    return sum / area;
  };
  const double value = absorbed(up, kDisk);
  std::printf("black wall over white ground: %.5f of %.5f (%+.3f %%)\n", value, exact, 100 * (value / exact - 1));
  EXPECT_NEAR(value, exact, 0.003 * exact);
  // A sun in the wall's plane and one behind it leave what the ground returns; behind, the wall's shadow lies before
  // it.
  EXPECT_NEAR(absorbed(kPi / 2, 0), 0.5, 0.003);
  EXPECT_LT(absorbed(kPi - up, kDisk), 0.95 * std::sin(up) / 2);
}

// A black sphere in the sun and an even sky all around: every element has the balance of its own, and all together take
// E / 4 and what the sky sends.
TEST(Sunlit, BlackSphereInSunAndEvenSky) {
  HeatedScene s;
  s.exact(PrimitiveKind::sphere, {1}, s.heated(1, heat()));
  const HeatKit kit(std::move(s), 200);
  const double E = 1000, sky = black(250);
  const Dir towards = normalized(Vec3{0.3, -0.5, 0.6});
  const std::vector<double> moments{0, 43200, 86400};
  // Points of an element: many, so that the mean of the cosine over it is met.
  const Sunlight sun = kit.sunlight(still_sun(towards, 0, moments), {8, 512, 1});
  const ExchangePaths paths = kit.exchange({8, 8, 1});
  const ExchangeMatrix matrix = paths.matrix(kit.faces->outsides());
  CoupledSurfaces surfaces(surface_groups(*kit.elements, *kit.faces, kit.optics, paths.emissivity), matrix);
  surfaces.start(300);
  SurfaceLoads loads = still_exchange(kit, outsides_at(kit, 250), {0, 86400}, 2);
  loads.absorbed = absorbed_of(sun, E);
  const SurfaceHistory h = surfaces.solve(loads);
  double worst = 0, absorbed = 0, area = 0;
  for (size_t e = 0; e < kit.elements->size(); ++e) {
    // The mean cosine over the element, from many points of it.
    double cosine = 0;
    constexpr uint32_t kPoints = 1 << 14;
    const SampleStream stream(99, 0, e);
    for (uint32_t k = 0; k < kPoints; ++k)
      cosine += std::fmax(0.0, dot(kit.elements->point(e, {stream, k, 0}).normal, towards)) / kPoints;
    const double exact = std::sqrt(std::sqrt((E * cosine + sky) / kStefanBoltzmann));
    worst = std::fmax(worst, std::fabs(h.kelvin_at(e, 1) - exact));
    const double a = (*kit.elements)[e].area;
    area += a, absorbed += a * loads.absorbed.at(e, 1);
  }
  std::printf("black sphere: elements within %.4f K, absorbs %.3f W/m2 of %.3f, area %.5f of %.5f\n", worst,
              absorbed / area, E / 4, area, 4 * kPi);
  EXPECT_LT(worst, 0.05);
  EXPECT_NEAR(area, 4 * kPi, 1e-9);
  const double mean = std::sqrt(std::sqrt((absorbed / area + sky) / kStefanBoltzmann)),
               exact = std::sqrt(std::sqrt((E / 4 + sky) / kStefanBoltzmann));
  EXPECT_NEAR(mean, exact, 0.05);
}

// The edge of a board's shadow goes over dry ground as the sun rises: every element of 1 cm has the history of the one
// before it, a little later. The sun climbs so that the edge moves evenly.
TEST(Sunlit, SweepingShadowEdge) {
  constexpr double kHeight = 1, kSpeed = 1e-4;  // m, m/s
  constexpr int kCells = 8;
  HeatedScene s;
  TemperatureSpec soil = heat();
  soil.layers = {uniform(0.5, 1600, 900, 0.5)};
  s.plane(0.01 * kCells, 0.05, s.heated(0.9, soil));
  const uint32_t board = s.given(1, 300);
  s.plane(2, 4, board, shifted({1, 0, kHeight}));  // its edge lies above x = 0
  const double length = 2400, step = 10;
  const HeatKit kit(std::move(s), kCells * 5, {0, length});
  // At time t the shadow begins at x = kSpeed t - 0.12 (m) and the sun stands over there.
  const auto towards = [&](double t) {
    const double x = kSpeed * t - 0.12;
    return normalized(Vec3{-x, 0, kHeight});
  };
  const auto steps = static_cast<size_t>(length / step);
  SunCourse course = still_sun({0, 0, 1}, 0, evenly({0, length}, steps));
  course.towards = towards;
  const auto run = [&](uint32_t paths) {
    const Sunlight sun = kit.sunlight(course, {8, paths, 5});
    const ExchangePaths exchange = kit.exchange({8, 8, 1});
    const ExchangeMatrix matrix = exchange.matrix(kit.faces->outsides());
    CoupledSurfaces surfaces(surface_groups(*kit.elements, *kit.faces, kit.optics, exchange.emissivity), matrix);
    surfaces.start(300);
    SurfaceLoads loads = still_exchange(kit, outsides_at(kit, 300), {0, length}, steps);
    loads.absorbed = absorbed_of(sun, 800);
    SurfaceOptions options;
    options.periodic = false;
    return surfaces.solve(loads, options);
  };
  const auto off_itself = [&](const SurfaceHistory& h) {
    double worst = 0, warmest = 0;
    const double later = 0.01 / kSpeed / step;  // moments from one column to the next
    for (size_t a = 0; a < kit.elements->size(); ++a)
      for (size_t b = 0; b < kit.elements->size(); ++b) {
        const double columns = std::round(((*kit.elements)[b].centre.x - (*kit.elements)[a].centre.x) / 0.01);
        if (columns != 1) continue;
        for (size_t k = 0; k + static_cast<size_t>(later) < h.moments; ++k) {
          // Lit from the start: only since the edge passes do both begin alike.
          worst = std::fmax(worst, std::fabs((h.kelvin_at(b, k + static_cast<size_t>(later)) - h.kelvin_at(b, 0)) -
                                             (h.kelvin_at(a, k) - h.kelvin_at(a, 0))));
          warmest = std::fmax(warmest, h.kelvin_at(a, k));
        }
      }
    EXPECT_GT(warmest, 303);
    return worst;
  };
  const double many = off_itself(run(1024)), few = off_itself(run(8));
  std::printf("shadow edge at %.1g m/s over elements of 1 cm: %.4f K with 1024 points an element, %.3f K with 16\n",
              kSpeed, many, few);
  EXPECT_LT(many, 0.05);
  // 16 points are what 64 paths, the default, have.
  EXPECT_LT(few, 0.05);
}

}  // namespace
}  // namespace suite::sunlit_test
