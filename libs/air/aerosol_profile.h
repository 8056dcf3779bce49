// How the extinction by aerosols at 0.55 um lies over height, and what visibility says of it.
//
// Based on: the profiles of LOWTRAN 7 (F. Kneizys and others, AFGL-TR-88-0177, 1988, section 3; E. Shettle & R. Fenn,
// AFGL-TR-79-0214, 1979), whose four regions carry one kind of particles each; H. Koschmieder 1924.
#pragma once
#include <string>

namespace suite {

// Extinction at 0.55 um by aerosols, 1/m, where one sees as far as this, m: contrast 0.02, less the molecules' 0.01159
// per km. Error: visibility not positive or beyond what clear air allows (337 km).
double visibility_extinction(double visibility);

// Height is above the ground, m: the whole profile follows the ground.
class AerosolProfile {
 public:
  enum class Season { spring_summer, fall_winter };
  // visibility: at the ground, m, 2 km .. 337 km (below 2 km: fog, uniform in the boundary layer with that extinction).
  explicit AerosolProfile(double visibility, Season season = Season::spring_summer);
  // Everything in one exponential: depth at 0.55 um and scale height, m. One region.
  static AerosolProfile exponential(double depth, double scale_height);
  // The same profile scaled to another depth at 0.55 um.
  AerosolProfile with_depth(double depth) const;

  // 1/m at 0.55 um. Logarithmic between the tabulated heights.
  double extinction(double height) const;
  // Vertical depth at 0.55 um between two heights; exact for extinction().
  double depth(double low, double high) const;
  double depth() const { return depth(0, 1e5); }
  // Kinds of particles by region: below 2 km the boundary layer's own, to 10 km free_troposphere, above it
  // stratosphere.
  enum class Region { boundary, free_troposphere, stratosphere };
  static Region region(double height);

 private:
  AerosolProfile() = default;
  static constexpr int kHeights = 33;
  double extinction_[kHeights] = {};  // at the tabulated heights, 1/m
  double scale_height_ = 0;           // 0: by the table
};

}  // namespace suite
