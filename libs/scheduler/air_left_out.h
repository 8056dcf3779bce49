// How much light the air's field leaves out where no places in the air are followed (media fill the scene): upper
// bounds of what single places of the ground send into the way of sight (adjacency) and of the shadows in it.
//
// With t the way's depth of scattering, what differs from the field's even ground is scattered into it once with a
// probability of 1 - exp(-t) at most, and no place sends more or less than the even ground by more than the contrast C
// of albedos times what a white ground would send under a Sun without air: |dL| <= (1 - exp(-t)) C E cos(z) / pi, in
// reflectance at the top of the air (1 - exp(-t)) C. What is scattered again makes it more by orders of t C. Shadows
// take at most the sunlight that is scattered on the way below the highest thing of the scene.
#pragma once
#include <optional>

#include "scheduler/scheduler.h"

namespace suite {

struct AirLeftOut {
  double um = 0;         // the shortest wavelength of the sensor, for which the rest holds
  double depth = 0;      // of scattering, along the middle line of sight down to the even ground, or out of the air
  double contrast = 0;   // the largest difference of a place's albedo from the even ground's
  double adjacency = 0;  // bound, reflectance at the top of the air
  double shadows = 0;    // bound, share of the sunlight that the way scatters once
};
// For the middle of the sensor's first capture; albedos as scene_albedo finds them, media passed by. air: resolved
// (resolve_sources). Nothing where that line of sight comes through no air that scatters.
std::optional<AirLeftOut> left_out_of_air(const AirSpec& air, const std::shared_ptr<const Scene>& scene,
                                          const Sensor& sensor);

}  // namespace suite
