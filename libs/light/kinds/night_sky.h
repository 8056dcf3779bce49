// The natural night sky as a light: zodiacal light, airglow, starlight and the stars of a catalogue, by place and date.
#pragma once
#include "light/light_rows.h"
#include "light/light_spec.h"
#include "light/night/night_map.h"
#include "light/night/satellites.h"

namespace suite {

struct NightSkyLightSpec : NightSkySpec {
  SourceTime time;                             // second 0
  std::optional<Geodetic> place = {};          // else the scene's origin
  std::optional<uint64_t> scintillation = {};  // seed; nothing: stars do not twinkle
  std::vector<SatelliteSpec> satellites = {};
  bool in_view = true;  // sensors that can put stars on their focal plane do (far_points.h)
};
LightSpecPtr make_light(NightSkyLightSpec spec);
// From text (night_sky_read.cpp). Located Error for anything wrong.
LightSpecPtr read_night_sky(const Params& p, const LightContext& context);

// Illuminance of a level plane by the parts of a night sky, without the air, lx.
struct NightIlluminance {
  std::array<double, kNightParts> photopic{}, scotopic{};
};
NightIlluminance illuminance_of(const NightMap& map);

}  // namespace suite
