// Real air as it is asked for: a profile, its gases, what floats in it, and how its light is followed.
#pragma once
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "air/aerosol_profile.h"
#include "air/gases.h"
#include "air/particles.h"
#include "air/profile.h"
#include "spectral/curve.h"

namespace suite {

enum class AirScattering {
  single,   // once, along every segment
  diffuse,  // and the rest from a field solved once for an even ground
  traced,   // every time, by paths that are scattered in the air as in any medium: the reference for the others
};

struct AirSpec {
  AirProfile profile;
  // What absorbs; null = no gas does.
  std::shared_ptr<const GasProvider> gases;
  GasReduction points;    // of an interval
  bool molecules = true;  // scatter

  // Aerosols: boundary layer of a kind, free troposphere and stratosphere above it.
  struct Aerosol {
    ParticleSpec boundary;
    AerosolProfile profile{23e3};
    bool one_kind = false;  // the boundary layer's kind at all heights
  };
  std::optional<Aerosol> aerosol;
  struct Cloud {
    ParticleSpec particles;    // water or ice, or a user's
    double base = 0, top = 0;  // m above sea level
    double content = 0;        // kg/m3 of water; where extinction is relative (particle_data.h), 1/m at 0.55 um
  };
  std::vector<Cloud> clouds;

  std::optional<double>
      scene_height;  // of the scene's z = 0 above sea level, m; default: from the scene's origin, or 0
  bool round = true;
  double radius = 6371e3;   // of curvature at sea level, m
  bool refraction = false;  // bends beams from outside about a round Earth
  AirScattering scattering = AirScattering::diffuse;
  int streams = 16;
  // Of the ground as the diffuse field sees it: even, at `ground_height` above sea level.
  Curve ground_albedo = Curve::constant(0.2);
  // Its albedo is found from the scene for each state (scheduler/scene_albedo.h): must be, or where there is one.
  bool ground_of_scene = false, ground_of_any_scene = false;
  double ground_temperature = 0;        // K; 0 = the air's at the ground
  bool adjacency = true;                // with the field: shadows in the air and light of single places are followed
  std::optional<double> ground_height;  // m; default: the scene's z = 0
  int closer = 1;                       // steps of the levels (air_levels) are divided by it
  std::vector<std::string> notes;       // what was not given and where it comes from, a sentence each
  Where where = {};                     // in the text

  double height_of_scene() const { return scene_height.value_or(0); }
  double height_of_ground() const { return ground_height.value_or(height_of_scene()); }
};

// The levels that bound its layers, ascending: from the ground, or below it from the lowest level of the profile, to
// its top; every 250 m up to 3 km, 500 m to 10 km, 1 km to 25 km, 2.5 km to 50 km, 10 km above; and where aerosols and
// clouds begin and end. Halving all steps (`closer`: 2) changes radiances from the ground up and from space down by
// less than 0.6 % (0.5 % but at 4.3 um; tests/physics/light/stratified_air_test.cpp). With refraction they are halved:
// beams that graze the ground change more within a layer (tests/physics/light/bent_beam_test.cpp).
std::vector<AirLevel> air_levels(const AirSpec& spec);

// Error, located: a profile that is none (check_profile), a ground outside of it, clouds of no thickness, values out of
// range, refraction about a flat Earth.
void check_air(const AirSpec& spec);

}  // namespace suite
