// The Earth under the scene: the WGS84 ellipsoid, moved to a height, with one material, so that no ray leaves downwards
// into the sky and no sun shines through the ground. In double; not part of any tile.
//
// A place below the ellipsoid (a pit, a scene with a hole) has the Earth just under it instead.
// Based on: the quadratic with the cancellation-free root of Press et al., "Numerical Recipes", 5.6.
#pragma once
#include <optional>
#include <string>

#include "base/error.h"
#include "math/vec.h"
#include "motion/scene_frame.h"
#include "scene/scene.h"

namespace suite {

struct EarthSpec {
  std::string material;          // of the scene
  std::optional<double> height;  // of the surface above WGS84, m; default: 1 m below the lowest point of the scene
  Where where;
};

// The frame of a scene for what needs to know where it is on the Earth. what: for the error, "a sun by date". Error at
// `where` when the scene has no geodetic origin.
SceneFrame frame_of(const Scene& scene, const Where& where, const char* what);
class Earth {
 public:
  // height: above WGS84, m; material: index into Scene::materials.
  Earth(const SceneFrame& frame, double height, uint32_t material);
  struct Meeting {
    double distance;  // m
    Vec3 position;    // ENU
    Dir normal;       // ENU, up
  };
  // Where a ray enters the Earth within `reach` (m, infinity allowed).
  std::optional<Meeting> meet(Vec3 origin, Dir direction, double reach) const;
  static constexpr float step = 1e-3f;  // m, how far rays that leave the surface must start off it
  uint32_t material() const { return material_; }

 private:
  SceneFrame frame_;
  Vec3 scale_;  // 1 / semi-axes, 1/m
  uint32_t material_;
};

}  // namespace suite
