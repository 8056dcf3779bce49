// The quantities of air_correction.h as bands see them: means weighted by response and sunlight, so that sums over
// paths of light come out as for the bins.
//
// A product of two transmittances in a band is not the product of their means where gases absorb both ways: the four
// two-way products are kept beside the one-way means. The spherical albedo is weighted by the light that comes down
// and up again, which is what it acts on.
#pragma once
#include <array>
#include <span>
#include <string_view>
#include <vector>

#include "correction/air_correction.h"
#include "spectral/state.h"

namespace suite {

enum class LutKey {
  path_reflectance,  // pi L / (E0 mu0)
  spherical_albedo,
  down_direct,
  down_diffuse,
  up_direct,
  up_diffuse,
  emission_up,    // uW/(cm2 sr nm)
  emission_down,  // irradiance by pi, uW/(cm2 sr nm)
  direct_direct,  // down, up
  diffuse_direct,
  direct_diffuse,
  diffuse_diffuse,
};
inline constexpr size_t kLutKeys = 12;
// The names that ISOFIT 4 has for them, by LutKey.
inline constexpr std::array<std::string_view, kLutKeys> kLutNames{
    "rhoatm",        "sphalb",        "transm_down_dir",   "transm_down_dif",
    "transm_up_dir", "transm_up_dif", "thermal_upwelling", "thermal_downwelling",
    "dir-dir",       "dif-dir",       "dir-dif",           "dif-dif"};

// For each key the bands.
using LutValues = std::array<std::vector<double>, kLutKeys>;

// sun: irradiance of every bin, positive. Error: bands that the state does not cover.
LutValues lut_values(const CorrectionBins& bins, std::span<const float> sun, double sun_cosine,
                     const BandProjection& bands);

}  // namespace suite
