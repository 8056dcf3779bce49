// Media in scenes that repeat themselves and in scenes that move; lamps and the Moon at scattering events; fitted phase
// functions: against closed forms, and against the same thing said otherwise.
#include <gtest/gtest.h>

#include <cmath>

#include "light/kinds/lamps.h"
#include "light/kinds/moon.h"
#include "math/sampling.h"
#include "motion/track.h"
#include "optics/model_function.h"
#include "sqt_fit/aligned_fit.h"
#include "tests/support/media_kit.h"

namespace suite::test::media_scene_test {
namespace {

constexpr double kSigmas = 4.5;  // less than 1e-5 a comparison by chance

const Periodic kCell{{-2, 1}, {7, 5}};

// A turned grid that sticks out of the cell, over a ground; `copies` of the whole on every side.
std::shared_ptr<Scene> cloud_field(const Medium& m, int copies) {
  auto scene = std::make_shared<Scene>();
  scene->media = {m};
  scene->materials = {material("ground", lambert(0.4))};
  scene->grids.push_back(grid_of({5, 4, 3}, translation({-2.5, -1.5, 0}) * scaling({1, 0.75, 0.5}),
                                 [](uint32_t i, uint32_t j, uint32_t k) { return unit_double(hash_of(i, j, k)); }));
  for (int x = -copies; x <= copies; ++x)
    for (int y = -copies; y <= copies; ++y)
      scene->volumes.push_back(
          {0, translation({-1.5 + x * kCell.size.x, 2 + y * kCell.size.y, 1}) * rotation({0, 0, 1}, 0.6), kNone});
  const double wide = 2.0 * copies + 1;
  place(*scene, PrimitiveKind::plane, {kCell.size.x * wide, kCell.size.y * wide}, 0,
        translation({kCell.low.x + kCell.size.x / 2, kCell.low.y + kCell.size.y / 2, 0}));
  check_scene(*scene, "clouds");
  return scene;
}

TEST(PeriodicMedia, TransmittanceOfAFieldOfCopies) {
  // Looking through from below at a bright sky, level rays included as far as the copies reach: no chance in it.
  const auto gas = medium(Curve::constant(0.4), Curve::constant(0));
  SourceSpecs sources;
  sources.add(uniform_sky(1, true));
  std::vector<Ray> rays;
  Pcg32 random(3);
  for (int i = 0; i < 60; ++i)
    rays.push_back({{-2 + 7 * random.uniform(), 1 + 5 * random.uniform(), 0.5},
                    dir_from_angles(1.35 * random.uniform(), 2 * kPi * random.uniform()),
                    0});
  for (int i = 0; i < 10; ++i) rays.push_back({{0.1 * i, 2, 9}, normalized(Vec3{0.3 * i - 1, 0.1, -1}), 0});
  const auto one = render_cell(cloud_field(gas, 0), sources, rays, 2, kCell);
  const auto many = render_cell(cloud_field(gas, 4), sources, rays, 2, std::nullopt);
  double least = 1;
  for (size_t i = 0; i < 60; ++i) {
    EXPECT_NEAR(one.radiance[i], many.radiance[i], 2e-6) << i;
    least = std::min(least, one.radiance[i]);
  }
  EXPECT_LT(least, 0.6) << "rays that pass the clouds by prove nothing";
}

TEST(PeriodicMedia, ScatteringFieldIsTheFieldOfCopies) {
  const auto cloud = medium(Curve::constant(0.1), Curve::constant(1), hg(0.5));
  SourceSpecs sources;
  sources.add(SunSpec{dir_from_angles(0.5, 1), 0, Curve::constant(3)});
  const Ray look{{1, 3, 8}, normalized(Vec3{-0.2, 0.1, -1}), 0};
  const auto mean = [](const CaptureResult& r) { return over_problems(r, 0); };
  const Repeated one = mean(render_cell(cloud_field(cloud, 0), sources, repeated(look), 1 << 9, kCell)),
                 many = mean(render_cell(cloud_field(cloud, 12), sources, repeated(look), 1 << 8, std::nullopt, 5)),
                 alone = mean(render_cell(cloud_field(cloud, 0), sources, repeated(look), 1 << 8, std::nullopt, 6));
  EXPECT_NEAR(one.mean, many.mean, kSigmas * std::hypot(one.error, many.error) + 1e-3 * one.mean);
  EXPECT_LT(one.error, 0.01 * one.mean);
  // Control: one cloud without its neighbours is not the same.
  EXPECT_GT(std::fabs(one.mean - alone.mean), kSigmas * std::hypot(one.error, alone.error));
}

TEST(PeriodicMedia, WhiteFieldReturnsWhatItGets) {
  auto scene = cloud_field(medium(Curve::constant(0), Curve::constant(2), hg(0.8)), 0);
  scene->materials = {material("ground", lambert(1))};
  SourceSpecs sources;
  sources.add(uniform_sky(1, false));
  const auto r = render_cell(scene, sources, repeated({{1, 3, 8}, normalized(Vec3{-0.2, 0.1, -1}), 0}), 64, kCell);
  for (const double L : r.radiance) EXPECT_NEAR(L, 1, 1e-3);
}

TEST(PeriodicMedia, BodiesAcrossTheSideAreOneBody) {
  // A sphere of gas around a corner of the cell: rays through its middle, in any of the cells, pass one diameter each
  // time they meet it.
  auto scene = std::make_shared<Scene>();
  scene->media = {medium(Curve::constant(0.3), Curve::constant(0))};
  scene->materials = {boundary(0)};
  place(*scene, PrimitiveKind::sphere, {1.5}, 0, translation({5, 6, 3}));
  check_scene(*scene, "ball");
  SourceSpecs sources;
  sources.add(uniform_sky(1, true));
  std::vector<Ray> rays;
  const std::vector<double> azimuths{0.1, 1.2, 2.5, 3.7, 5.5};
  for (const double a : azimuths) {
    const Dir d = dir_from_angles(0.7, a);
    rays.push_back({Vec3{-2, 6, 3} - d * 3.0, d, 0});  // the same corner, a cell to the west
  }
  rays.push_back({{5, 6, 3}, {0, 0, 1}, 0});  // from the middle
  const auto r = render_cell(scene, sources, rays, 2, kCell);
  for (size_t i = 0; i < azimuths.size(); ++i) EXPECT_NEAR(r.radiance[i], std::exp(-0.9), 1e-5) << azimuths[i];
  EXPECT_NEAR(r.radiance[5], std::exp(-0.45), 1e-5);
}

// Rays that ask at times within an exposure.
class TimedSensor final : public RaySensor {
 public:
  TimedSensor(std::vector<Ray> rays, uint32_t paths, double begin, double end)
      : RaySensor(std::move(rays), one_band(), paths) {
    Capture c = RaySensor::tasks()[0].captures[0];
    c.window = {begin, end};
    tasks_.push_back({"timed", c.window, {c}});
  }
  std::span<const Task> tasks() const override { return tasks_; }
  SensorRay ray(const RayRequest& r) const override {
    Ray made = rays_[r.problem];
    made.time = r.capture.window.begin + r.u[0] * (r.capture.window.end - r.capture.window.begin);
    return {made, 1};
  }

