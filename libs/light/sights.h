// Lines of sight as tables of other programs name them: what a segment of a ray is in the coordinates that the runs of
// a path table differ in, whether the runs cover it, and which place of the table it is.
//
// Heights are above sea level on a round Earth; lines are straight. The angle of a line of sight is that from the local
// vertical where it begins, as in the cards of LOWTRAN and MODTRAN (H1, ANGLE), and so is the Sun's. Above kTopOfAir
// nothing is left of the air: sights that begin above it, of a ray and of a run, begin where the run does. Azimuths
// count from the Sun's, 0 to pi: the air is alike on both sides of the Sun.
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "air/path_table.h"
#include "air/shells.h"
#include "math/vec.h"

namespace suite {

inline constexpr double kTopOfAir = 80e3;  // m; 1e-5 of the air's mass lies above (U.S. Standard Atmosphere 1976)

// Rad and m.
enum class SightAxis : uint8_t { view_zenith, range, observer_height, end_height, solar_zenith, relative_azimuth };
inline constexpr size_t kSightAxes = 6;

// One value a coordinate; empty = not known.
class Sight {
 public:
  std::optional<double>& operator[](SightAxis axis) { return values_[static_cast<size_t>(axis)]; }
  const std::optional<double>& operator[](SightAxis axis) const { return values_[static_cast<size_t>(axis)]; }

 private:
  std::array<std::optional<double>, kSightAxes> values_{};
};

// A path table, and what its runs are runs of.
struct SightTable {
  PathTable table;
  std::vector<SightAxis> axes;  // of the table, in its order
  Sight alike = {};             // what all runs have in common; empty: an axis, or the runs do not say
  double least_range = 0;       // of the runs, m, where the range is an axis
  bool everywhere = false;      // the air is the same at all places and in all directions: only axes count

  bool has(SightAxis axis) const;
  // What the runs have of a coordinate; nothing where they do not say.
  std::optional<std::pair<double, double>> covered(SightAxis axis) const;
};

// A sphere whose heights are those above sea level, of an Earth of a radius (m) under a scene whose z = 0 lies so high
// (m).
inline Shells sea_under(double scene_height, double radius) {
  return Shells::round({0, 0, -radius - scene_height}, radius, {0, kTopOfAir});
}

// How the scene lies under the air, and how far a run holds beside where it is.
struct SightWorld {
  Shells sea = sea_under(0, 6371e3);
  std::optional<Dir> sun;    // towards it
  double within_angle = 0;   // rad: angles that lie so near to those of the runs are theirs
  double within_height = 0;  // m: the same of heights
};

// The segment from a place in a unit direction. distance: m; infinite: to where a ray that falls comes to the height at
// which the runs end, else without an end.
Sight sight_of(const SightTable& runs, const SightWorld& world, Vec3 from, Dir direction, double distance);

// What the runs lack, and what would be right.
struct SightFault {
  std::string what, hint;
};
// Nothing when the runs cover a sight. ends: whether range and height of the end count.
std::optional<SightFault> uncovered(const SightTable& runs, const SightWorld& world, const Sight& sight,
                                    bool ends = true);
// The place of the table that is nearest to a sight; an unknown coordinate is the least.
std::vector<double> place_of(const SightTable& runs, const Sight& sight);

}  // namespace suite
