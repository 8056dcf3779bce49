// What faces absorb of sunlight, as an operator that needs no new rays for other clouds: of the beam at each moment, of
// each part of the sky, of light from below the horizon; all reflections included.
//
// Method: the beam itself is followed by rays from points of the face (one for four paths, one a block at least)
// towards the sun's disk at every moment, and where the answer changes to 10 s; what reaches the face by reflection
// comes along paths, each traced once, which are joined at every surface they meet to the sun at moments of the day in
// turn, and to the part of the sky where they leave. Between moments all is taken as straight lines with the same
// integrals.
//
// Beams that mirrors and smooth glass send on are met by paths that leave the scene from there, as if the sun were
// kWideSun wide: unbiased but for the angle.
//
// Assumes: one direction of the sun a moment for the whole scene; media are passed by.
#pragma once
#include <functional>

#include "heat/exchange_paths.h"

namespace suite {

// The sun through the time that is looked at, and the spectra of light, in shares of the bins of sunlight_state().
struct SunCourse {
  std::vector<double> moments;           // s, ascending, evenly
  std::function<Dir(double t)> towards;  // scene ENU
  double angular_radius = 0;             // rad
  std::vector<std::vector<float>> beam;  // by moment; sums to 1
  std::vector<float> sky;                // sums to 1
  bool up(double t) const { return towards(t).z > 0; }
};

inline constexpr double kWideSun = 2.5 * 3.14159265358979323846 / 180;  // rad, half of its angle

// Parts of the sky: kSkyRings of equal solid angle, each in kSkyTurns.
inline constexpr uint32_t kSkyRings = 8, kSkyTurns = 16, kSkyPatches = kSkyRings * kSkyTurns;
uint32_t sky_patch(Dir d);                                                     // above the horizon
inline constexpr double kSkyPatch = 2 * 3.14159265358979323846 / kSkyPatches;  // sr

struct Sunlight {
  static constexpr uint32_t kParts = 24;  // of the time, for errors
  size_t moments = 0;
  uint32_t blocks = 0;
  std::vector<float> beam;              // [face][moment]: W/m2 absorbed for 1 W/m2 on a plane that faces the sun
  std::vector<float> sky;               // [face][patch]: for 1 W/(m2 sr) of the patch
  std::vector<float> below;             // [face]: for 1 W/(m2 sr) of all below the horizon
  std::vector<float> beam_of_block;     // [face][block][part]: as beam, means over a part of the time
  std::vector<float> diffuse_of_block;  // [face][block]: for 1 W/(m2 sr) of the whole sky
  std::vector<float> below_of_block;    // [face][block]
  std::vector<float> sun_hours;         // [face]: hours with the sun on it, mean over its points
  std::vector<float> absorptance;       // [face]: of even light of the sky's spectrum
  double rays = 0;
  double unfinished = 0;  // of the paths' light, what was left out after kMostReflections
  bool mirrors = false;   // something in the scene sends beams on without scattering them

  size_t faces() const { return below.size(); }
};

// joins: moments that a path is joined to at each surface. In parallel over faces, the same on any number of threads.
Sunlight trace_sunlight(const Tracer& tracer, const Elements& elements, const HeatFaces& faces,
                        const HeatOptics& optics, const SunCourse& course, const PathOptions& options,
                        uint32_t joins = 4, const std::function<void(size_t)>& progress = {});

}  // namespace suite