 private:
  std::vector<Task> tasks_;
};

TEST(MovingMedia, ABoxOfGasPassesBy) {
  // A box of 2 x 2 x 1 m and two cells of different density flies along x at 3 m/s, turned by a quarter.
  auto scene = std::make_shared<Scene>();
  scene->groups.push_back({"root", {}});
  scene->media = {medium(Curve::constant(0.5), Curve::constant(0))};
  scene->grids.push_back(grid_of({1, 2, 1}, translation({-1, -1, -0.5}) * scaling({2, 1, 1}),
                                 [](uint32_t, uint32_t j, uint32_t) { return j ? 3.0 : 1.0; }));
  scene->tracks.push_back({"flight", straight_track({{-6, 0, 5}, 0, 0, 3, 0, nullptr})});
  scene->volumes.push_back({0, rotation({0, 0, 1}, -kPi / 2), 0});
  check_scene(*scene, "flight");
  SourceSpecs sources;
  sources.add(uniform_sky(1, true));
  // Where the box is at an instant, as its pose says.
  const auto at = [&](double t, Vec3 p) {
    const Affine3 in = (scene->tracks[0].track->at(t).affine() * scene->volumes[0].to_world).inverse();
    const Vec3 q = in.point(p);
    return std::fabs(q.x) < 1 && std::fabs(q.y) < 1 ? (q.y > 0 ? 3.0 : 1.0) : 0.0;
  };
  std::vector<Ray> rays;
  for (int i = 0; i < 16; ++i) rays.push_back({{-3 + 0.43 * i, 0.2, 0}, {0, 0, 1}, 0});
  for (const double t : {1.0, 2.0, 2.7}) {
    const auto run = render(scene, sources, std::make_unique<TimedSensor>(rays, 2, t, t));
    for (size_t i = 0; i < rays.size(); ++i)
      EXPECT_NEAR(run.result.radiance[i], std::exp(-0.5 * at(t, rays[i].origin + Vec3{0, 0, 5})), 1e-5)
          << t << ' ' << i;
  }
  // Exposed from 1 s to 3 s: the mean over the times.
  const auto run = render(scene, sources, std::make_unique<TimedSensor>(rays, 1 << 12, 1, 3));
  for (size_t i = 0; i < rays.size(); ++i) {
    double expected = 0;
    for (int k = 0; k < 4000; ++k)
      expected += std::exp(-0.5 * at(1 + (k + 0.5) / 2000, rays[i].origin + Vec3{0, 0, 5})) / 4000;
    EXPECT_NEAR(run.result.radiance[i], expected, 2e-3) << i;
  }
  // Nobody knows where a volume is that moves in a scene that repeats itself, or along a track that is not there.
  EXPECT_THROW(render_cell(scene, sources, rays, 2, kCell), Error);
  scene->volumes[0].track = 7;
  EXPECT_THROW(check_scene(*scene, "flight"), Error);
}

TEST(Lamps, SingleScatteringFromAPoint) {
  // An endless medium: L = s I / (4 pi) * integral of exp(-e (t + r)) / r^2 along the ray, r from the lamp.
  const double s = 0.3, extinction = 0.4, intensity = 50;
  auto scene = std::make_shared<Scene>();
  scene->groups.push_back({"root", {}});
  scene->media = {medium(Curve::constant(extinction - s), Curve::constant(s))};
  scene->ambient = 0;
  check_scene(*scene, "fog");
  SourceSpecs sources;
  LampSpec lamp;
  lamp.name = "bulb";
  lamp.positions = {{0, 0, 0}};
  lamp.intensity = Curve::constant(intensity);
  sources.add(lamp);
  PipelineOptions once;
  once.max_scatterings = 1;
  std::vector<double> distances{1, 2, 4}, seen;
  for (const double h : distances) {
    const Ray ray{{-3, h, 0}, {1, 0, 0}, 0};
    double expected = 0;
    constexpr int n = 200000;
    for (int i = 0; i < n; ++i) {
      const double t = 40 * (i + 0.5) / n, r = std::hypot(t - 3, h);
      expected += s * intensity / (4 * kPi) * std::exp(-extinction * (t + r)) / (r * r) * 40 / n;
    }
    const auto run = render(scene, sources, std::make_unique<RaySensor>(repeated(ray), one_band(), 1 << 10), once);
    const Repeated got = over_problems(run.result, 0);
    EXPECT_NEAR(got.mean, expected, kSigmas * got.error) << h;
    EXPECT_LT(kSigmas * got.error, 0.02 * expected) << "2 % would not be seen";
    seen.push_back(got.mean);
  }
  EXPECT_GT(seen[0], 2 * seen[1]);
}

TEST(Lamps, InverseSquareInAThinMedium) {
  // Hardly any extinction: along an endless line at distance h the integral of 1 / r^2 is pi / h.
  const double s = 1e-4;
  auto scene = std::make_shared<Scene>();
  scene->media = {medium(Curve::constant(0), Curve::constant(s))};
  scene->materials = {boundary(0)};
  place(*scene, PrimitiveKind::sphere, {2000}, 0);
  check_scene(*scene, "haze");
  SourceSpecs sources;
  LampSpec lamp;
  lamp.name = "bulb";
  lamp.positions = {{0, 0, 0}};
  lamp.intensity = Curve::constant(1);
  sources.add(lamp);
  PipelineOptions once;
  once.max_scatterings = 1;
  for (const double h : {40.0, 80.0}) {
    const Ray ray{{-1500, h, 0}, {1, 0, 0}, 0};
    double expected = 0;
    constexpr int n = 100000;
    const double length = 1500 + std::sqrt(2000.0 * 2000 - h * h);
    for (int i = 0; i < n; ++i) {
      const double t = length * (i + 0.5) / n, r = std::hypot(t - 1500, h);
      expected += s / (4 * kPi) * std::exp(-s * (t + r)) / (r * r) * length / n;
    }
    EXPECT_NEAR(expected, s / (4 * h),
                0.25 * expected);  // pi / h, but for what is beyond the sphere and the extinction
    const auto run = render(scene, sources, std::make_unique<RaySensor>(repeated(ray), one_band(), 1 << 13), once);
    const Repeated got = over_problems(run.result, 0);
    EXPECT_NEAR(got.mean, expected, kSigmas * got.error) << h;
    EXPECT_LT(got.error, 0.02 * expected);
  }
}

TEST(Moon, SingleScatteringOfASlab) {
  // Sent back by a layer under a collimated moon: w E / (4 pi) m0 / (m + m0) (1 - exp(-tau (1/m + 1/m0))).
  const double tau = 0.7, albedo = 0.8, E = 3e-3, m0 = 0.6, m = 0.9;
  const auto scene = slab_scene(medium(Curve::constant(tau * (1 - albedo)), Curve::constant(tau * albedo)), 1);
  SourceSpecs sources;
  MoonSpec moon;
  moon.disk = SunSpec{{{std::sqrt(1 - m0 * m0), 0, m0}, 0, Curve::constant(E)}};
  moon.by_phase = false;
  sources.add(moon);
  PipelineOptions once;
  once.max_scatterings = 1;
  const Dir down{0, std::sqrt(1 - m * m), -m};
  const auto run =
      render(scene, sources, std::make_unique<RaySensor>(repeated({Vec3{0, 0, 3}, down, 0}), one_band(), 1 << 9), once);
  const Repeated got = over_problems(run.result, 0);
  const double expected = albedo * E / (4 * kPi) * m0 / (m + m0) * (1 - std::exp(-tau * (1 / m + 1 / m0)));
  EXPECT_NEAR(got.mean, expected, kSigmas * got.error);
  EXPECT_LT(kSigmas * got.error, 0.02 * expected) << "2 % would not be seen";
}

TEST(SqtPhase, FittedHenyeyGreensteinIsHenyeyGreenstein) {
  // Scattered once by a slab at many angles, and all its fluxes: the fitted function against the formula.
  for (const double g : {0.0, 0.6, -0.4}) {
    sqt::AlignedSource::Options options;
    options.max_order = 8;
    const sqt::AlignedSource source(*model_function(strf("hg:g=%g", g)), options);
    ModelSpec fitted{"sqt", {}, {}, {{"file", "hg.sqt"}}, sqt::make_bundle(sqt::encode_aligned(source, 0.01).data)};
    const SpectralState state = make_state(one_band(), 0.01, 0, 4);
    const auto phase = bake_phase(fitted, state), exact = bake_phase(hg(g), state);
    std::vector<float> p(state.size()), q(state.size());
    double integral = 0, worst = 0;
    for (int i = 0; i < 2000; ++i) {
      const double c = -1 + (i + 0.5) / 1000;
      phase->eval(c, p), exact->eval(c, q);
      integral += 2 * kPi * p[0] / 1000;
      worst = std::max(worst, std::fabs(double{p[0]} / q[0] - 1));
    }
    EXPECT_NEAR(integral, 1, 1e-3) << g;
    EXPECT_LT(worst, 0.03) << g;  // of the fit, straight on
    phase->asymmetry(p);
    EXPECT_NEAR(p[0], g, 3e-3);
    SourceSpecs sources;
    sources.add(SunSpec{dir_from_angles(0.6, 0), 0, Curve::constant(2)});
    const Ray look{{0, 0, 3}, normalized(Vec3{0.3, 0.2, -1}), 0};
    const auto with = [&](const ModelSpec& spec, uint64_t seed) {
      PipelineOptions other;
      other.seed = seed;
      return over_problems(render(slab_scene(medium(Curve::constant(0.2), Curve::constant(2), spec), 1), sources,
                                  std::make_unique<RaySensor>(repeated(look), one_band(), 1 << 10), other)
                               .result,
                           0);
    };
    const Repeated a = with(fitted, 1), b = with(hg(g), 2);
    EXPECT_NEAR(a.mean, b.mean, kSigmas * std::hypot(a.error, b.error) + 0.01 * b.mean) << g;
    EXPECT_LT(a.error, 0.01 * a.mean);
  }
  // A surface function is no phase function.
  ModelSpec wrong{"sqt", {}, {}, {{"file", "x.sqt"}}, nullptr};
  EXPECT_THROW(bake_phase(wrong, make_state(one_band(), 0.01, 0, 4)), Error);
}

}  // namespace
}  // namespace suite::test::media_scene_test
