// The nodes of a stage, and the lights that they sample.
#pragma once
#include <optional>
#include <vector>

#include "light/light.h"
#include "transport/dimensions.h"

namespace suite {

// Mean cosine: matter that scatters more evenly has no use for directions drawn about that of a light.
inline constexpr double kForwardScattering = 0.5;

// A node of the stage: a path at an event.
struct PathNode {
  uint32_t path, slot;  // slot: of its hit
  bool event;           // scattered in a medium; else at a surface
};

// A light that nodes sample.
struct SampledLight {
  const Light* light;
  uint16_t index;
  LightNature nature;
  dimensions::Use use;
  int first_number;                 // of those of `use` that it takes
  std::optional<LightSample> only;  // the only sample there is of a collimated light
  bool beam = false;                // one that the air is given
};

// Lights by how paths come to them.
struct LightLists {
  std::vector<SampledLight> sampled;
  std::vector<SampledLight> outside, glowing;  // met by chance: by leaving the scene, at surfaces
};

}  // namespace suite
