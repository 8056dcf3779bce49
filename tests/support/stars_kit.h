// Stars for tests: one in a sky without anything else, a camera that looks at it, and what it is to gather.
#pragma once
#include <cmath>
#include <sstream>

#include "light/kinds/night_sky.h"
#include "support/platform_kit.h"

namespace suite::test {

inline constexpr Geodetic kPlace{49.4, 8.7, 120};
inline constexpr const char* kUtc = "2026-03-20T22:00:00Z";
inline const CatalogueStar kStar{"1", {1.9, 0.7, 0, 0}, 3.0, 6000};  // high in the west
inline constexpr double kStep = 1e-4;                                // rad, of a pixel on the axis: 10 um at 100 mm

inline CelestialSphere sphere() {
  const Instant t = instant_from_utc(parse_iso8601(kUtc));
  return CelestialSphere(SceneFrame(kPlace), julian_tt(t), julian_ut1(t, 0));
}
inline SourceSpecs stars_alone(std::vector<CatalogueStar> stars, bool in_view = true) {
  NightSkyLightSpec night;
  night.scale = {0, 0, 0, 0, 1};
  night.catalogue = std::make_shared<const std::vector<CatalogueStar>>(std::move(stars));
  night.time.utc = kUtc;
  night.place = kPlace;
  night.in_view = in_view;
  SourceSpecs sources;
  sources.add(night);
  return sources;
}
// In the band of 0.55 um, above the air, W/(m2 um): Planck over the band, by the trapezoidal rule.
inline double above(const CatalogueStar& star) {
  double sum = 0;
  const Curve shape = star_shape(star.kelvin);
  for (int i = 0; i < 100; ++i) sum += shape.at(0.545 + (i + 0.5) * 1e-4) / 100;
  return kVegaIrradiance * flux_of(star.v) * sum;
}
inline std::string bands() { return "bands: [{name: v, center_um: 0.55, fwhm_um: 0.01, shape: rectangular}]\n"; }

// A camera that looks past the star by angles (rad) to its left and upwards.
inline std::string camera(Dir star, double right, double up, const std::string& more = {}) {
  const Frame frame = Frame::with_tangent(star, cross(star, {0, 0, 1}));
  const Vec3 at = frame.z + frame.x * std::tan(right) - cross(frame.z, frame.x) * std::tan(up);
  return "kind: frame_camera\nname: c\ncolumns: 200\nrows: 200\npitch_um: 10\nfocal_length_mm: 100\n"
         "position_m: [0, 0, 2]\nlook_at_m: [" +
         strf("%.17g, %.17g, %.17g", 1e3 * at.x, 1e3 * at.y, 2 + 1e3 * at.z) + "]\npaths: 4\n" + bands() + more;
}
// Sum of radiance times the solid angle of its pixel.
inline double energy(const Shot& shot, double f_in_pixels) {
  double sum = 0;
  const CaptureResult& r = shot.result;
  for (size_t p = 0; p < r.problems(); ++p) {
    const double x = static_cast<double>(p % r.columns) + 0.5 - 0.5 * r.columns,
                 y = static_cast<double>(p / r.columns) + 0.5 - 0.5 * r.rows,
                 distance2 = f_in_pixels * f_in_pixels + x * x + y * y;
    sum += r.radiance[p * r.values_per_problem()] * f_in_pixels / (distance2 * std::sqrt(distance2));
  }
  return sum;
}
struct Listed {
  double number, v, column, row, irradiance;
};
inline std::vector<Listed> table_of(const Shot& shot) {
  std::vector<Listed> all;
  for (const TextFile& text : shot.texts) {
    std::istringstream lines(text.text);
    for (std::string line; std::getline(lines, line);) {
      Listed s{};
      if (std::sscanf(line.c_str(), "%lf,%lf,%lf,%lf,%lf", &s.number, &s.v, &s.column, &s.row, &s.irradiance) == 5)
        all.push_back(s);
    }
  }
  return all;
}
inline std::shared_ptr<Scene> ground(std::vector<Mesh> more = {}) {
  more.push_back(mesh_of({{-9, -9, 0}, {9, -9, 0}, {9, 9, 0}, {-9, 9, 0}}, {0, 1, 2, 0, 2, 3}, 0));
  return scene_of(std::move(more), {material("ground", lambert(0.2))});
}

}  // namespace suite::test
