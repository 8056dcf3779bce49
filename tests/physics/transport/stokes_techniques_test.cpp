// Each technique of light transport off in runs that carry polarisation: what is left brings the same Stokes vectors in
// the mean. Planes of incidence and of scattering differ along all paths, so that the order of matrices matters.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <memory>

#include "tests/support/lamps_kit.h"
#include "tests/support/stokes_kit.h"
#include "transport/technique_switches.h"

namespace suite::test {
namespace {

const double kSunAngle = 55 * kDegree;
const Dir kToSun = dir_from_angles(kSunAngle, 1.1);

ModelSpec glass(double index) { return {"dielectric", {}, {{"index", Curve::constant(index)}}, {}, nullptr}; }
// Dark: half of what it reflects at 60 deg is polarised, and what is comes out turned.
ModelSpec metal(double roughness) {
  return {"ggx", {{"roughness", roughness}}, {{"n", Curve::constant(1.2)}, {"k", Curve::constant(1)}}, {}, nullptr};
}
// Scatters forwards, and polarises: elements off the diagonal up to 0.6, and retardance.
ModelSpec droplets() {
  return {"tabulated",
          {},
          {},
          {{"table", "0 400, 5 60, 20 4, 60 0.5, 120 0.1, 140 0.35, 160 0.15, 180 0.3"},
           {"matrix",
            "0 0 1 1 0 1, 30 -0.2 0.97 0.95 0.1 0.94, 90 -0.6 0.9 0.4 0.3 0.35, 140 0.3 0.85 -0.6 -0.3 -0.55, 180 0 "
            "0.7 -0.7 0 -0.4"}},
          nullptr};
}

struct World {
  std::shared_ptr<Scene> scene;
  SourceSpecs sources;
  Ray ray;
};
World under_sun(std::shared_ptr<Scene> scene, double half_angle_deg, const Ray& ray) {
  World w{std::move(scene), {}, ray};
  w.sources.add(SunSpec{{kToSun, half_angle_deg * kDegree, Curve::constant(1)}});
  return w;
}
// Looks down at a place along an angle from the vertical.
Ray towards(Vec3 place, double angle_deg, double azimuth = 0.3) {
  const Dir d = dir_from_angles(kPi - angle_deg * kDegree, azimuth);
  return {place - d * 4, d, 0};
}

// A bed of rough metal under water, that scatters or is clear.
std::shared_ptr<Scene> pool(double scattering) {
  auto scene = std::make_shared<Scene>();
  Material surface = material("surface", glass(1.34));
  if (scattering > 0) {
    scene->media = {medium(Curve::constant(0.05), Curve::constant(scattering), droplets())};
    scene->media[0].index = Curve::constant(1.34);
    surface.inside = 0;
  }
  scene->materials = {material("bed", metal(0.4)), surface};
  place(*scene, PrimitiveKind::plane, {0, 0}, 0, translation({0, 0, -2}));
  place(*scene, PrimitiveKind::plane, {0, 0}, 1);
  check_scene(*scene, "pool");
  return scene;
}
World clear_water() { return under_sun(pool(0), 15, towards({}, 60)); }
World turbid_water() { return under_sun(pool(0.3), 20, towards({}, 60)); }

// A glowing ball over water.
World lamp_over_water() {
  World w{pool(0), {}, towards({}, 60)};
  w.scene->materials.push_back(material("shine", lambert(0)));
  place(*w.scene, PrimitiveKind::sphere, {0.4}, 2, translation({0.6, 0.7, 1.5}));
  check_scene(*w.scene, "lamp over water");
  w.sources.add(glow("shine", 1));
  return w;
}

// A glass plate tilted by Brewster's angle over metal that is looked at beside it.
World tilted_plate() {
  auto scene = scene_of({box({-3, -3, -0.1}, {3, 3, 0.1}, 1, true)},
                        {material("floor", metal(0.4)), material("glass", glass(1.5))});
  const Vec3 axis = normalized(cross(Vec3{0, 0, 1}, kToSun));
  scene->groups[0].placements[0].to_parent =
      translation(kToSun * 4) * rotation(axis, kPi / 2 - kSunAngle - 56.3 * kDegree);
  place(*scene, PrimitiveKind::plane, {0, 0}, 0);
  check_scene(*scene, "tilted plate");
  return under_sun(scene, 10, towards({}, 60, -0.5));
}

// A cube of droplets and air; and a lamp in fog over metal that mirrors it.
World cloud() {
  auto scene = std::make_shared<Scene>();
  scene->groups.push_back({"root", {}});
  scene->media = {
      medium(Curve::constant(0.05), Curve::constant(1), droplets()),
      medium(Curve::constant(0), Curve::constant(0.2), {"rayleigh", {{"depolarisation", 0.03}}, {}, {}, nullptr})};
  for (uint32_t m : {0u, 1u}) {
    scene->grids.push_back(grid_of(
        {1, 1, 1}, Affine3{{3, 0, 0, 0, 3, 0, 0, 0, 3}, {}}, [](uint32_t, uint32_t, uint32_t) { return 1.0; }, m));
    scene->volumes.push_back({m, {}});
  }
  check_scene(*scene, "cloud");
  return under_sun(scene, 0.27, towards({1.5, 1.5, 1.5}, 60));
}
World fog() {
  auto scene = std::make_shared<Scene>();
  scene->media = {medium(Curve::constant(0.002), Curve::constant(0.02), droplets())};
  scene->ambient = 0;
  scene->materials = {material("pane", metal(0.01))};
  place(*scene, PrimitiveKind::plane, {0, 0}, 0, translation({0, 0, -2}));
  check_scene(*scene, "fog");
  World w{scene, {}, towards({0, 0, -2}, 60)};
  w.sources.add(point_lamp({{2.2, 1.5, 0.5}}, 1));
  return w;
}

// A ball of metal throws the sun on metal.
World ball() {
  auto scene = std::make_shared<Scene>();
  scene->materials = {material("ground", metal(0.6)), material("ball", metal(0.1))};
  const Dir aside = normalized(Vec3{kToSun.x, kToSun.y, 0});
  place(*scene, PrimitiveKind::plane, {40, 40}, 0);
  place(*scene, PrimitiveKind::sphere, {1}, 1, translation({-1.6 * aside.x, -1.6 * aside.y, 1}));
  check_scene(*scene, "ball");
  return under_sun(scene, 2, towards({}, 40, 2.2));
}

struct Case {
  const char* name;
  const char* technique;
  World (*world)();
  uint32_t paths, paths_without;
  uint32_t most;  // scatterings; 0: any number
};
constexpr Case kCases[] = {
    {"sun through water", "manifold", clear_water, 64, 1024, 0},
    {"lamp through water", "manifold", lamp_over_water, 64, 2048, 0},
    {"sun through a plate at Brewster's angle", "manifold", tilted_plate, 64, 1024, 0},
    {"turbid water", "manifold", turbid_water, 64, 1024, 0},
    {"turbid water", "volume_chains", turbid_water, 64, 128, 0},
    {"cloud", "side_vertex", cloud, 64, 256, 0},
    {"lamp in fog", "equiangular", fog, 64, 256, 1},
    {"metal ball", "caustic_guide", ball, 64, 256, 0},
};

struct Seen {
  Stokes mean{}, error{};
  double seconds = 0;  // of the processor, a path of one problem
};
constexpr size_t kProblems = 32;
Seen look(const Case& c, bool off, uint32_t paths) {
  const World w = c.world();
  PipelineOptions options;
  options.max_scatterings = c.most;
  options.seed = off ? 2 : 1;
  if (off) technique_of(c.technique)->off(options);
  const std::clock_t begin = std::clock();
  const auto run =
      render(w.scene, w.sources, std::make_unique<StokesRays>(std::vector<Ray>(kProblems, w.ray), paths), options);
  Seen seen;
  seen.seconds = static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
  EXPECT_EQ(run.report.statistics.failures, 0u);
  RunningStats stats[4];
  for (const StokesSeen& s : seen_of(run.result))
    for (size_t k = 0; k < 4; ++k) stats[k].add(s.S[k]);
  for (size_t k = 0; k < 4; ++k) seen.mean[k] = stats[k].mean(), seen.error[k] = stats[k].stderr_of_mean();
  return seen;
}

// How far off the mean of two estimates of a component is, in standard errors; sign: of the polarised components.
double off_by(const Seen& a, const Seen& b, size_t k, double sign = 1) {
  return std::fabs(a.mean[k] - (k > 0 ? sign : 1) * b.mean[k]) /
         (std::hypot(a.error[k], b.error[k]) + 1e-9 * a.mean[0]);
}

TEST(StokesTechniques, MeansAreThoseWithoutATechnique) {
  const char* const more = std::getenv("SUITE_LONG");
  const uint32_t times = more ? static_cast<uint32_t>(std::atoi(more)) : 1;
  for (const Case& c : kCases) {
    SCOPED_TRACE(testing::Message() << c.name << ", " << c.technique);
    const Seen with = look(c, false, times * c.paths), without = look(c, true, times * c.paths_without);
    double polarised = 0;
    for (size_t k = 0; k < 4; ++k) {
      std::printf("%s %s %c: %.5g +- %.2g, without %.5g +- %.2g: %.1f errors\n", c.name, c.technique, "IQUV"[k],
                  with.mean[k], with.error[k], without.mean[k], without.error[k], off_by(with, without, k));
      EXPECT_LT(off_by(with, without, k), 4) << "IQUV"[k];
      if (k > 0) polarised = std::max(polarised, off_by(with, without, k, -1));
    }
    EXPECT_GT(polarised, 8) << "Q, U, V of the other sign would be seen";
    std::printf("%s %s: %.3f s, without %.3f s; work %.3g\n", c.name, c.technique, with.seconds, without.seconds,
                with.seconds * std::pow(with.error[1], 2) / (without.seconds * std::pow(without.error[1], 2)));
  }
}

}  // namespace
}  // namespace suite::test
