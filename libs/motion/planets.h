// Where the planets stand.
//
// Assumes: Newtonian light time; the Sun bends no light of planets by more than it bends that of stars.
// Accuracy: heliocentric longitudes from 1800 to 2050 within 4 to 17 arc seconds for Mercury to Mars, 71 to 86 for
// Jupiter to Uranus, 11 for Neptune; seen from the Earth within 1.5 arc minutes of DE421 from 1950 to 2050
// (tests/unit/motion/planets_test.cpp). The theory holds from the year 1000 to 3000.
// Based on: J. L. Simon et al., "Numerical expressions for precession formulae and mean elements for the Moon and the
// planets", Astron. Astrophys. 282, 1994, as eraPlan94; the Earth of eraEpv00.
#pragma once
#include <string>

#include "motion/celestial.h"

namespace suite {

enum class Planet : uint8_t { mercury, venus, mars, jupiter, saturn, uranus, neptune };
inline constexpr size_t kPlanets = 7;
std::string name_of(Planet planet);

struct PlanetPlace {
  CatalogPlace place;            // as of a star that stands in the same direction: CelestialSphere does the rest
  Vec3 from_sun, from_observer;  // au, celestial axes, when the light left it
  // Sun-planet-observer, rad.
  double phase_angle() const;
};

// Light time to the observer is taken into account. tt: of the observation.
PlanetPlace planet_place(Planet planet, const CelestialSphere& sphere, JulianDate tt);

}  // namespace suite
