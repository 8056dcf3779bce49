// Energy in water under any surface: what comes down from a direction is reflected, absorbed or leaves again. By
// reciprocity a view from there sees, in a furnace, 1 as the sum of what is reflected and what leaves, where nothing
// absorbs; and where water and bed absorb and are as warm as the sky, Planck's radiance: what is missing of 1 is what
// they send by Kirchhoff's law. Waves of light's own (flat), Cox & Munk's slopes at 2 and 14 m/s, and resolved ones.
#include <gtest/gtest.h>

#include <cmath>

#include "spectral/planck.h"
#include "tests/support/media_kit.h"
#include "tests/support/radiometry_kit.h"

namespace suite::test::water_energy_test {
namespace {

constexpr double kIndex = 1.33, kDepth = 1, kKelvin = 300, kWavelength = 10;

enum class Waves { flat, wind_2, wind_14, resolved };
constexpr Waves kWaves[] = {Waves::flat, Waves::wind_2, Waves::wind_14, Waves::resolved};
const char* name(Waves w) {
  constexpr const char* names[] = {"flat", "2 m/s", "14 m/s", "resolved"};
  return names[static_cast<int>(w)];
}

// Mean square slope of both directions: C. Cox & W. Munk, J. Opt. Soc. Am. 44, 1954.
ModelSpec surface_of(Waves w) {
  ModelSpec s{"dielectric", {}, {{"index", Curve::constant(kIndex)}}, {}, nullptr};
  if (w != Waves::wind_2 && w != Waves::wind_14) return s;
  s.model = "ggx_dielectric";
  s.numbers["roughness"] = std::sqrt(0.003 + 0.00512 * (w == Waves::wind_2 ? 2 : 14));
  return s;
}

std::shared_ptr<Scene> water(Waves waves, double absorption, double scattering, bool warm) {
  auto scene = std::make_shared<Scene>();
  Material bed = material("bed", lambert(warm ? 0.3 : 1)), surface = material("surface", surface_of(waves));
  if (absorption > 0 || scattering > 0) {
    scene->media = {medium(Curve::constant(absorption), Curve::constant(scattering), hg(0.9))};
    scene->media[0].index = Curve::constant(kIndex);
    if (warm) scene->media[0].temperature_k = kKelvin;
    surface.inside = 0;
  }
  if (warm) bed.temperature_k = kKelvin;
  scene->materials = {bed, surface};
  place(*scene, PrimitiveKind::plane, {0, 0}, 0, translation({0, 0, -kDepth}));
  if (waves == Waves::resolved)  // slopes up to 0.3
    place(*scene, PrimitiveKind::sinusoid, {2000, 2000, 0.05, 3, 0, 0.4, 0.03, -1, 4, 1}, 1);
  else
    place(*scene, PrimitiveKind::plane, {0, 0}, 1);
  check_scene(*scene, "water");
  return scene;
}

// As many as make a standard error of 0.6 times the tolerance. Where nothing absorbs most paths bring 1: 8,000 of them
// see, at 3.5 errors, what loses 0.4 % of the light.
uint32_t paths_of(Waves waves, double scattering, bool warm) {
  if (!warm) return waves == Waves::wind_14 ? 2560 : waves == Waves::wind_2 ? 768 : 128;
  if (scattering > 0) return 1408;
  return waves == Waves::wind_14 ? 256 : waves == Waves::wind_2 ? 160 : 96;
}

// Views from straight above to the edge; 1 is expected.
void expect_one(Waves waves, double absorption, double scattering, bool warm, double tolerance) {
  const std::vector<Band> bands{Band::rectangular("b", kWavelength, 0.01)};
  const double radiance = warm ? planck_radiance(kWavelength, kKelvin) : 1;
  SourceSpecs sources;
  sources.add(uniform_sky(radiance, true));
  PipelineOptions options;
  options.max_scatterings = 100000;
  const auto scene = water(waves, absorption, scattering, warm);
  const uint32_t paths = paths_of(waves, scattering, warm);
  for (const double zenith : {0.0, 60.0}) {
    const Dir view = dir_from_angles(zenith * kDegree, 0.7);
    const auto r =
        render(scene, sources, std::make_unique<RaySensor>(repeated({view * 20, -view, 0}), bands, paths), options);
    EXPECT_EQ(r.report.statistics.failures, 0u);
    const Repeated seen = over_problems(r.result, 0);
    const double mean = seen.mean / radiance, error = seen.error / radiance;
    std::printf("%s, absorption %g, scattering %g, %g deg: %.5f +- %.5f\n", name(waves), absorption, scattering, zenith,
                mean, error);
    EXPECT_NEAR(mean, 1, tolerance + 3.5 * error);  // p = 5e-4 of the noise alone
    EXPECT_LT(error, 0.6 * tolerance) << "not resolved";
  }
}

// Negative control: a bed that is 2 K colder sends 3 % less of its light, a fifth of all.
TEST(WaterEnergy, ColderBedsAreSeen) {
  auto scene = water(Waves::flat, 0.3, 0, true);
  scene->materials[0].temperature_k = kKelvin - 2;
  const double radiance = planck_radiance(kWavelength, kKelvin);
  SourceSpecs sources;
  sources.add(uniform_sky(radiance, true));
  const auto r =
      render(scene, sources,
             std::make_unique<RaySensor>(repeated({{0, 0, 20}, {0, 0, -1}, 0}),
                                         std::vector<Band>{Band::rectangular("b", kWavelength, 0.01)}, 1024));
  const Repeated seen = over_problems(r.result, 0);
  EXPECT_LT(seen.mean, radiance - 3.5 * seen.error - 0.002 * radiance);
}

TEST(WaterEnergy, WhatIsNotAbsorbedComesBack) {
  for (const Waves w : kWaves)
    for (const double scattering : {0.0, 1.0}) expect_one(w, 0, scattering, false, 0.002);
}

TEST(WaterEnergy, WhatIsAbsorbedIsWhatIsMissing) {
  for (const Waves w : kWaves)
    for (const double scattering : {0.0, 1.0}) expect_one(w, 0.3, scattering, true, 0.002);
}

}  // namespace
}  // namespace suite::test::water_energy_test
