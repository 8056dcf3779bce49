#include "motion/planets.h"

#include <erfa.h>

#include <cmath>

#include "motion/ephemeris.h"

namespace suite {

namespace {

constexpr double kLightDayPerAu = kAstronomicalUnit / 299792458 / 86400;

// Heliocentric, au. Beyond the theory's years ERFA computes and warns.
Vec3 heliocentric(Planet planet, JulianDate tt) {
  constexpr int kNumbers[kPlanets] = {1, 2, 4, 5, 6, 7, 8};  // 3 is the Earth with the Moon
  double pv[2][3];
  eraPlan94(tt.day, tt.fraction, kNumbers[static_cast<size_t>(planet)], pv);
  return {pv[0][0], pv[0][1], pv[0][2]};
}

}  // namespace

std::string name_of(Planet planet) {
  constexpr const char* kNames[kPlanets] = {"mercury", "venus", "mars", "jupiter", "saturn", "uranus", "neptune"};
  return kNames[static_cast<size_t>(planet)];
}

double PlanetPlace::phase_angle() const { return angle_between(normalized(from_sun), normalized(from_observer)); }

PlanetPlace planet_place(Planet planet, const CelestialSphere& sphere, JulianDate tt) {
  PlanetPlace p;
  double days = 0;
  for (int i = 0; i < 3; ++i) {  // converges by a factor of 1e-4 each
    p.from_sun = heliocentric(planet, {tt.day, tt.fraction - days});
    p.from_observer = p.from_sun + sphere.sun_au() - sphere.observer_au();
    days = length(p.from_observer) * kLightDayPerAu;
  }
  const Dir d = normalized(p.from_observer);
  p.place.right_ascension = std::atan2(d.y, d.x);
  p.place.declination = std::asin(std::fmax(-1, std::fmin(1, d.z)));
  return p;
}

}  // namespace suite
