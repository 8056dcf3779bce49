#include "motion/moon_face.h"

#include <erfa.h>
#include <erfam.h>

#include <cmath>

#include "motion/ephemeris.h"

namespace suite {

namespace {

// Selenographic place under what looks along a direction (ecliptic axes) at the Moon's centre.
struct Place {
  double latitude, longitude;
};
Place under(Vec3 towards_moon, double centuries) {
  constexpr double kTilt = 1.54242 * kDegree;  // of the Moon's equator to the ecliptic
  const double longitude = std::atan2(towards_moon.y, towards_moon.x),
               latitude = std::atan2(towards_moon.z, std::hypot(towards_moon.x, towards_moon.y)),
               w = longitude - eraFaom03(centuries);
  const double turned =
      std::atan2(std::sin(w) * std::cos(latitude) * std::cos(kTilt) - std::sin(latitude) * std::sin(kTilt),
                 std::cos(w) * std::cos(latitude));
  return {std::asin(-std::sin(w) * std::cos(latitude) * std::sin(kTilt) - std::sin(latitude) * std::cos(kTilt)),
          std::remainder(turned - eraFaf03(centuries), 2 * kPi)};
}

}  // namespace

MoonFace moon_face(const CelestialSphere& sphere, JulianDate tt, Dir to_moon, Dir to_sun) {
  const double centuries = (tt.day - ERFA_DJ00 + tt.fraction) / ERFA_DJC;
  const Place here = under(sphere.ecliptic().to_local(to_moon), centuries),
              sun = under(sphere.ecliptic().to_local(-to_sun), centuries);
  return {here.latitude, here.longitude, sun.latitude, sun.longitude};
}

LunarEclipse lunar_eclipse(Instant instant) {
  constexpr double kEarth = 6378.137e3;  // m
  const SceneFrame any(Geodetic{});
  const Vec3 centre = any.enu_from_ecef({0, 0, 1});  // a metre off: no vertical there
  const SkyBody sun = sun_at(any, centre, instant), moon = moon_at(any, centre, instant);
  const double apart = angle_between(moon.direction, -sun.direction), size = moon.angular_radius,
               shadow = 1.01 * std::asin(kEarth / moon.distance) + std::asin(kEarth / sun.distance);
  const auto magnitude = [&](double radius) { return (radius + size - apart) / (2 * size); };
  return {magnitude(shadow - sun.angular_radius), magnitude(shadow + sun.angular_radius)};
}

double solar_eclipse(const SceneFrame& frame, Vec3 site, Instant instant, double dut1) {
  const SkyBody sun = sun_at(frame, site, instant, dut1), moon = moon_at(frame, site, instant, dut1);
  return (sun.angular_radius + moon.angular_radius - angle_between(sun.direction, moon.direction)) /
         (2 * sun.angular_radius);
}

}  // namespace suite
