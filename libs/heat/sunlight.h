// What faces absorb of sunlight, as an operator that needs no new rays for other clouds: of the beam at each moment, of
// each part of the sky, of light from below the horizon; all reflections included.
//
// Method: the beam itself is followed by rays from points of the face (one for eight paths, two a block at least)
// towards the sun's disk at every moment, and where the answer changes to 1 s. Edges of shadows that pass evenly are
// told from these points (passing_edges.h); where points do not agree with that, more of them look at the sun, each
// once and at a time of its own, so many as the others scatter (sunlight_told_edges.cpp). What reaches the face by
// reflection comes along paths, each traced once. At every surface they meet they take what its element sends on
// through the whole day, told from when the sun is on that (told_sun.h), and are joined to the sun at moments of the
// day in turn to find what that lacks; where they leave, to the part of the sky. Between moments all is taken as
// straight lines with the same integrals. So the straight sun of all faces is found first.
//
// Beams that mirrors and smooth glass send on are followed from the sun (sunlight_mirrored.h).
//
// Assumes: one direction of the sun a moment for the whole scene; media are passed by.
#pragma once
#include <algorithm>
#include <array>
#include <functional>

#include "heat/compact_rows.h"
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
  std::vector<uint32_t> sunny() const;  // moments with the sun up
};

// Every eighth path of a block has a point that looks at the sun through the whole day, and one of each half at least.
inline uint32_t points_of_beam(const PathOptions& options) { return (options.paths + 15) / 16 * 2; }

// Parts of the sky: kSkyRings of equal solid angle, each in kSkyTurns.
inline constexpr uint32_t kSkyRings = 8, kSkyTurns = 16, kSkyPatches = kSkyRings * kSkyTurns;
uint32_t sky_patch(Dir d);  // above the horizon
// Even and linear in the middle of a patch, and quadratic: what blocks of paths find of the sky is kept for skies made
// of these, which is most of what skies are.
inline constexpr uint32_t kSkyShapes = 9;
std::array<float, kSkyShapes> sky_shapes(uint32_t patch);
inline constexpr double kSkyPatch = 2 * 3.14159265358979323846 / kSkyPatches;  // sr

struct Sunlight {
  static constexpr size_t kTogether = 32;  // faces that are traced together
  static constexpr uint32_t kParts = 24;   // of the time, for errors
  size_t moments = 0;
  uint32_t blocks = 0;
  PathRows rows;     // of faces the straight beam and, with shares of the moments, what is scattered in the first
                     // interval of rest; after them what is scattered in later ones
  CompactRows beam;  // [row][moment]: W/m2 absorbed for 1 W/m2 on a plane that faces the sun; a face has the sum
  CompactRows sky;   // [row][patch]: for 1 W/(m2 sr) of the patch
  std::vector<float> below;  // [row]: for 1 W/(m2 sr) of all below the horizon
  // Of blocks, halves' differences over 2 (path_numbers.h): the sum of their squares over that of the blocks' number is
  // the variance of what all blocks find together.
  CompactRows beam_of_block;  // [row, block][part]: as beam, sums over a part of the time
  // [face, contrast][part]: sums over the face's points of what they take of the beam less the mean, with random signs,
  // in steps of moments and scaled so that the mean square over the contrasts is the variance over the face.
  static constexpr uint32_t kContrasts = 3;
  CompactRows beam_spread;
  CompactRows sky_of_block;           // [row, block][shape]: of a sky of that shape
  std::vector<float> below_of_block;  // [row][block]
  std::vector<float> sun_hours;       // [face]: hours with the sun on it, mean over its points
  std::vector<uint8_t> lit;           // [face][moment with the sun up]: share of its points that the sun is on, of 255
  std::vector<float> absorptance;     // [face]: of even light of the sky's spectrum
  PathCount count;
  // [face][moment]: the part of beam that came first to what sends light on without scattering it; empty without such.
  CompactRows beam_by_mirrors;
  // Of these: places of surfaces at rest, surfaces without end, instances that move and are left out.
  struct Mirrored {
    size_t places = 0, endless = 0, moving = 0;
    double unfinished = 0;  // share of the light they send on that was left out after kMostReflections
  } mirrored;

  size_t faces() const { return sun_hours.size(); }
  // Room for what faces that see changes have in later intervals, when it is known which these are.
  void make_more();
  double rays() const { return static_cast<double>(count.rays); }
  double unfinished(uint32_t paths) const;  // of the light of so many paths of a face, what was left out
};

// Room for the sunlight of all faces, of which none is traced.
Sunlight untraced_sunlight(const Elements& elements, const HeatFaces& faces, const SunCourse& course,
                           const PathOptions& options);

// The straight sun of all faces comes first, then what is scattered, of faces and of rows after them.
enum class SunStage { straight, scattered };
inline constexpr int kSunStages = 2;
// joins: moments that a path is joined to at each surface.
inline constexpr uint32_t kSunJoins = 4;
// Traces that of some rows, as ranges of trace_exchange() are; straight of faces alone. In parallel, the same on any
// number of threads and in ranges of any size.
void trace_sunlight(const Tracer& tracer, const Elements& elements, const HeatFaces& faces, const HeatOptics& optics,
                    const SunCourse& course, const PathOptions& options, uint32_t joins, SunStage stage,
                    FaceRange range, Sunlight& out, const std::function<void(size_t)>& progress = {});
// Straight from the sun alone, without reflections: what the tracing functions find of it, from the same points. As
// Sunlight::beam; of faces that wanted() says, else 0.
std::vector<float> trace_straight(const Tracer& tracer, const Elements& elements, const HeatFaces& faces,
                                  const HeatOptics& optics, const SunCourse& course, const PathOptions& options,
                                  const std::function<bool(size_t face)>& wanted);
// Of all rows. progress: is told each face twice.
Sunlight trace_sunlight(const Tracer& tracer, const Elements& elements, const HeatFaces& faces,
                        const HeatOptics& optics, const SunCourse& course, const PathOptions& options,
                        uint32_t joins = kSunJoins, const std::function<void(size_t)>& progress = {});

}  // namespace suite
