#include "motion/ephemeris.h"

#include <erfa.h>
#include <erfam.h>

#include <cmath>
#include <mutex>
#include <unordered_map>

#include "base/error.h"

namespace suite {

namespace {

using Geometric = Vec3 (*)(JulianDate tt);  // from the Earth's centre, GCRS axes, m

Vec3 sun_geometric(JulianDate tt) {
  double heliocentric[2][3], barycentric[2][3];
  eraEpv00(tt.day, tt.fraction, heliocentric,
           barycentric);  // status 1 only outside 1900-2100: accuracy degrades slowly
  return Vec3{heliocentric[0][0], heliocentric[0][1], heliocentric[0][2]} * -kAstronomicalUnit;
}

Vec3 moon_geometric(JulianDate tt) {
  double pv[2][3];
  eraMoon98(tt.day, tt.fraction, pv);
  return Vec3{pv[0][0], pv[0][1], pv[0][2]} * kAstronomicalUnit;
}

// Where the body is seen from the Earth's centre: its geocentric place one light-time ago. That includes the Earth's
// own motion (planetary aberration, Explanatory Supplement to the Astronomical Almanac, 1992, section 3.314).
Vec3 apparent_geocentric(Geometric body, JulianDate tt) {
  double light_time = length(body(tt)) / ERFA_CMPS;
  Vec3 p;
  for (int i = 0; i < 2; ++i) {
    p = body({tt.day, tt.fraction - light_time / ERFA_DAYSEC});
    light_time = length(p) / ERFA_CMPS;
  }
  return p;
}

Vec3 turn(const double m[3][3], Vec3 v) {
  return {m[0][0] * v.x + m[0][1] * v.y + m[0][2] * v.z, m[1][0] * v.x + m[1][1] * v.y + m[1][2] * v.z,
          m[2][0] * v.x + m[2][1] * v.y + m[2][2] * v.z};
}

void check_air(const SiteAir& air, double dut1) {
  if (!(air.pressure >= 0 && air.pressure <= 2e5))
    throw Error(strf("air pressure %g Pa is outside its range", air.pressure), "give 0 (no refraction) to 2e5 Pa");
  if (!(air.temperature >= 150 && air.temperature <= 400))
    throw Error(strf("air temperature %g K is outside its range", air.temperature), "give 150 to 400 K");
  // Up to 0.9 at second 0, and one more behind each leap second of the run.
  if (!(std::fabs(dut1) <= 3.9)) throw Error(strf("dut1 = %g s is outside its range", dut1), "give -0.9 to 0.9 s");
}

// What changes slowly in the sky: the pole and the locator of the origin of right ascension, rad, and the place of a
// body as seen from the Earth's centre, GCRS axes, m.
struct SlowSky {
  double x = 0, y = 0, locator = 0;
  Vec3 body;
};
SlowSky exact_sky(JulianDate tt, Geometric body) {
  SlowSky sky;
  eraXys06a(tt.day, tt.fraction, &sky.x, &sky.y, &sky.locator);
  sky.body = apparent_geocentric(body, tt);
  return sky;
}

SkyBody seen(const SceneFrame& frame, Vec3 site, JulianDate tt, JulianDate ut1, const SiteAir& air, const SlowSky& sky,
             double radius) {
  double to_intermediate[3][3], pole[3][3], to_earth_fixed[3][3];
  eraC2ixys(sky.x, sky.y, sky.locator, to_intermediate);
  eraPom00(0, 0, eraSp00(tt.day, tt.fraction), pole);
  eraC2tcio(to_intermediate, eraEra00(ut1.day, ut1.fraction), pole, to_earth_fixed);

  // Topocentric vector in Earth-fixed axes, with the aberration of the observer's daily motion.
  const Vec3 observer = frame.ecef_from_enu(site);
  Vec3 p = turn(to_earth_fixed, sky.body) - observer;
  const double distance = length(p);
  constexpr double kEarthRate = 7.292115e-5;  // rad/s
  p += Vec3{-observer.y, observer.x, 0} * (kEarthRate * distance / ERFA_CMPS);

  SkyBody r;
  r.distance = distance;
  r.angular_radius = std::asin(std::fmin(1.0, radius / distance));
  r.direction = normalized(frame.enu_direction(p));
  const Dir up = frame.local_axes(site).z;
  r.elevation = kPi / 2 - angle_between(r.direction, up);
  if (const double lift = refraction_lift(r.elevation, air); lift > 0) {
    const Vec3 level = r.direction - up * dot(r.direction, up);
    if (length(level) > 0) {
      r.elevation += lift;
      r.direction = normalized(level) * std::cos(r.elevation) + up * std::sin(r.elevation);
    }
  }
  return r;
}

}  // namespace

double refraction_lift(double elevation, const SiteAir& air) {
  const double e = elevation / kDegree;
  if (air.pressure <= 0 || e < -1) return 0;
  const double arc_minutes = 1.02 / std::tan((e + 10.3 / (e + 5.11)) * kDegree);
  const double lift = (air.pressure / 101000) * (283 / air.temperature) * arc_minutes / 60 * kDegree;
  return std::fmax(lift, 0.0);  // the formula dips below 0 by 0.1 arc second at the zenith
}

SkyBody sun_at(const SceneFrame& frame, Vec3 site, Instant instant, double dut1, const SiteAir& air) {
  check_air(air, dut1);
  const JulianDate tt = julian_tt(instant);
  return seen(frame, site, tt, julian_ut1(instant, dut1), air, exact_sky(tt, sun_geometric), kSunRadius);
}

SkyBody moon_at(const SceneFrame& frame, Vec3 site, Instant instant, double dut1, const SiteAir& air) {
  check_air(air, dut1);
  const JulianDate tt = julian_tt(instant);
  return seen(frame, site, tt, julian_ut1(instant, dut1), air, exact_sky(tt, moon_geometric), kMoonRadius);
}

// Exact skies of the sun, by their number since J2000.
struct SunSeries::Knots {
  static constexpr double kADay = 8;        // knots
  static constexpr size_t kMost = 1 << 20;  // 48 MB, 350 years; then anew
  std::mutex guard;
  std::unordered_map<int64_t, SlowSky> known;

