// Air that other programs have computed, from tables of their runs: what lies between the sensors and what they see
// first, sunlight at the ground, and the sky over it. Nothing is extrapolated.
//
// Sunlight that the ground sends to a sensor goes through the air twice, and averages over bands must not be multiplied
// where the same lines dim both ways. Where the runs have transmittances of the whole way, sunlight at a place counts
// two_way / transmittance of the line of sight from the sensors to that place: dimmed by that line it becomes the runs'
// own two-way column. Light that comes to the place by other surfaces goes the same line at last, and counts likewise.
// The line is that from the middle of where the sensors are. Without such a column the Sun's irradiance at the ground
// is that of the runs, and the product is one of averages.
//
// Neglected: air between surfaces of the scene (but where it is the same everywhere), what single places of the ground
// send into the air (adjacency: the runs have one ground), air that differs from place to place, shadows in it, and
// lines that the sky's light shares with the line of sight.
// There are no layers in a table: scenes with media are refused (check_tabled_air).
#pragma once
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "light/atmosphere.h"
#include "light/sights.h"
#include "scene/scene.h"

namespace suite {

struct SourceSpecs;

struct TabledAirSpec {
  std::optional<SightTable> sights;  // transmittance and path radiance of sensors' lines of sight
  std::optional<SightTable> sky;     // radiance from above at the ground
  std::optional<SightTable> sun;     // irradiance of the direct Sun at the ground
  double within_angle = 0.5 * kDegree, within_height = 100;  // as of SightWorld
  std::optional<double> scene_height;                        // m above sea level; default: the scene's origin's, or 0
  double radius = 6371e3;                                    // m
  // Where the sensors' rays begin: only these look through the sights; empty = all rays do.
  struct Places {
    std::vector<Box3> boxes;  // of each sensor
    Vec3 middle;
  };
  std::optional<Places> from;
  std::vector<std::string> notes;  // what is told of the tables, a sentence each
  Where where = {};                // in the text

  SightWorld world(std::optional<Dir> towards_sun) const;
  // The runs have two-way transmittances of their sights.
  bool two_way() const;
  // Wavelengths that all tables have; the second is not the larger one where there are none.
  std::pair<double, double> covered_um() const;
};

// Error, located: what cannot be beside tables (media, a moon, a second sun), a sun whose light at the ground no run
// has, a sky that the runs do not have whole, and a sun where the runs have none. Resolved sources.
void check_tabled_air(const TabledAirSpec& air, const SourceSpecs& sources, const Scene& scene);
// The same of the line of sight of a sensor's ray, before it is known what it meets. Rays that rise are left to what
// they meet, unless the runs rise, too.
void check_sight(const TabledAirSpec& air, Vec3 from, Dir direction, std::optional<Dir> towards_sun);

// The Sun as the air needs to know it; the spectrum must live as long as the air.
struct TabledSun {
  Beam beam;
  double half_angle = 0;  // rad
};
// Error, located: a bin that the tables do not cover; of path() and transmittance(): a sight that they do not cover.
std::unique_ptr<const Atmosphere> make_tabled_air(const TabledAirSpec& spec, const SpectralState& state,
                                                  const std::optional<TabledSun>& sun);

// What the bins of a state are chosen for: transmittances at the corners of what the runs cover, radiances there and of
// the sky, the Sun's irradiance at the ground. The same ones for all states.
struct TabledRow {
  std::string name;
  std::vector<float> means;  // over the bins
};
struct TabledRows {
  std::vector<TabledRow> passes, light;
};
TabledRows tabled_rows(const TabledAirSpec& spec, const SpectralState& state);

}  // namespace suite
