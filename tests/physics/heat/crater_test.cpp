// The shadow in a bowl-shaped crater without air: a closed form, because in a sphere all sees all alike.
#include <gtest/gtest.h>

#include <cmath>

#include "math/stats.h"
#include "support/heated_scene_kit.h"

namespace suite::crater_test {
namespace {

using namespace test;

struct Bowl {
  double radius = 100;  // m, of the sphere
  double rim = 0;       // rad, from its axis
};

// Facets of a bowl below z = 0, seen from above, whose corners lie on the sphere.
Mesh bowl_mesh(const Bowl& b, uint32_t material) {
  constexpr uint32_t kRings = 60, kTurns = 240;
  std::vector<Vec3> corners;
  std::vector<uint32_t> indices;
  for (uint32_t i = 0; i <= kRings; ++i)
    for (uint32_t j = 0; j < kTurns; ++j) {
      const double a = b.rim * i / kRings, turn = 2 * kPi * j / kTurns, r = b.radius * std::sin(a);
      corners.push_back({r * std::cos(turn), r * std::sin(turn), b.radius * (std::cos(b.rim) - std::cos(a))});
    }
  for (uint32_t i = 0; i < kRings; ++i)
    for (uint32_t j = 0; j < kTurns; ++j) {
      const uint32_t p = i * kTurns + j, q = i * kTurns + (j + 1) % kTurns, up = kTurns;
      indices.insert(indices.end(), {p + up, q + up, q});
      if (i > 0) indices.insert(indices.end(), {p + up, q, p});
    }
  return mesh_of(corners, indices, material);
}

// K. A share s of the sphere is bowl; all of it is lit alike by what any part of it sends. With P the sunlight that
// enters, per area of the whole sphere, the bowl's light is A P / (1 - A s), what it absorbs of sunlight
// (1 - A) P / (1 - A s), and its infrared that over (1 - s). Source: A. P. Ingersoll, T. Svitek, B. C. Murray, Icarus
// 100, 40-47, 1992, whose formula this is.
double shadow_kelvin(const Bowl& b, double E, double elevation, double albedo, double emissivity,
                     bool scatters = true) {
  const double s = (1 - std::cos(b.rim)) / 2;
  const double P = E * std::sin(elevation) * std::pow(std::sin(b.rim), 2) / 4;
  const double light = scatters ? albedo * P / (1 - albedo * s) : 0, taken = (1 - albedo) * P / (1 - albedo * s);
  const double infrared = taken / (1 - s);
  return std::pow(((1 - albedo) * light + emissivity * infrared) / (emissivity * kStefanBoltzmann), 0.25);
}

TEST(Crater, ShadowOfABowl) {
  constexpr double E = 1361;
  for (const auto& [depth, elevation, albedo] :
       {std::array{0.2, 10.0, 0.12}, std::array{0.1, 5.0, 0.12}, std::array{0.25, 15.0, 0.5}}) {
    const Bowl bowl{100, 2 * std::atan(2 * depth)};  // depth over diameter
    HeatedScene s;
    s.mesh(bowl_mesh(bowl, s.heated(1 - albedo, heat())));
    const HeatKit kit(std::move(s), 400);
    const double up = elevation * kDegree;
    const std::vector<double> moments{0, 43200, 86400};
    const Sunlight sun = kit.sunlight(still_sun({std::cos(up), 0, std::sin(up)}, 0.00465, moments), {8, 128, 1});
    const ExchangePaths paths = kit.exchange({8, 128, 1});
    const ExchangeMatrix matrix = paths.matrix(kit.faces->outsides());
    CoupledSurfaces surfaces(surface_groups(*kit.elements, *kit.faces, kit.optics, paths.emissivity), matrix);
    surfaces.start(200);
    SurfaceLoads loads = still_exchange(kit, outsides_at(kit, 3), {0, 86400}, 2);
    loads.absorbed = absorbed_of(sun, E);
    const SurfaceHistory h = surfaces.solve(loads);
    RunningStats shade, emits;  // the noise of paths is in what is emitted, not in kelvin
    for (size_t e = 0; e < kit.elements->size(); ++e)
      if (sun.sun_hours[e] == 0) shade.add(h.kelvin_at(e, 1)), emits.add(black(h.kelvin_at(e, 1)));
    const double exact = shadow_kelvin(bowl, E, up, albedo, 1 - albedo);
    const double found = std::pow(emits.mean() / kStefanBoltzmann, 0.25);
    std::printf("bowl %.2f deep, sun at %g deg, albedo %.2f: %.3f K of %.3f in %llu shaded elements, spread %.2f K\n",
                depth, elevation, albedo, found, exact, static_cast<unsigned long long>(shade.n()),
                std::sqrt(shade.variance()));
    EXPECT_GT(shade.n(), 20u);
    EXPECT_NEAR(found, exact, 0.3);
    // Negative control: sunlight that the bowl scatters is seen.
    EXPECT_GT(exact - shadow_kelvin(bowl, E, up, albedo, 1 - albedo, false), 2);
  }
}

}  // namespace
}  // namespace suite::crater_test
