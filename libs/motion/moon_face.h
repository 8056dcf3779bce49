// How the Moon turns its face to a place and to the Sun, and what eclipses cover of Moon and Sun.
//
// Assumes: Cassini's laws, without the physical libration (0.04 degrees); shadows of a spherical Earth, its air counted
// as 1 % of the Moon's parallax (Danjon). Based on: J. Meeus, "Astronomical Algorithms", 2nd edition 1998, chapters 53
// and 54; F. Espenak & J. Meeus, "Five millennium canon of lunar eclipses", NASA/TP-2009-214172.
#pragma once
#include "motion/celestial.h"

namespace suite {

// Selenographic places under the observer (the libration) and under the Sun, rad; longitudes -pi..pi, towards the
// Moon's east.
struct MoonFace {
  double latitude = 0, longitude = 0, sun_latitude = 0, sun_longitude = 0;
};
// to_moon: from the observer; to_sun: from the Moon; both unit, scene ENU, of the sphere's instant tt.
MoonFace moon_face(const CelestialSphere& sphere, JulianDate tt, Dir to_moon, Dir to_sun);

// Magnitudes of a lunar eclipse: the share of the Moon's diameter in the Earth's umbra and penumbra. Negative: beside.
struct LunarEclipse {
  double umbral = -1, penumbral = -1;
};
LunarEclipse lunar_eclipse(Instant instant);

// The share of the Sun's diameter that the Moon covers as seen from a place, m, scene ENU: the magnitude of a solar
// eclipse. Negative: beside; above 1: total.
double solar_eclipse(const SceneFrame& frame, Vec3 site, Instant instant, double dut1 = 0);

}  // namespace suite
