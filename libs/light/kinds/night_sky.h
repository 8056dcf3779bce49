// The natural night sky as a light: zodiacal light, airglow, starlight and the stars of a catalogue, by place and date.
#pragma once
#include "light/light_spec.h"
#include "light/night/night_map.h"

namespace suite {

struct NightSkyLightSpec : NightSkySpec {
  SourceTime time;                     // second 0
  std::optional<Geodetic> place = {};  // else the scene's origin
  bool in_view = true;                 // sensors that can put stars on their focal plane do (far_points.h)
};
LightSpecPtr make_light(NightSkyLightSpec spec);

// Illuminance of a level plane by the parts of a night sky, without the air, lx.
struct NightIlluminance {
  std::array<double, kNightParts> photopic{}, scotopic{};
};
NightIlluminance illuminance_of(const NightMap& map);

}  // namespace suite
