// What surfaces do with sunlight and with thermal infrared, for the balance of heat: the scene's optics baked for the
// whole of both, and what of them had to be assumed.
//
// Sunlight goes in bins from 0.28 to 4 um, weighed by spectra that others give. Thermal infrared goes in eight bins
// that hold equal parts of a body's of 300 K, from end to end; within each the reflectance is that of its middle.
// Where curves end: beyond their red end the mean of 8 to 14 um is held (of what they have of it), below 8 um and in
// sunlight the value at the end. A material whose optics say nothing of one of both needs its `absorptance` or
// `emissivity`, and is then an even Lambert surface there.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "heat/heated_material.h"
#include "surface/optics.h"

namespace suite {

struct HeatOptics {
  std::shared_ptr<const Scene> materials, infrared_materials;  // without geometry: what they are baked from
  std::unique_ptr<const Optics> sun, glow;
  std::vector<HeatedMaterial> heated;  // by material; of the others as they come
  std::vector<bool> has_heat;          // by material
  struct Assumed {
    uint32_t material = kNone;
    double sunlight = 0, infrared = 0;  // shares of a sun's and of a 300 K body's spectrum beyond the curves
  };
  std::vector<Assumed> assumed;  // of those with any
};

inline constexpr double kGlowKelvin = 300;

// used: by material, what can be seen. Error, naming the material: no optics and no number in its place; an
// `emissivity` more than 0.05 off the optics where these cover 80 % of a 300 K body's spectrum (below that share the
// difference is told); parts of mixtures with a heat of their own. warn: is told differences.
HeatOptics heat_optics(const Scene& scene, const std::vector<bool>& used,
                       const std::function<void(const std::string&)>& warn);

// The bins, as states. Knots: four over the sunlight, every bin of the infrared.
SpectralState sunlight_state();
SpectralState infrared_state();

}  // namespace suite
