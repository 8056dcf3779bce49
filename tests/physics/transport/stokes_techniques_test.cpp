// Each technique of light transport off in runs that carry polarisation: what is left brings the same Stokes vectors in
// the mean. Planes of incidence and of scattering differ along all paths, so that the order of matrices matters.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <memory>

#include "tests/support/lamps_kit.h"
#include "tests/support/stokes_kit.h"
#include "transport/serve.h"
#include "transport/stokes_throughputs.h"
#include "transport/technique_switches.h"

namespace suite::test::stokes_techniques_test {
namespace {

const double kSunAngle = 55 * kDegree;
const Dir kToSun = dir_from_angles(kSunAngle, 1.1);

ModelSpec glass(double index) { return {"dielectric", {}, {{"index", Curve::constant(index)}}, {}, nullptr}; }
// Dark: half of what it reflects at 60 deg is polarised, and what is comes out turned.
ModelSpec metal(double roughness) {
  return {"ggx", {{"roughness", roughness}}, {{"n", Curve::constant(1.2)}, {"k", Curve::constant(1)}}, {}, nullptr};
}
// Scatters forwards, and polarises: elements off the diagonal up to 0.6, at small angles too, and retardance.
ModelSpec droplets() {
  return {"tabulated",
          {},
          {},
          {{"table", "0 400, 5 60, 20 4, 60 0.5, 120 0.1, 140 0.35, 160 0.15, 180 0.3"},
           {"matrix",
            "0 0 1 1 0 1, 8 -0.6 0.98 0.77 0.05 0.76, 30 -0.2 0.97 0.95 0.1 0.94, 90 -0.6 0.9 0.4 0.3 0.35, 140 0.3 "
            "0.85 -0.6 -0.3 -0.55, 180 0 0.7 -0.7 0 -0.4"}},
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

// A glowing ball over water, of polarised light.
World lamp_over_water() {
  World w{pool(0), {}, towards({}, 60)};
  w.scene->materials.push_back(material("shine", lambert(0)));
  place(*w.scene, PrimitiveKind::sphere, {0.4}, 2, translation({0.6, 0.7, 1.5}));
  check_scene(*w.scene, "lamp over water");
  LampSpec lamp = glow("shine", 1);
  lamp.stokes = Stokes{1, 0.5, -0.6, 0.3};
  w.sources.add(lamp);
  return w;
}

// A glass plate tilted by Brewster's angle over metal that is looked at beside it; thin, so that hardly any light comes
// by its edges.
World tilted_plate() {
  auto scene = scene_of({box({-3, -3, -0.001}, {3, 3, 0.001}, 1, true)},
                        {material("floor", metal(0.4)), material("glass", glass(1.5))});
  const Vec3 axis = normalized(cross(Vec3{0, 0, 1}, kToSun));
  scene->groups[0].placements[0].to_parent =
      translation(kToSun * 4) * rotation(axis, kPi / 2 - kSunAngle - 56.3 * kDegree);
  place(*scene, PrimitiveKind::plane, {0, 0}, 0);
  check_scene(*scene, "tilted plate");
  return under_sun(scene, 20, towards({}, 60));
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
  // Beside the sun, where both scatterings turn little and in one plane.
  const Dir d = normalized(kToSun + 0.25 * normalized(cross(kToSun, Vec3{0.3, 0.4, 1})));
  return under_sun(scene, 0.27, {Vec3{1.5, 1.5, 1.5} - d * 4, d, 0});
}
World fog() {
  auto scene = std::make_shared<Scene>();
  scene->media = {medium(Curve::constant(0.002), Curve::constant(0.02), droplets())};
  scene->ambient = 0;
  scene->materials = {material("pane", metal(0.01))};
  place(*scene, PrimitiveKind::plane, {0, 0}, 0, translation({0, 0, -2}));
  check_scene(*scene, "fog");
  World w{scene, {}, towards({0, 0, -2}, 60)};
  LampSpec lamp = point_lamp({{2.2, 1.5, 0.5}}, 1);
  lamp.stokes = Stokes{1, -0.4, 0.6, 0.3};
  w.sources.add(lamp);
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

// Glint of the sun on the sea beside metal that mirrors it.
World glint() {
  const ModelSpec sea{
      "sea", {{"wind_m_s", 5}, {"directed", 0}, {"whitecaps", 0}}, {{"below", Curve::constant(0)}}, {}, nullptr};
  const auto scene =
      scene_of({quad(100, 0, 0), mesh_of({{0, -9, 0}, {0, 9, 0}, {6, 9, 9}, {6, -9, 9}}, {0, 2, 1, 0, 3, 2}, 1)},
               {material("sea", sea), material("sail", metal(0.4))});
  return under_sun(scene, 3, towards({-1, 0, 0}, 60, 0.9));
}

struct Case {
  const char* name;
  const char* technique;
  World (*world)();
  uint32_t paths, paths_without;
  uint32_t most;    // scatterings; 0: any number
  uint32_t smooth;  // interfaces on the way of what the technique brings, at least; kGuides: it brings nothing itself
};
constexpr uint32_t kGuides = 99;
constexpr Case kCases[] = {
    {"glint of the sea", "light_sampling", glint, 64, 512, 0, 0},
    {"sun through water", "manifold", clear_water, 64, 256, 0, 2},
    {"lamp through water", "manifold", lamp_over_water, 64, 512, 0, 2},
    {"sun through a plate at Brewster's angle", "manifold", tilted_plate, 64, 1024, 0, 2},
    {"turbid water", "manifold", turbid_water, 64, 512, 0, 2},
    {"turbid water", "volume_chains", turbid_water, 64, 128, 0, 2},
    {"fog of droplets and air", "side_vertex", cloud, 512, 1024, 0, 0},
    {"lamp in fog", "equiangular", fog, 64, 256, 1, 0},
    {"metal ball", "caustic_guide", ball, 128, 512, 0, kGuides},
};

struct Estimate {
  Stokes mean{}, error{};
  double seconds = 0;  // of the processor
  explicit Estimate(const std::array<RunningStats, 4>& of) {
    for (size_t k = 0; k < 4; ++k) mean[k] = of[k].mean(), error[k] = of[k].stderr_of_mean();
  }
  // In standard errors; sign: of the other's Q, U and V.
  double off_by(const Estimate& o, size_t k, double sign = 1) const {
    const double rounding = 1e-9 * mean[0];  // where V is 0
    return std::fabs(mean[k] - (k > 0 ? sign : 1) * o.mean[k]) / std::hypot(error[k], o.error[k], rounding);
  }
};
constexpr uint32_t kProblems = 32;

PipelineOptions options_of(const Case& c, bool off) {
  PipelineOptions options;
  options.max_scatterings = c.most;
  options.seed = off ? 2 : 1;
  if (off) technique_of(c.technique)->off(options);
  return options;
}
Estimate look(const Case& c, bool off, uint32_t paths) {
  const World w = c.world();
  const std::clock_t begin = std::clock();
  const auto run = render(w.scene, w.sources, std::make_unique<StokesRays>(std::vector<Ray>(kProblems, w.ray), paths),
                          options_of(c, off));
  const double seconds = static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
  EXPECT_EQ(run.report.statistics.failures, 0u);
  std::array<RunningStats, 4> stats;
  for (const StokesSeen& s : seen_of(run.result))
    for (size_t k = 0; k < 4; ++k) stats[k].add(s.S[k]);
  Estimate seen(stats);
  seen.seconds = seconds;
  return seen;
}

// Sums light with a fault: the matrices of what light samples bring by way of so many smooth interfaces have the wrong
// sign of m21.
class Flipped final : public Sink<StokesThroughputs> {
 public:
  explicit Flipped(uint32_t smooth) : smooth_(smooth) {}
  void add(std::span<const Contribution> stage, StokesThroughputs& throughputs) override {
    for (Contribution c : stage) {
      if (!c.arrived()) continue;
      PolarisedEvent wrong;
      if (c.asked && c.polarised && c.smooth >= smooth_) {
        matrices_.assign(c.polarised->matrices.begin(), c.polarised->matrices.end());
        for (Mueller& m : matrices_)
          for (int k = 0; k < 4; ++k) m(1, k) = -m(1, k);  // m(1, 0) alone hardly matters to a polarised lamp
        wrong = {matrices_, c.polarised->unknown};
        c.polarised = &wrong;
      }
      throughputs.shine_stokes(c, c.scale, {{0, 1, 2, 3}});
    }
  }

 private:
  uint32_t smooth_;
  std::vector<Mueller> matrices_;
};
Estimate look_flipped(const Case& c) {
  const World w = c.world();
  const PipelineOptions options = options_of(c, false);
  const Tracer tracer(w.scene);
  const Optics optics(*w.scene, make_state(one_band(), 0.01, 0, 1));
  const Environment environment = bake_environment(w.sources, tracer, false, optics.state());
  const Surface surface(tracer, optics);
  KernelContext context{surface, optics, environment, options};
  context.stokes = true;
  StokesThroughputs throughputs(c.paths, optics.state().size(), 4);
  Flipped sink(c.smooth);
  const auto kernel = make_stokes_kernel(choose_kernel(context), context, c.paths, throughputs, sink);
  const FlushDenormals flush;
  TraceStatistics statistics;
  std::array<RunningStats, 4> stats;
  for (uint32_t batch = 0; batch < kProblems; ++batch) {
    for (uint32_t p = 0; p < c.paths; ++p) {
      throughputs.begin(p, 1, nullptr);
      throughputs.begin_rows(p, Mueller::identity());
      kernel->start(p, {w.ray, 1}, SampleStream(7, 0, 0, batch), p);
    }
    complete(*kernel, tracer, statistics);
    for (size_t k = 0; k < 4; ++k) {
      double sum = 0;
      for (uint32_t p = 0; p < c.paths; ++p) sum += double{throughputs.light(p, k)[0]};
      stats[k].add(sum / c.paths);
    }
  }
  return Estimate(stats);
}

TEST(StokesTechniques, MeansAreThoseWithoutATechnique) {
  const char* const more = std::getenv("SUITE_LONG");
  const uint32_t times = more ? static_cast<uint32_t>(std::atoi(more)) : 1;
  for (const Case& c : kCases) {
    SCOPED_TRACE(testing::Message() << c.name << ", " << c.technique);
    const Estimate with = look(c, false, times * c.paths), without = look(c, true, times * c.paths_without);
    double polarised = 0;
    for (size_t k = 0; k < 4; ++k) {
      std::printf("%s, %s: %c %.5g +- %.2g, off %.5g +- %.2g, %.1f errors; variance x time %.3g\n", c.name, c.technique,
                  "IQUV"[k], with.mean[k], with.error[k], without.mean[k], without.error[k], with.off_by(without, k),
                  std::pow(with.error[k] / without.error[k], 2) * with.seconds / without.seconds);
      EXPECT_LT(with.off_by(without, k), 4) << "IQUV"[k];  // p = 6e-5
      polarised = std::max(polarised, with.off_by(without, k, -1));
    }
    EXPECT_GT(polarised, 8) << "it is resolved";
    if (c.smooth == kGuides) continue;
    // Negative control: the technique with one wrong sign.
    const Estimate flipped = look_flipped(c);
    double off = 0;
    for (size_t k = 0; k < 4; ++k) off = std::max(off, flipped.off_by(without, k));
    EXPECT_GT(off, 4);
    std::printf("%s, %s: with a wrong sign %.1f errors\n", c.name, c.technique, off);
  }
}

}  // namespace
}  // namespace suite::test::stokes_techniques_test
