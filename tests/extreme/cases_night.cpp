// Low light: nine decades in a frame, exposures from a microsecond to an hour, dates a century away, poles and the
// equator, frames without light.
#include <array>
#include <cmath>

#include "extreme/case.h"
#include "light/kinds/night_sky.h"
#include "light/night/glow_shells.h"
#include "light/night/zodiacal.h"
#include "tests/support/media_kit.h"
#include "tests/support/stars_kit.h"

namespace suite::extreme {

namespace {

using namespace test;

Dir towards_star() { return sphere().without_air(kStar.place); }

// Overcast starlight over snow: cloud and snow that take nothing leave the sky's radiance everywhere.
double off_under_cloud(double depth) {
  Medium cloud = medium(Curve::constant(0), Curve::constant(depth));
  auto scene = slab_scene(cloud, 1);
  auto own = std::make_shared<Scene>(*scene);
  own->materials.push_back(material("snow", lambert(1)));
  place(*own, PrimitiveKind::plane, {0, 0}, static_cast<uint32_t>(own->materials.size() - 1), translation({0, 0, -1}));
  check_scene(*own, "snow");
  constexpr double kStarlight = 1e-9;
  SourceSpecs sources;
  sources.add(uniform_sky(kStarlight, false));
  const auto run = render(
      own, sources,
      std::make_unique<RaySensor>(std::vector<Ray>(16, Ray{{0.1, 0.2, -0.5}, {0.3, 0, -0.954}, 0}), one_band(), 64));
  double mean = 0;
  for (const double L : run.result.radiance) mean += L / 16;
  return std::fabs(mean / kStarlight - 1);
}

// The glint of the full Moon beside ground of a small reflectance.
double off_beside_glint(double reflectance) {
  constexpr double kHalf = 0.26 * kDegree, kFullMoon = 2e-3;
  SunSpec moon;
  moon.direction = {0, 0, 1}, moon.half_angle = kHalf, moon.irradiance = Curve::constant(kFullMoon);
  SourceSpecs sources;
  sources.add(moon);
  const auto scene =
      scene_of({quad(40, 0, 0), mesh_of({{1, -9, 1}, {9, -9, 1}, {9, 9, 1}, {1, 9, 1}}, {0, 1, 2, 0, 2, 3}, 1)},
               {material("ground", lambert(reflectance)),
                material("water", {"mirror", {}, {{"reflectance", Curve::constant(0.02)}}, {}, nullptr})});
  const auto run =
      render(scene, sources,
             std::make_unique<RaySensor>(std::vector<Ray>{{{5, 0, 9}, {0, 0, -1}, 0}, {{-30, 0, 9}, {0, 0, -1}, 0}},
                                         one_band(), 256));
  const double glint = 0.02 * kFullMoon / (kPi * std::pow(std::sin(kHalf), 2)), dark = reflectance * kFullMoon / kPi;
  return std::max(std::fabs(run.result.radiance[0] / glint - 1), std::fabs(run.result.radiance[1] / dark - 1));
}

// A star of V = 8 in a frame with one that is brighter by so many magnitudes.
double off_beside_bright(double magnitudes) {
  CatalogueStar faint = kStar, bright = kStar;
  faint.name = "1", faint.v = 8;
  bright.name = "2", bright.v = 8 - magnitudes, bright.place.declination += 30 * kStep;
  PlatformKit kit;
  kit.render(ground(), stars_alone({faint, bright}), camera(towards_star(), 0, 0));
  double off = 1;
  for (const Listed& s : table_of(kit.shots[0]))
    if (s.number == 1) off = std::fabs(s.irradiance / above(faint) - 1);
  const double all = above(faint) + above(bright);
  return std::max(off, std::fabs(energy(kit.shots[0], 1e4) / all - 1));
}

double off_in_exposure(double seconds) {
  std::string wide = camera(towards_star(), 0, 0, strf("time_s: 0\nintegration_time_s: %.9g\n", seconds));
  wide.replace(wide.find("focal_length_mm: 100"), 20, "focal_length_mm: 2.5");
  PlatformKit kit;
  kit.render(ground(), stars_alone({kStar}), wide);
  return std::fabs(energy(kit.shots[0], 250) / above(kStar) - 1);
}

CelestialSphere sphere_in(double year, const Geodetic& place) {
  const JulianDate date{2451545 + 365.25 * (year - 2000), 0};
  return CelestialSphere(SceneFrame(place), date, date);
}

// The pole's way from that of J2000, theta of N. Capitaine et al. 2003, less nutation, of 9.6 arc seconds at most.
double off_precession(double years) {
  double most = 0;
  for (const double year : {2000 - years, 2000 + years}) {
    const CelestialSphere sky = sphere_in(year, kPlace);
    const double t = (year - 2000) / 100, theta = 2004.191903 * t - 0.4294934 * t * t - 0.04182264 * t * t * t;
    const double seen = angle_between(sky.to_celestial(sky.pole()), {0, 0, 1}) * 3600 / kDegree;
    most = std::max(most, std::fabs(seen - std::fabs(theta)));
  }
  return most;
}

double off_at_latitude(double latitude) {
  double most = 0;
  for (const double side : {1.0, -1.0}) {
    const CelestialSphere sky = sphere_in(2026, {side * latitude, 8.7, 0});
    const Dir pole = sky.pole();
    // Beside the zenith by the horizontal part: an arc sine would lose it.
    const double above = std::atan2(pole.z, std::hypot(pole.x, pole.y)) / kDegree;
    NightSkySpec spec;
    spec.catalogue = {std::shared_ptr<void>(), &bright_star_catalogue()};
    std::vector<double> w(NightMap(spec, sky).components().size());
    NightMap(spec, sky).weights({0, 0, 1}, w);
    double sum = 0;
    for (const double v : w) sum += v;
    if (!(sum > 0 && std::isfinite(sum))) return NAN;
    most = std::max(most, std::fabs(above - side * latitude));
  }
  return most;
}

// Nothing comes from the Sun's place below the horizon; above it, zodiacal light is finite up to the Sun.
double off_towards_sun(double degrees) {
  const Instant midnight = instant_from_utc(parse_iso8601(kUtc));
  const CelestialSphere sky(SceneFrame(kPlace), julian_tt(midnight), julian_ut1(midnight, 0));
  const Dir sun = sky.ecliptic().to_world({std::cos(sky.sun_longitude()), std::sin(sky.sun_longitude()), 0});
  if (sun.z > -0.3) return NAN;
  NightSkySpec spec;
  spec.catalogue = {std::shared_ptr<void>(), &bright_star_catalogue()};
  const NightMap map(spec, sky);
  std::vector<double> w(map.components().size(), 1);
  map.weights(sun, w);
  double off = 0;
  for (const double v : w) off += std::fabs(v);
  return off + std::fabs(zodiacal_s10(degrees * kDegree, 0) / zodiacal_s10(0, 0) - 1);
}

// Means and errors of a corner under ever less light, over those under 1e-6 W/(m2 sr um) by the same paths; without
// any, zeros.
double off_in_the_dark(double radiance) {
  const auto corner = [](double reflectance) {
    return scene_of({quad(40, 0, 0), box({-20, 1, 0}, {20, 2, 30}, 0, true)}, {material("grey", lambert(reflectance))});
  };
  const auto shot = [&](double sky, double reflectance) {
    SourceSpecs s;
    s.add(uniform_sky(sky, false));
    return render(corner(reflectance), s,
                  std::make_unique<RaySensor>(std::vector<Ray>{{{0, 0.5, 5}, {0, 0, -1}, 0}}, one_band(), 64))
        .result;
  };
  const CaptureResult some = shot(1e-6, 0.2), few = shot(radiance, 0.2), none = shot(radiance, 0);
  if (none.radiance[0] != 0 || none.standard_error[0] != 0) return NAN;
  return std::max(std::fabs(few.radiance[0] / radiance / (some.radiance[0] / 1e-6) - 1),
                  std::fabs(few.standard_error[0] / radiance / (some.standard_error[0] / 1e-6) - 1));
}

// A sensor at 400 km over the equator looks along the limb, so far below the top of the layer at 87 km: a ring's chord.
double off_along_limb(double below) {
  constexpr double kEquator = 6378137.0, kFrom = 400e3, kHeight = 87e3;
  const double thick = GlowShells::thickness(kHeight), top = kEquator + kHeight + thick / 2, r = top - below;
  const GlowShells shells(SceneFrame({0, 20, 0}), std::vector<double>{kHeight});
  const double sine = r / (kEquator + kFrom);
  const GlowShells::Share s = shells.share(0, {0, 0, kFrom}, {sine, 0, -std::sqrt((1 - sine) * (1 + sine))}, INFINITY);
  return std::fabs((s.near + s.far) * thick / (2 * std::sqrt(below * (top + r))) - 1);
}

std::vector<Case> frames() {
  using N = const Numerics&;
  return {
      {"low light",
       "snow under a cloud that takes nothing, by starlight",
       "closed form",
       "1",
       0.02,
       [](N, double x) { return off_under_cloud(x); },
       {"optical depth", "1", 1, 128, 2},
       {}},
      {"low light",
       "glint of the full Moon, 1e9 times the ground beside it",
       "closed forms",
       "1",
       1e-4,
       [](N, double x) { return off_beside_glint(x); },
       {"reflectance of the ground", "1", 1e-6, 1e-30, 10},
       {}},
      {"low light",
       "a star of V = 8 beside a bright one",
       "closed form",
       "1",
       1e-4,
       [](N, double x) { return off_beside_bright(x); },
       {"difference", "mag", 20.7, 100, 1.2},
       {}},
      {"low light",
       "light of a star in exposures of 1 us to 1 h",
       "closed form",
       "1",
       0.01,
       [](N, double x) { return off_in_exposure(x); },
       {"exposure", "s", 1e-6, 3600, 6.25689031},
       {}},
  };
}

std::vector<Case> skies() {
  using N = const Numerics&;
  return {
      {"low light",
       "the pole's way in 1900 and 2100",
       "Capitaine et al. 2003",
       "arc seconds",
       10,
       [](N, double x) { return off_precession(x); },
       {"years from 2000", "a", 100, 3200, 2},
       {}},
      {"low light",
       "height of the celestial pole near the Earth's poles",
       "latitude",
       "degrees",
       1e-7,
       [](N, double x) { return off_at_latitude(90 - x); },
       {"distance from the pole", "degrees", 1, 1e-12, 10},
       {}},
      {"low light",
       "height of the celestial pole near the equator",
       "latitude",
       "degrees",
       1e-7,
       [](N, double x) { return off_at_latitude(x); },
       {"latitude", "degrees", 1, 1e-12, 10},
       {}},
      {"low light",
       "towards the Sun, below the horizon and above",
       "0; its limit",
       "1",
       1e-3,
       [](N, double x) { return off_towards_sun(x); },
       {"degrees from the Sun", "degrees", 1e-3, 1e-15, 10},
       {}},
      {"low light",
       "airglow along the limb from 400 km",
       "chord of a ring",
       "1",
       1e-4,
       [](N, double x) { return off_along_limb(x); },
       {"distance below the layer's top", "m", 5e3, 1e-9, 10},
       {}},
      {"low light",
       "means and errors under ever less light",
       "those of 1e-6 W/(m2 sr um)",
       "1",
       1e-5,
       [](N, double x) { return off_in_the_dark(x); },
       {"radiance of the sky", "W/(m2 sr um)", 1e-7, 1e-40, 10},
       {}},
  };
}

}  // namespace

std::vector<Case> night_cases() {
  std::vector<Case> all = frames();
  for (Case& c : skies()) all.push_back(std::move(c));
  return all;
}

}  // namespace suite::extreme
