// Light in a deep ocean under a flat surface: problems 1 (molecules) and 2 (Petzold's particles) of C. Mobley et al.,
// "Comparison of numerical models for computing underwater light fields", Appl. Opt. 32, 1993, at b / c of 0.2 and 0.9.
// A solution by matrices (tests/support/ocean_reference.h) is compared with the published means, and the renderer with
// that solution, of two layers and of a profile of seven (problem 3's kind) as well: within 1 % of irradiances and 2 %
// of the nadir radiance and three standard errors; in the run under the label `long` (SUITE_LONG) within these bounds,
// with a noise of a third of them, where kMostRounds make it as small. They do not for the sun over the profile, whose
// layers chains of scatterings do not leave (transport/techniques/volume_chains.h): there the error bars stay part of
// the bound.
#include <gtest/gtest.h>

#include <array>
#include <cstdlib>

#include "optics/phases/sea_particles.h"
#include "tests/support/media_kit.h"
#include "tests/support/ocean_reference.h"
#include "tests/support/ring_light.h"

namespace suite::test::ocean_test {
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
  // Parted into layers it is the same water.
  const OceanLight parts =
      OceanReference::layered(true, {{&fine, 0.3}, {&fine, 0.7}}, {{&fine, 0.5}, {&fine, 2}, {&fine, INFINITY}});
  EXPECT_NEAR(parts.up / fine.under_sun(1).up, 1, 1e-6);
  EXPECT_NEAR(parts.nadir / fine.under_sun(1).nadir, 1, 1e-6);
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
// A plane that faces along its ray, as the collectors of `point` sensors.
class FluxReceiver final : public RaySensor {
 public:
  using RaySensor::RaySensor;
  SensorRay ray(const RayRequest& r) const override {
    SensorRay out{rays_[r.problem], kPi};
    out.receiver = SensorRay::Receiver::plane;
    return out;
  }
};

// Waters upon each other, each but the last with a lower side at so many m.
struct Part {
  Medium water;
  double bottom = 0;
};
std::shared_ptr<Scene> ocean(std::vector<Part> parts) {
  auto scene = std::make_shared<Scene>();
  Material surface = material("surface", {"dielectric", {}, {{"index", Curve::constant(kIndex)}}, {}, nullptr});
  surface.inside = 0;
  for (uint32_t i = 0; i < parts.size(); ++i) {
    scene->media.push_back(std::move(parts[i].water));
    scene->media[i].id = strf("water %u", i), scene->media[i].priority = static_cast<int>(i);
    scene->materials.push_back(i == 0 ? surface : boundary(i));
    scene->materials[i].id = strf("side %u", i);
    place(*scene, PrimitiveKind::plane, {0, 0}, i, translation({0, 0, i == 0 ? 0 : -parts[i - 1].bottom}));
  }
  check_scene(*scene, "ocean");
  return scene;
}
std::shared_ptr<Scene> ocean(bool petzold, double albedo) { return ocean({{water(petzold, albedo)}}); }

bool long_run() { return std::getenv("SUITE_LONG") != nullptr; }
// A round; paths that ask for the sun know more each. In the default run, of one round, what is not resolved to the
// bound has to be known to 15 %, of Petzold's particles at b / c of 0.2 it is to some 12 %.
const uint32_t kPaths = long_run() ? 2048 : 768, kPathsToTheSun = long_run() ? 512 : 192;
constexpr int kMostRounds = 256;  // was 4096, with which the long run did not end in hours

// What 64 problems alike see, in rounds with numbers of their own: one, in the long run as many as make the noise a
// third of the bound.
// How lights are found: asked for through the surface, or met by chance alone.
enum class Found { asked, by_chance };
template <class Kind>
Repeated look(const std::shared_ptr<const Scene>& scene, const SourceSpecs& sources, const Ray& ray, uint32_t paths,
              double enough, Found found) {
  PipelineOptions options;
  options.refracted_sources = found == Found::asked;
  options.max_scatterings = 100000;
  double sum = 0, square = 0;
  for (int round = 1;; ++round) {
    options.seed = 2 + static_cast<uint64_t>(round);
    const auto r = render(scene, sources, std::make_unique<Kind>(repeated(ray), one_band(), paths), options);
    EXPECT_EQ(r.report.statistics.failures, 0u);
    const Repeated one = over_problems(r.result, 0);
    sum += one.mean, square += one.error * one.error;
    const Repeated all{sum / round, std::sqrt(square) / round};
    if (!long_run() || all.error < enough || round == kMostRounds) return all;
  }
}

template <class Kind>
void expect(const char* what, const std::shared_ptr<const Scene>& scene, const SourceSpecs& sources, const Ray& ray,
            uint32_t paths, double truth, double bound, Found found) {
  const Repeated seen = look<Kind>(scene, sources, ray, paths, bound / 3 * truth, found);
  const double error = seen.mean / truth - 1, noise = seen.error / truth;
  const bool resolved = noise < bound / 3;
  std::printf("  %s %.5g, %+.2f %% +- %.2f %%%s\n", what, truth, 100 * error, 100 * noise,
              resolved ? "" : ", not resolved to the bound");
  std::fflush(stdout);
  // Three errors of 64 means: p = 0.004.
  EXPECT_LT(std::fabs(error), long_run() && resolved ? bound : bound + 3 * noise) << what;
  EXPECT_LT(noise, 0.15) << what << ": not resolved";
}

void expect_all(const std::shared_ptr<const Scene>& scene, const SourceSpecs& sources, double depth,
                const OceanLight& truth, uint32_t paths = kPaths, Found found = Found::asked) {
  const Vec3 at{0, 0, -depth};
  expect<FluxReceiver>("Ed", scene, sources, {at, {0, 0, 1}, 0}, paths, truth.down, 0.01, found);
  expect<FluxReceiver>("Eu", scene, sources, {at, {0, 0, -1}, 0}, paths, truth.up, 0.01, found);
  expect<RaySensor>("Lu", scene, sources, {at, {0, 0, -1}, 0}, paths, truth.nadir, 0.02, found);
}

TEST(Ocean, RendersAsTheReferenceUnderASky) {
  SourceSpecs sources;
  sources.add(uniform_sky(1, false));
  for (const bool petzold : {false, true})
    for (const double albedo : {0.2, 0.9}) {
      const OceanReference reference(phase_of(petzold), albedo, kIndex, kMuSun, 16);
      std::printf("sky, problem %d, b/c %.1f\n", petzold ? 2 : 1, albedo);
      expect_all(ocean(petzold, albedo), sources, 1, reference.under_sky(1));
    }
}

// One depth of molecules that scatter much upon particles that absorb much, at the border of both.
TEST(Ocean, RendersLayersAsTheReference) {
  SourceSpecs sources;
  sources.add(uniform_sky(1, false));
  const OceanReference upper(phase_of(false), 0.9, kIndex, kMuSun, 16), deep(phase_of(true), 0.9, kIndex, kMuSun, 16);
  const OceanLight truth = OceanReference::layered(false, {{&upper, 1}}, {{&deep, INFINITY}});
  EXPECT_GT(upper.under_sky(1).up / truth.up, 2) << "the layer below matters";
  std::printf("sky, two layers\n");
  expect_all(ocean({{water(false, 0.9), 1}, {water(true, 0.9)}}), sources, 1, truth);
}

// What problem 3 is about: a sea whose chlorophyll has a peak at 17 m, at 500 nm, in layers. Its published tables were
// not found in a source that can be cited, so the solution by matrices of the same layers stands for them. Profile: M.
// Lewis, J. Cullen, T. Platt 1983, with the constants of problem 3 (0.2, 144, 9, 17) as far as they are remembered;
// particles as Gordon & Morel 1983 have them, b = 0.30 (550 / 500) C^0.62, with Petzold's phase function; absorption as
// Prieur & Sathyendranath 1981, 0.0257 + 0.04 C^0.65; molecules 0.0029, all 1/m.
TEST(Ocean, RendersAProfileAsTheReference) {
  constexpr std::array<double, 7> kBottoms{2.5, 5, 10, 15, 20, 30, INFINITY};
  constexpr double kMolecules = 0.0029;
  std::vector<OceanReference> waters;
  std::vector<double> depths;
  std::vector<Part> parts;
  double top = 0;
  for (const double bottom : kBottoms) {
    const double z = std::isinf(bottom) ? 35 : 0.5 * (top + bottom), off = (z - 17) / 9;
    const double chlorophyll = 0.2 + 144 / (9 * std::sqrt(2 * kPi)) * std::exp(-0.5 * off * off);
    const double particles = 0.33 * std::pow(chlorophyll, 0.62), b = particles + kMolecules,
                 a = 0.0257 + 0.04 * std::pow(chlorophyll, 0.65), share = particles / b;
    const auto petzold = phase_of(true);
    waters.emplace_back([&](double c) { return share * petzold(c) + (1 - share) * molecules(c); }, b / (a + b), kIndex,
                        kMuSun, 16);
    depths.push_back(std::isinf(bottom) ? INFINITY : (a + b) * (bottom - top));
    const ModelSpec phase{"sea",
                          {{"backscatter", 0.0183}, {"g", 0.9}, {"mineral_backscatter", 0.02}, {"depolarisation", 0}},
                          {{"particles", Curve::constant(share)}, {"minerals", Curve::constant(0)}},
                          {{"kind", "petzold"}},
                          nullptr};
    Medium m = medium(Curve::constant(a), Curve::constant(b), phase);
    m.index = Curve::constant(kIndex);
    parts.push_back({m, bottom});
    top = bottom;
  }
  std::vector<OceanReference::Layer> above, below;
  for (size_t i = 0; i < waters.size(); ++i) (i < 2 ? above : below).push_back({&waters[i], depths[i]});
  const auto scene = ocean(parts);
  SourceSpecs sky, sun;
  sky.add(uniform_sky(1, false));
  sun.add(SunSpec{dir_from_angles(std::acos(kMuSun), 0.3), 0, Curve::constant(1 / kMuSun)});
  const OceanLight under_sky = OceanReference::layered(false, above, below);
  const OceanLight evenly = OceanReference::layered(false, above, {{&waters[0], INFINITY}});
  EXPECT_GT(std::fabs(evenly.up / under_sky.up - 1), 0.05) << "the layers below matter";
  std::printf("sky, a profile, 5 m\n");
  expect_all(scene, sky, 5, under_sky);
  if (!long_run()) return;
  std::printf("sun, a profile, 5 m\n");
  expect_all(scene, sun, 5, OceanReference::layered(true, above, below), kPathsToTheSun);
}

// The sun at 60 degrees, which is asked for through the surface. Particles send it on in a peak so narrow that places
// find it only along chains that are drawn from its end (techniques/volume_chains.h); in the long run.
TEST(Ocean, RendersAsTheReferenceUnderTheSun) {
  SourceSpecs sources;
  sources.add(SunSpec{dir_from_angles(std::acos(kMuSun), 0.3), 0, Curve::constant(1 / kMuSun)});
  for (const bool petzold : {false, true})
    for (const double albedo : {0.2, 0.9}) {
      if (petzold && !long_run()) continue;
      const OceanReference reference(phase_of(petzold), albedo, kIndex, kMuSun, 16);
      std::printf("sun, problem %d, b/c %.1f\n", petzold ? 2 : 1, albedo);
      expect_all(ocean(petzold, albedo), sources, 1, reference.under_sun(1), kPathsToTheSun);
    }
}

// The same without asking, met by chance (it was asked for here, too, with ten times the noise): the sun turned about
// the vertical, a ring from 58 to 62 degrees. For what is compared that is the same. b / c of 0.2 would take hours.
TEST(Ocean, RendersParticlesAsTheReferenceUnderARing) {
  if (!long_run()) GTEST_SKIP() << "minutes until it is resolved";
  const double inner = 58 * kDegree, outer = 62 * kDegree, high = std::cos(inner), low = std::cos(outer);
  RingSpec ring;
  ring.inner = inner, ring.outer = outer;
  ring.radiance = Curve::constant(1 / (kPi * (high * high - low * low)));
  SourceSpecs sources;
  sources.add({std::make_shared<const RingLight>(ring)});
  // Gauss's two points in the squared cosine, which is what the flux goes by.
  OceanLight truth;
  for (const double side : {-1.0, 1.0}) {
    const double mu2 = 0.5 * (high * high + low * low) + side / std::sqrt(3.0) * 0.5 * (high * high - low * low);
    const OceanLight l = OceanReference(phase_of(true), 0.9, kIndex, std::sqrt(mu2), 16).under_sun(1);
    truth.down += 0.5 * l.down, truth.up += 0.5 * l.up, truth.nadir += 0.5 * l.nadir;
  }
  std::printf("ring, problem 2, b/c 0.9\n");
  expect_all(ocean(true, 0.9), sources, 1, truth, kPaths, Found::by_chance);
}

}  // namespace
}  // namespace suite::test::ocean_test
