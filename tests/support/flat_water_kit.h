// A Lambert bed under flat water, under a sun's disk: the scene, its closed form, and what is rendered of it.
#pragma once
#include <cmath>
#include <memory>

#include "optics/fresnel.h"
#include "tests/support/pipeline_kit.h"

namespace suite::test {

inline constexpr double kWaterIndex = 1.33, kBedReflectance = 0.3, kWaterDepth = 2;
inline const double kViewZenith = 20 * kDegree;

struct FlatWater {
  double index = kWaterIndex, depth = kWaterDepth, absorption = 0, reflectance = kBedReflectance;
};

inline std::shared_ptr<Scene> water_bed(const FlatWater& w) {
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

inline SourceSpecs sun_disk(double half_angle, double zenith) {
  SourceSpecs s;
  s.add(SunSpec{dir_from_angles(zenith, 0), half_angle, Curve::constant(1)});
  return s;
}

// Cosine below the surface.
inline double cosine_below(double cosine, double index) {
  return std::sqrt(1 - (1 - cosine * cosine) / (index * index));
}

// W/m2 that a disk of irradiance 1 brings to the bed: the mean over the disk by midpoints.
inline double on_bed(const FlatWater& w, double half_angle, double zenith) {
  const auto at = [&](double c) {
    if (c <= 0) return 0.0;
    return c * fresnel_dielectric(c, w.index).transmittance *
           std::exp(-w.absorption * w.depth / cosine_below(c, w.index));
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
inline double bed_radiance(const FlatWater& w, double half_angle, double zenith) {
  double inside = 0;
  constexpr int n = 20000;
  for (int i = 0; i < n; ++i) {
    const double c = (i + 0.5) / n;
    inside += 2 * c * fresnel_dielectric(c, 1 / w.index).reflectance * std::exp(-2 * w.absorption * w.depth / c) / n;
  }
  const double v = std::cos(kViewZenith);
  return w.reflectance / kPi * on_bed(w, half_angle, zenith) * fresnel_dielectric(v, w.index).transmittance *
         std::exp(-w.absorption * w.depth / cosine_below(v, w.index)) /
         (w.index * w.index * (1 - w.reflectance * inside));
}

inline Seen see_bed(const FlatWater& w, double half_angle, double zenith, uint32_t paths,
                    const PipelineOptions& options = {}) {
  const Dir view = dir_from_angles(kViewZenith, 0.4);
  const Vec3 from = view * (5 + 5 * w.depth);
  return see(water_bed(w), sun_disk(half_angle, zenith),
             RaySensor(std::vector<Ray>{{from, -view, 0}}, one_band(), paths), options);
}

}  // namespace suite::test
