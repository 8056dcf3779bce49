// Glass and water that lie on something opaque, face in face: closed forms.
#include <gtest/gtest.h>

#include <cmath>

#include "optics/fresnel.h"
#include "tests/support/even_within.h"
#include "tests/support/media_kit.h"
#include "tests/support/pipeline_kit.h"

namespace suite::test::contacts_test {
namespace {

constexpr double kIndex = 1.5, kReflectance = 0.5, kThick = 0.2;
constexpr double kSigmas = 4.5;  // less than 1e-5 a comparison by chance

struct Laid {
  double floor = 0;  // m
  bool floor_first = true, medium = true, mesh = false;
};

// A sheet of glass over 0 < z < kThick without end, or a mesh that is wide enough, on a floor.
std::shared_ptr<Scene> glass_on_floor(const Laid& laid) {
  auto scene = std::make_shared<Scene>();
  Material glass = material("glass", {"dielectric", {}, {{"index", Curve::constant(kIndex)}}, {}, nullptr});
  if (laid.medium) {
    Medium of_glass = medium(Curve::constant(0), Curve::constant(0));
    of_glass.index = Curve::constant(kIndex);
    scene->media = {of_glass};
    glass.inside = 0;
  }
  scene->materials = {material("floor", lambert(kReflectance)), glass};
  scene->groups.push_back({"root", {}});
  const auto put_floor = [&] { place(*scene, PrimitiveKind::plane, {0, 0}, 0, translation({0, 0, laid.floor})); };
  if (laid.floor_first) put_floor();
  if (laid.mesh) {
    scene->meshes = {box({-200, -200, 0}, {200, 200, kThick}, 1, true)};
    scene->groups[0].placements.push_back({{}, TargetKind::mesh, 0, kNone, kNone});
  } else {
    place(*scene, PrimitiveKind::box, {0, 0, 0, 0, 0, kThick}, 1);
  }
  if (!laid.floor_first) put_floor();
  check_scene(*scene, "glass on the floor");
  return scene;
}

// Flux through the upper face is conserved, floor and face throw it to and fro.
double under_sky(double view) {
  const double r = reflected_within(kIndex), t = fresnel_dielectric(view, kIndex).transmittance;
  return 1 - t + t * kReflectance * (1 - r) / (1 - kReflectance * r);
}
double under_sun(double view, double sun) {
  return kReflectance / kPi * sun * fresnel_dielectric(sun, kIndex).transmittance *
         fresnel_dielectric(view, kIndex).transmittance /
         (kIndex * kIndex * (1 - kReflectance * reflected_within(kIndex)));
}

const double kView = 20 * kDegree, kSun = 35 * kDegree;

Seen run(const Laid& laid, bool sun) {
  SourceSpecs sources;
  if (sun)
    sources.add(SunSpec{dir_from_angles(kSun, 0), 0, Curve::constant(1)});
  else
    sources.add(uniform_sky(1, true));
  const Dir view = dir_from_angles(kView, 0.4);
  return see(glass_on_floor(laid), sources,
             RaySensor(std::vector<Ray>{{view * 3.0, -view, 0}}, one_band(), sun ? 1 << 14 : 1 << 16));
}

// Regression: a ray that had been let out of the lower face started beyond the floor, and what glass lay on was black.
TEST(Contacts, GlassOnTheFloor) {
  for (const bool sun : {false, true})
    for (const bool floor_first : {true, false})
      for (const bool medium : {true, false})
        for (const bool mesh : {false, true}) {
          const Seen r = run({0, floor_first, medium, mesh}, sun);
          const double truth = sun ? under_sun(std::cos(kView), std::cos(kSun)) : under_sky(std::cos(kView));
          EXPECT_NEAR(r.radiance[0], truth, kSigmas * r.standard_error[0])
              << "sun " << sun << ", floor first " << floor_first << ", medium " << medium << ", mesh " << mesh;
          EXPECT_LT(kSigmas * r.standard_error[0], 0.02 * truth) << "that would not be seen";
        }
}

// A floor in the glass is the same; one that lies free below it is another thing, which the comparison sees.
TEST(Contacts, WhatDoesNotTouchIsSeenThroughAir) {
  const double truth = under_sky(std::cos(kView));
  const Seen sunk = run({1e-3}, false), below = run({-1e-3}, false);
  EXPECT_NEAR(sunk.radiance[0], truth, kSigmas * sunk.standard_error[0]);
  EXPECT_GT(std::fabs(below.radiance[0] - truth), kSigmas * below.standard_error[0]);
}

}  // namespace
}  // namespace suite::test::contacts_test