  SlowSky at(int64_t n) {
    const std::lock_guard lock(guard);
    if (known.size() >= kMost) known.clear();
    const auto [found, is_new] = known.try_emplace(n);
    if (is_new) found->second = exact_sky({ERFA_DJ00, static_cast<double>(n) / kADay}, sun_geometric);
    return found->second;
  }
};

SunSeries::SunSeries(const SceneFrame& frame, Vec3 site) : frame_(frame), site_(site), knots_(new Knots) {}
SunSeries::~SunSeries() = default;

SkyBody SunSeries::at(Instant instant, double dut1, const SiteAir& air) const {
  check_air(air, dut1);
  const JulianDate tt = julian_tt(instant);
  const double place = Knots::kADay * ((tt.day - ERFA_DJ00) + tt.fraction), first = std::floor(place),
               u = place - first;
  // Lagrange's weights of the knots -1, 0, 1 and 2.
  const double weights[] = {-u * (u - 1) * (u - 2) / 6, (u + 1) * (u - 1) * (u - 2) / 2, -(u + 1) * u * (u - 2) / 2,
                            (u + 1) * u * (u - 1) / 6};
  SlowSky sky;
  for (int k = 0; k < 4; ++k) {
    const SlowSky knot = knots_->at(static_cast<int64_t>(first) + k - 1);
    sky.x += weights[k] * knot.x, sky.y += weights[k] * knot.y, sky.locator += weights[k] * knot.locator;
    sky.body += knot.body * weights[k];
  }
  return seen(frame_, site_, tt, julian_ut1(instant, dut1), air, sky, kSunRadius);
}

double moon_phase_angle(Instant instant) {
  const JulianDate tt = julian_tt(instant);
  const Vec3 moon = moon_geometric(tt), sun = sun_geometric(tt);
  return angle_between(normalized(sun - moon), normalized(-moon));
}

EquatorialPlace moon_geocentric(Instant instant) {
  const JulianDate tt = julian_tt(instant);
  double to_date[3][3];
  eraPnm06a(tt.day, tt.fraction, to_date);
  const Vec3 p = turn(to_date, apparent_geocentric(moon_geometric, tt));
  double right_ascension = std::atan2(p.y, p.x);
  if (right_ascension < 0) right_ascension += 2 * kPi;
  return {right_ascension, std::atan2(p.z, std::hypot(p.x, p.y)), length(p)};
}

}  // namespace suite
