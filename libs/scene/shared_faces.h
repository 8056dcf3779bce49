// Bodies of media that overlap and have a face in common: where equal priorities leave open which of them holds.
#pragma once
#include <string>
#include <vector>

#include "scene/scene.h"

namespace suite {

struct SharedFace {
  std::string one, other;                // names of the bodies' surfaces; `one` is the smaller
  std::string medium_one, medium_other;  // behind them
  int priority = 0;                      // of both
  Vec3 at;                               // m, ENU: a place on the face
};

// Pairs of bodies with different named media of equal priority behind faces that lie in each other and face the same
// way: flat ones (boxes, meshes, caps) that overlap, and equal spheres. (Faces of bodies that touch face each other and
// leave nothing open.) time: s. At most 64 are told; hierarchies of more than 20,000 bodies of media, and pairs of more
// than 2e7 combinations of facets, are left out.
std::vector<SharedFace> shared_faces(const Scene& scene, double time);

}  // namespace suite
