// Lamps in scenes that repeat themselves: against sums over endless grids of lamps, against the same scene laid out
// cell by cell, and explicit samples against light met by chance.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/lamps_kit.h"
#include "tests/support/media_kit.h"

namespace suite::test::periodic_lamps_test {
namespace {

constexpr double kSigmas = 4.5;  // less than 1e-5 a comparison by chance
const Periodic kCell{{-2, 1}, {7, 5}};

Repeated render_mean(const std::shared_ptr<const Scene>& scene, const std::vector<LampSpec>& lamps, const Ray& ray,
                     uint32_t paths, const std::optional<Periodic>& cell, PipelineOptions pipeline = {}) {
  JobOptions job;
  job.progress = false;
  job.periodic = cell;
  job.pipeline = pipeline;
  SourceSpecs sources;
  sources.add(lamps);
  std::vector<std::unique_ptr<Sensor>> sensors;
  sensors.push_back(std::make_unique<RaySensor>(repeated(ray), one_band(), paths));
  const JobReport report = run_job(scene, sources, sensors, job);
  EXPECT_EQ(report.statistics.failures, 0u);
  return over_problems(static_cast<RaySensor&>(*sensors[0]).result, 0);
}

std::shared_ptr<Scene> level_floor(double reflectance) {
  auto scene = std::make_shared<Scene>();
  scene->materials = {material("floor", lambert(reflectance))};
  place(*scene, PrimitiveKind::plane, {0, 0}, 0);
  check_scene(*scene, "floor");
  return scene;
}

// Sum over an endless grid of I h / (r^2 + h^2)^(3/2), by Poisson's summation formula: 2 pi I / A times the sum over
// the reciprocal grid of exp(-|k| h) cos(k r).
double grid_irradiance(double intensity, double h, double x, double y) {
  double sum = 0;
  constexpr int n = 400;
  for (int i = -n; i <= n; ++i)
    for (int j = -n; j <= n; ++j) {
      const double kx = 2 * kPi * i / kCell.size.x, ky = 2 * kPi * j / kCell.size.y;
      sum += std::exp(-std::hypot(kx, ky) * h) * std::cos(kx * x + ky * y);
    }
  return 2 * kPi * intensity / (kCell.size.x * kCell.size.y) * sum;
}

TEST(PeriodicLamps, EndlessGridOverAPlane) {
  // The lamp's own position does not matter by whole cells; low ones, where few count, and high ones, where very many
  // do.
  const auto scene = level_floor(0.5);
  for (const double h : {0.5, 4.0, 60.0})
    for (const Vec3 at : {Vec3{0.4, 2, 0}, Vec3{4.9, 5.9, 0}}) {
      const Vec3 lamp{1.0 + 3 * 7, 3.0 - 2 * 5, h}, from = at + Vec3{0.02, 0.01, 0.03};
      PipelineOptions other;  // other numbers for every case
      other.seed = static_cast<uint64_t>(10 * h + at.x);
      const Repeated got =
          render_mean(scene, {point_lamp({lamp}, 3)}, {from, normalized(at - from), 0}, 1 << 11, kCell, other);
      const double truth = 0.5 / kPi * grid_irradiance(3, h, at.x - lamp.x, at.y - lamp.y);
      EXPECT_NEAR(got.mean, truth, kSigmas * got.error + 1e-5 * truth) << h << ' ' << at.x;
      EXPECT_LT(got.error, 4e-3 * truth) << h << ' ' << at.x;
      std::printf("grid of lamps at %g m, at (%g, %g): %.5f +- %.5f, sum %.5f\n", h, at.x, at.y, got.mean, got.error,
                  truth);
      // Control: the lamps of 3 x 3 cells are not all.
      double nine = 0;
      for (int i = -1; i <= 1; ++i)
        for (int j = -1; j <= 1; ++j) {
          const double dx = at.x - (1 + 7 * i), dy = at.y - (3 + 5 * j);
          nine += 0.5 / kPi * 3 * h / std::pow(dx * dx + dy * dy + h * h, 1.5);
        }
      EXPECT_GT(std::fabs(got.mean - nine), kSigmas * got.error);
    }
}

// A floor, a wall, and a lamp of the given kind that reaches over the side of the cell; `copies` on every side.
std::shared_ptr<Scene> yard(PrimitiveKind kind, std::vector<double> parameters, Vec3 where, int copies,
                            double tilt = kPi) {
  auto scene = std::make_shared<Scene>();
  scene->materials = {material("floor", lambert(0.5)), material("lamp", lambert(0.2)), material("wall", lambert(0.6))};
  const double wide = 2.0 * copies + 1;
  place(*scene, PrimitiveKind::plane, {kCell.size.x * wide, kCell.size.y * wide}, 0,
        translation({kCell.low.x + kCell.size.x / 2, kCell.low.y + kCell.size.y / 2, 0}));
  for (int x = -copies; x <= copies; ++x)
    for (int y = -copies; y <= copies; ++y) {
      const Affine3 cell = translation({x * kCell.size.x, y * kCell.size.y, 0});
      if (!parameters.empty())
        place(*scene, kind, parameters, 1, cell * translation(where) * rotation({1, 0, 0}, tilt));
      place(*scene, PrimitiveKind::box, {-1, 2, 0, -0.8, 4, 1.5}, 2, cell);
    }
  check_scene(*scene, "yard");
  return scene;
}

const Ray kLook{{1, 3, 0.5}, normalized(Vec3{0.3, 0.2, -1}), 0};

struct Laid {
  const char* name;
  PrimitiveKind kind;
  std::vector<double> parameters;
  Vec3 where;
  double tilt;
};
std::vector<Laid> surfaces() {
  return {{"disk", PrimitiveKind::disk, {0.6, 0}, {4.9, 5.8, 2}, kPi},
          {"tilted disk", PrimitiveKind::disk, {0.6, 0}, {4.9, 5.8, 2}, 2.2},
          {"rectangle", PrimitiveKind::plane, {1, 3}, {-2, 3, 2}, kPi},
          {"sphere", PrimitiveKind::sphere, {0.4}, {5, 6, 2}, 0}};
}

TEST(PeriodicLamps, GlowingSurfacesAreTheSceneLaidOut) {
  for (const Laid& l : surfaces()) {
    SCOPED_TRACE(l.name);
    const auto one =
                   render_mean(yard(l.kind, l.parameters, l.where, 0, l.tilt), {glow("lamp", 4)}, kLook, 1 << 9, kCell),
               many =
                   render_mean(yard(l.kind, l.parameters, l.where, 14, l.tilt), {glow("lamp", 4)}, kLook, 1 << 9, {}),
               alone =
                   render_mean(yard(l.kind, l.parameters, l.where, 0, l.tilt), {glow("lamp", 4)}, kLook, 1 << 8, {});
    std::printf("%s: periodic %.5f +- %.5f, 29 x 29 cells %.5f +- %.5f, one %.5f\n", l.name, one.mean, one.error,
                many.mean, many.error, alone.mean);
    EXPECT_NEAR(one.mean, many.mean, kSigmas * std::hypot(one.error, many.error) + 3e-3 * many.mean);
    EXPECT_LT(one.error, 0.01 * one.mean);
    EXPECT_GT(std::fabs(one.mean - alone.mean), kSigmas * std::hypot(one.error, alone.error));
  }
}

TEST(PeriodicLamps, ExplicitAndChanceLightAgree) {
  // Shared samples need the density of every image that a path may meet; by chance alone none is asked.
  PipelineOptions chance;
  chance.explicit_sources = false;
  for (const Laid& l : surfaces()) {
    SCOPED_TRACE(l.name);
    const auto scene = yard(l.kind, l.parameters, l.where, 0, l.tilt);
    const auto both = render_mean(scene, {glow("lamp", 4, true)}, kLook, 1 << 9, kCell),
               alone = render_mean(scene, {glow("lamp", 4, true)}, kLook, 1 << 13, kCell, chance);
    EXPECT_NEAR(both.mean, alone.mean, kSigmas * std::hypot(both.error, alone.error));
    EXPECT_LT(kSigmas * alone.error, 0.06 * alone.mean) << "6 % would not be seen";
    EXPECT_LT(both.error, alone.error);
  }
}

TEST(PeriodicLamps, PointsAndSpotsAreTheSceneLaidOut) {
  LampSpec spot = point_lamp({{4.8, 1.2, 3}}, 8);
  spot.kind = LampSpec::Kind::spot;
  spot.inner = 0.6, spot.outer = 1.1;
  spot.axis = {0.3, 0.2, -1};
  const LampSpec low = point_lamp({{0.5, 4, 0.6}, {-1.9, 5.9, 1}}, 1);
  std::vector<LampSpec> laid{spot, low};
  constexpr int copies = 40;
  for (LampSpec& lamp : laid) {
    const std::vector<Vec3> own = lamp.positions;
    lamp.positions.clear();
    for (const Vec3& p : own)
      for (int x = -copies; x <= copies; ++x)
        for (int y = -copies; y <= copies; ++y)
          lamp.positions.push_back(p + Vec3{x * kCell.size.x, y * kCell.size.y, 0});
  }
  const auto one = render_mean(yard(PrimitiveKind::disk, {}, {}, 0), {spot, low}, kLook, 1 << 10, kCell),
             many = render_mean(yard(PrimitiveKind::disk, {}, {}, copies), laid, kLook, 1 << 10, {});
  std::printf("points and spots: periodic %.5f +- %.5f, 81 x 81 cells %.5f +- %.5f\n", one.mean, one.error, many.mean,
              many.error);
  EXPECT_NEAR(one.mean, many.mean, kSigmas * std::hypot(one.error, many.error) + 3e-3 * many.mean);
  EXPECT_LT(one.error, 0.005 * one.mean);
}

TEST(PeriodicLamps, InFog) {
  // Points and a glowing disk, met after scatterings and through boundaries, in a layer that repeats itself.
  const auto foggy = [](int copies) {
    auto scene = yard(PrimitiveKind::disk, {0.6, 0}, {4.9, 5.8, 2}, copies);
    scene->media = {medium(Curve::constant(0.1), Curve::constant(0.2), hg(0.4))};
    scene->materials.push_back(boundary(0));
    place(*scene, PrimitiveKind::plane, {0, 0}, 3, translation({0, 0, 4}));
    check_scene(*scene, "fog");
    return scene;
  };
  const Ray look{{1, 3, 6}, normalized(Vec3{0.5, 0.2, -1}), 0};
  PipelineOptions chance;
  chance.explicit_sources = false;
  const auto one = render_mean(foggy(0), {glow("lamp", 4)}, look, 1 << 10, kCell),
             alone = render_mean(foggy(0), {glow("lamp", 4)}, look, 1 << 12, kCell, chance),
             many = render_mean(foggy(8), {glow("lamp", 4)}, look, 1 << 9, {});
  std::printf("fog: periodic %.5f +- %.5f, by chance %.5f +- %.5f, 17 x 17 cells %.5f +- %.5f\n", one.mean, one.error,
              alone.mean, alone.error, many.mean, many.error);
  EXPECT_NEAR(one.mean, alone.mean, kSigmas * std::hypot(one.error, alone.error));
  EXPECT_NEAR(one.mean, many.mean, kSigmas * std::hypot(one.error, many.error) + 3e-3 * many.mean);
  EXPECT_LT(kSigmas * one.error, 0.06 * one.mean) << "6 % would not be seen";
}

}  // namespace
}  // namespace suite::test::periodic_lamps_test
