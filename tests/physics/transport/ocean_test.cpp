// Light in a deep ocean under a flat surface: problems 1 (molecules) and 2 (Petzold's particles) of C. Mobley et al.,
// "Comparison of numerical models for computing underwater light fields", Appl. Opt. 32, 1993, at b / c of 0.2 and 0.9.
// A solution by matrices (tests/support/ocean_reference.h) is compared with the published means, and the renderer with
// that solution, of two layers as well: within 1 % of irradiances and 2 % of the nadir radiance and three standard
// errors; the run under the label `long` (SUITE_LONG) resolves these bounds with 64 times the paths.
#include <gtest/gtest.h>

#include <array>
#include <cstdlib>

#include "optics/phases/sea_particles.h"
#include "tests/support/media_kit.h"
#include "tests/support/ocean_reference.h"
#include "tests/support/ring_light.h"

namespace suite::test {
namespace {

constexpr double kIndex = 1.34, kMuSun = 0.5;

double molecules(double c) { return 3 / (16 * kPi) * (1 + c * c); }
std::function<double(double)> phase_of(bool petzold) {
  if (!petzold) return molecules;
  return [table = petzold_table()](double c) { return table.at(c); };
}

struct Published {
  bool petzold;
  double albedo, up_scalar, nadir;  // at depth 1, the sun at 60 degrees giving 0.5 on a level plane above the surface
};
// Means over the models that took part (their table of problems 1 and 2), as a public validation of another program
// quotes them. They are means of up to seven codes, most of them Monte Carlo, which differ by some per cent.
constexpr std::array<Published, 4> kPublished{{{false, 0.9, 0.372, 4.85e-2},
                                               {false, 0.2, 1.34e-2, 1.72e-3},
                                               {true, 0.9, 9.31e-2, 6.99e-3},
                                               {true, 0.2, 9.66e-4, 5.47e-5}}};

TEST(Ocean, TheReferenceIsWhatWasPublished) {
  for (const Published& p : kPublished) {
    const OceanLight light = OceanReference(phase_of(p.petzold), p.albedo, kIndex, kMuSun, 16).under_sun(1);
    std::printf("problem %d, b/c %.1f, depth 1: Ed %.4g, Eou %.4g (published %.3g), Lu %.4g (%.3g)\n",
                p.petzold ? 2 : 1, p.albedo, 0.5 * light.down, 0.5 * light.up_scalar, p.up_scalar, 0.5 * light.nadir,
                p.nadir);
    EXPECT_NEAR(0.5 * light.up_scalar / p.up_scalar, 1, 0.015);
    EXPECT_NEAR(0.5 * light.nadir / p.nadir, 1, p.petzold ? 0.035 : 0.015);
  }
}

TEST(Ocean, TheReferenceConvergesAndKeepsEnergy) {
  const OceanReference coarse(phase_of(true), 0.9, kIndex, kMuSun, 10), fine(phase_of(true), 0.9, kIndex, kMuSun, 20);
  for (const double depth : {0.0, 1.0}) {
    EXPECT_NEAR(coarse.under_sun(depth).up / fine.under_sun(depth).up, 1, 3e-3);
    EXPECT_NEAR(coarse.under_sun(depth).nadir / fine.under_sun(depth).nadir, 1, 3e-3);
  }
  // Gershun's law: the net irradiance falls by what is absorbed. Without absorption it is the same at all depths, and
  // 0 in an endless body of water; at b / c = 1 - 1e-9 next to it.
  const OceanReference white(molecules, 1 - 1e-9, kIndex, kMuSun, 10);
  for (const double depth : {0.0, 1.0, 5.0}) {
    const OceanLight l = white.under_sky(depth);
    EXPECT_LT(std::fabs(l.down - l.up), 0.03 * l.down) << "128 depths of it";
  }
}

Medium water(bool petzold, double albedo) {
  const ModelSpec phase{petzold ? "petzold" : "rayleigh", {}, {}, {}, nullptr};
  Medium m = medium(Curve::constant(1 - albedo), Curve::constant(albedo), phase);
  m.index = Curve::constant(kIndex);
  return m;
}
std::shared_ptr<Scene> ocean(bool petzold, double albedo, const std::optional<Medium>& deep = std::nullopt) {
  auto scene = std::make_shared<Scene>();
  scene->media = {water(petzold, albedo)};
  Material surface = material("surface", {"dielectric", {}, {{"index", Curve::constant(kIndex)}}, {}, nullptr});
  surface.inside = 0;
  scene->materials = {surface};
  place(*scene, PrimitiveKind::plane, {0, 0}, 0);
  if (deep) {
    scene->media.push_back(*deep);
    scene->media.back().id = "deep", scene->media.back().priority = 1;
    scene->materials.push_back(boundary(1));
    place(*scene, PrimitiveKind::plane, {0, 0}, 1, translation({0, 0, -1}));
  }
  check_scene(*scene, "ocean");
  return scene;
}

struct Seen {
  Repeated down, up, nadir;
};
// 64 problems of each kind.
Seen look(const std::shared_ptr<const Scene>& scene, const SourceSpecs& sources, double depth, uint32_t paths) {
  const Vec3 at{0, 0, -depth};
  PipelineOptions options;
  options.seed = 3;
  options.max_scatterings = 100000;
  const auto run = [&](auto sensor) {
    const auto r = render(scene, sources, std::move(sensor), options);
    EXPECT_EQ(r.report.statistics.failures, 0u);
    return over_problems(r.result, 0);
  };
  Seen s;
  s.down = run(std::make_unique<FluxSensor>(repeated({at, {0, 0, 1}, 0}), one_band(), paths));
  s.up = run(std::make_unique<FluxSensor>(repeated({at, {0, 0, -1}, 0}), one_band(), paths));
  s.nadir = run(std::make_unique<RaySensor>(repeated({at, {0, 0, -1}, 0}), one_band(), paths));
  return s;
}

bool long_run() { return std::getenv("SUITE_LONG") != nullptr; }
uint32_t paths(uint32_t quick) { return long_run() ? 64 * quick : quick; }

void expect(const char* what, const Repeated& seen, double scale, double truth, double bound) {
  const double error = scale * seen.mean / truth - 1, noise = scale * seen.error / truth;
  std::printf("  %s %.5g, %+.2f %% +- %.2f %%\n", what, truth, 100 * error, 100 * noise);
  EXPECT_LT(std::fabs(error), bound + 3 * noise) << what;
  EXPECT_LT(noise, long_run() ? bound : 0.12) << what << ": not resolved";
}

TEST(Ocean, RendersAsTheReferenceUnderASky) {
  SourceSpecs sources;
  sources.add(uniform_sky(1, false));
  for (const bool petzold : {false, true})
    for (const double albedo : {0.2, 0.9}) {
      const OceanReference reference(phase_of(petzold), albedo, kIndex, kMuSun, 16);
      std::printf("sky, problem %d, b/c %.1f\n", petzold ? 2 : 1, albedo);
      const Seen seen = look(ocean(petzold, albedo), sources, 1, paths(2048));
      const OceanLight truth = reference.under_sky(1);
      expect("Ed", seen.down, kPi, truth.down, 0.01);
      expect("Eu", seen.up, kPi, truth.up, 0.01);
      expect("Lu", seen.nadir, 1, truth.nadir, 0.02);
    }
}

// One depth of molecules that scatter much upon particles that absorb much, at the border of both.
TEST(Ocean, RendersLayersAsTheReference) {
  SourceSpecs sources;
  sources.add(uniform_sky(1, false));
  const OceanReference upper(phase_of(false), 0.9, kIndex, kMuSun, 16), deep(phase_of(true), 0.9, kIndex, kMuSun, 16);
  const OceanLight truth = upper.under_sky_upon(deep, 1);
  EXPECT_GT(upper.under_sky(1).up / truth.up, 2) << "the layer below matters";
  const Seen seen = look(ocean(false, 0.9, water(true, 0.9)), sources, 1 - 1e-6, paths(2048));
  std::printf("sky, two layers\n");
  expect("Ed", seen.down, kPi, truth.down, 0.01);
  expect("Eu", seen.up, kPi, truth.up, 0.01);
  expect("Lu", seen.nadir, 1, truth.nadir, 0.02);
}

// The sun at 60 degrees, turned about the vertical: a ring. For what is compared that is the same.
TEST(Ocean, RendersAsTheReferenceUnderARing) {
  const double inner = 58 * kDegree, outer = 62 * kDegree, high = std::cos(inner), low = std::cos(outer);
  RingSpec ring;
  ring.inner = inner, ring.outer = outer;
  ring.radiance = Curve::constant(1 / (kPi * (high * high - low * low)));
  SourceSpecs sources;
  sources.add({std::make_shared<const RingLight>(ring)});
  for (const bool petzold : {false, true}) {
    if (petzold && !long_run()) continue;  // found by chance alone; minutes until it is resolved
    std::printf("ring, problem %d, b/c 0.9\n", petzold ? 2 : 1);
    // Gauss's two points in the squared cosine, which is what the flux goes by.
    OceanLight truth;
    for (const double side : {-1.0, 1.0}) {
      const double mu2 = 0.5 * (high * high + low * low) + side / std::sqrt(3.0) * 0.5 * (high * high - low * low);
      const OceanLight l = OceanReference(phase_of(petzold), 0.9, kIndex, std::sqrt(mu2), 16).under_sun(1);
      truth.down += 0.5 * l.down, truth.up += 0.5 * l.up, truth.nadir += 0.5 * l.nadir;
    }
    const Seen seen = look(ocean(petzold, 0.9), sources, 1, paths(2048));
    expect("Ed", seen.down, kPi, truth.down, 0.01);
    expect("Eu", seen.up, kPi, truth.up, 0.01);
    expect("Lu", seen.nadir, 1, truth.nadir, 0.02);
  }
}

}  // namespace
}  // namespace suite::test
