// The sun under flat water: light that is asked for through one smooth interface, against closed forms.
#include <gtest/gtest.h>

#include <cmath>

#include "optics/fresnel.h"
#include "tests/support/pipeline_kit.h"

namespace suite::test {
namespace {

constexpr double kIndex = 1.33, kReflectance = 0.3, kDepth = 2;
const double kViewZenith = 20 * kDegree;

struct Water {
  double index = kIndex, depth = kDepth, absorption = 0, reflectance = kReflectance;
};

std::shared_ptr<Scene> bed(const Water& w) {
  auto scene = std::make_shared<Scene>();
  scene->materials = {material("bed", lambert(w.reflectance)),
                      material("water", {"dielectric", {}, {{"index", Curve::constant(w.index)}}, {}, nullptr})};
  place(*scene, PrimitiveKind::plane, {0, 0}, 0);
  place(*scene, PrimitiveKind::plane, {0, 0}, 1, translation({0, 0, w.depth}));
  if (w.absorption > 0) {
    scene->media = {medium(Curve::constant(w.absorption), Curve::constant(0))};
    scene->media[0].index = Curve::constant(w.index);
    scene->materials[1].inside = 0;
  }
  check_scene(*scene, "water bed");
  return scene;
}

SourceSpecs sun(double half_angle, double zenith) {
  SourceSpecs s;
  s.add(SunSpec{dir_from_angles(zenith, 0), half_angle, Curve::constant(1)});
  return s;
}

// Cosine below the surface.
double below(double cosine, double index) { return std::sqrt(1 - (1 - cosine * cosine) / (index * index)); }

// W/m2 that a disk of irradiance 1 brings to the bed: the mean over the disk by midpoints.
double on_bed(const Water& w, double half_angle, double zenith) {
  const auto at = [&](double c) {
    if (c <= 0) return 0.0;
    return c * fresnel_dielectric(c, w.index).transmittance * std::exp(-w.absorption * w.depth / below(c, w.index));
  };
  if (half_angle == 0) return at(std::cos(zenith));
  constexpr int n = 400;
  const Frame frame = Frame::around(dir_from_angles(zenith, 0));
  const double s = std::sin(half_angle);
  double sum = 0;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {  // even in solid angle
      const double c = 1 - (i + 0.5) / n * (1 - std::cos(half_angle)), r = std::sqrt(1 - c * c),
                   phi = 2 * kPi * (j + 0.5) / n;
      sum += at(frame.to_world({r * std::cos(phi), r * std::sin(phi), c}).z);
    }
  return sum / (n * n) * 2 * kPi * (1 - std::cos(half_angle)) / (kPi * s * s);
}

// Radiance towards the view: flux through the flat surface is conserved, radiance goes by the index squared; the bed
// and the surface reflect to and fro, weakened on the way.
double closed_form(const Water& w, double half_angle, double zenith) {
  double inside = 0;
  constexpr int n = 20000;
  for (int i = 0; i < n; ++i) {
    const double c = (i + 0.5) / n;
    inside += 2 * c * fresnel_dielectric(c, 1 / w.index).reflectance * std::exp(-2 * w.absorption * w.depth / c) / n;
  }
  const double v = std::cos(kViewZenith);
  return w.reflectance / kPi * on_bed(w, half_angle, zenith) * fresnel_dielectric(v, w.index).transmittance *
         std::exp(-w.absorption * w.depth / below(v, w.index)) / (w.index * w.index * (1 - w.reflectance * inside));
}

Seen run(const Water& w, double half_angle, double zenith, uint32_t paths, const PipelineOptions& options = {}) {
  const Dir view = dir_from_angles(kViewZenith, 0.4);
  const Vec3 from = view * (5 + 5 * w.depth);
  return see(bed(w), sun(half_angle, zenith), RaySensor(std::vector<Ray>{{from, -view, 0}}, one_band(), paths),
             options);
}

void expect(const Water& w, double half_angle, double zenith, uint32_t paths = 16384, double tolerance = 0.005) {
  const double truth = closed_form(w, half_angle, zenith);
  const auto r = run(w, half_angle, zenith, paths);
  const double mean = r.radiance[0], error = r.standard_error[0];
  SCOPED_TRACE(testing::Message() << "disk " << half_angle / kDegree << " deg, zenith " << zenith / kDegree
                                  << " deg, index " << w.index << ", depth " << w.depth << " m, absorption "
                                  << w.absorption << ": " << mean << " +- " << error << " for " << truth);
  EXPECT_NEAR(mean, truth, tolerance * truth);
  EXPECT_NEAR(mean, truth, 5 * error + 2e-5 * truth);  // 8 scrambles, p = 0.002; floats where nothing varies
  EXPECT_LE(r.missing[0], 1e-3 * truth);               // flagged as not resolved beyond
}

TEST(RefractedFlat, TheKnownCase) {
  const Water w;
  EXPECT_NEAR(closed_form(w, 0, 30 * kDegree), 0.0522, 5e-5);  // PHYSICS: 2 m, 30 and 20 degrees
  expect(w, 0, 30 * kDegree);
}

TEST(RefractedFlat, DisksAndSuns) {
  for (const double disk : {0.0, 0.27, 1.0, 10.0})
    for (const double zenith : {0.0, 30.0, 60.0, 75.0}) expect({}, disk * kDegree, zenith * kDegree);
}

TEST(RefractedFlat, AbsorbingWater) {
  for (const double absorption : {0.1, 1.0})
    for (const double disk : {0.0, 0.27}) expect({kIndex, kDepth, absorption}, disk * kDegree, 50 * kDegree);
}

// What connections own, chance leaves out: without them the same light is found by a wide disk alone.
TEST(RefractedFlat, ChanceAgreesWithAsking) {
  PipelineOptions chance;
  chance.refracted_sources = false;
  const double truth = closed_form({}, 10 * kDegree, 30 * kDegree);
  const auto r = run({}, 10 * kDegree, 30 * kDegree, 131072, chance);
  EXPECT_NEAR(r.radiance[0], truth, 4.5 * r.standard_error[0]);
  EXPECT_LT(r.standard_error[0], 0.05 * truth);
  // Negative control: counted twice it would be twice as much.
  EXPECT_LT(r.radiance[0], 1.5 * truth);
  const auto asked = run({}, 10 * kDegree, 30 * kDegree, 4096);
  // 0.2 was the bound before an eighth of the paths went to what the surface mirrors, which is nothing here.
  EXPECT_LT(asked.standard_error[0], 0.3 * r.standard_error[0]);
}

TEST(RefractedFlat, Extremes) {
  expect({1 + 1e-6}, 0, 30 * kDegree);
  expect({kIndex, 1e-3}, 0, 30 * kDegree);
  expect({kIndex, 1000}, 0, 30 * kDegree);
  expect({kIndex, kDepth, 5}, 0, 30 * kDegree);     // a way down and up of optical depth 21
  expect({kIndex, kDepth, 12.5}, 0, 30 * kDegree);  // and of 52
  expect({}, 0, 89.9 * kDegree, 65536);             // Newton's steps beyond the horizon end starts
  expect({}, 0.27 * kDegree, 89.9 * kDegree);       // half of the disk is below the horizon
  const auto horizon = run({}, 0, 90 * kDegree, 256);
  EXPECT_LT(horizon.radiance[0], 1e-7);
}

}  // namespace
}  // namespace suite::test
