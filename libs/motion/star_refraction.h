// Refraction of starlight by the air between a star and an observer anywhere: on the ground, in an aircraft, in orbit.
// From orbit there is none upwards, and some 70 arc minutes along the limb, twice that of a horizon.
//
// Assumes: air that thins by exp(-height / H) over a sphere, H = 28.3 m/K times the temperature below, as ERFA's refco
// has it; bending along the straight line. Agrees with refco within 0.3 arc seconds above 20 degrees of height; within
// a few arc minutes at horizons, where the true course of temperature counts. The limb's spreading of light, which
// weakens stars behind the lower 30 km, is left out. Based on: eraRefco (ERFA); S. Chapman, "The absorption and
// dissociative or ionizing effect of monochromatic radiation in an atmosphere on a rotating earth", Proc. Phys. Soc.
// 43, 1931.
#pragma once
#include "motion/celestial.h"

namespace suite {

class StarRefraction {
 public:
  // air: at the origin of the frame.
  StarRefraction(const SceneFrame& frame, const SurfaceAir& air);

  // Angle (rad) by which light was bent that arrives at a height (m above the ellipsoid) from a zenith angle (rad) as
  // it is seen. Rays that meet the Earth count as those that graze it 1 km deep.
  double bending(double height_m, double zenith) const;
  // Where far light of an unrefracted direction is seen from a place (scene ENU, m; unit directions).
  Dir seen(Dir bare, Vec3 from) const;

 private:
  double refractivity(double height) const;  // less what curvature takes of it
  double seen_zenith(double height, double bare) const;
  SceneFrame frame_;
  double at_origin_, scale_;  // refractivity; m
};

}  // namespace suite
