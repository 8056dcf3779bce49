// Instruments that collect light over a plane or a sphere: the path of such a ray starts at a node of its own, so that
// Sun, Moon, sky and lamps are asked for their light there as at every node, and what paths bring by chance is added.
//
// The node scatters like a perfect diffuser: w = cos / pi over the hemisphere of a plane, 1 / (4 pi) over the sphere.
// The radiance that it sends is irradiance / pi, or the flux through a small sphere's cross-section / (4 pi).
#pragma once
#include "sensor/sensor.h"
#include "surface/optics.h"

namespace suite {

// What the node of a receiver scatters with. Bug for SensorRay::Receiver::none.
BakedMaterial bake_receiver(SensorRay::Receiver kind, const SpectralState& state);

}  // namespace suite
