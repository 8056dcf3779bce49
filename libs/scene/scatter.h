// Placements scattered over a surface: as many as a density asks for, anywhere on it with equal probability per area.
#pragma once
#include <optional>
#include <span>
#include <vector>

#include "scene/scene.h"

namespace suite {

struct ScatterRule {
  double density_per_m2 = 0;  // of surface area, > 0
  uint64_t seed = 1;
  double scale_low = 1, scale_high = 1;         // uniform between, > 0
  bool turn = true;                             // random heading
  std::optional<std::array<double, 4>> region;  // x0, y0, x1, y1: only points inside are kept
};

// Upright transforms in the frame of the meshes. The count is the expected one rounded by chance, so that densities
// below one per triangle come out right on average. Equal rules give equal results. At most 2^31 points: Error beyond.
std::vector<Affine3> scatter(std::span<const Mesh> meshes, const ScatterRule& rule);

}  // namespace suite
