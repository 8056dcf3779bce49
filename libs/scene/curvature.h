// Earth curvature for scenes that were put together on a flat plane: everything is laid onto the WGS84 ellipsoid around
// the scene's origin by SceneFrame::curved (azimuthal equidistant; heights become heights above the ellipsoid).
//
// What is small is turned and moved as a whole; meshes that are too large for that get their vertices laid down one by
// one. Maps that are draped stay on the flat plane: points are put back onto it before a map is asked.
#pragma once
#include <string>
#include <utility>
#include <vector>

#include "motion/scene_frame.h"
#include "scene/scene.h"

namespace suite {

// The plane that a curved scene was put together on.
struct FlatPlane {
  SceneFrame frame;
  Affine3 to_scene;  // from ENU of the whole to ENU of the scene that the frame is of
  Vec3 point(Vec3 enu) const { return frame.flattened(to_scene.point(enu)); }
};

struct Curved {
  std::vector<std::string> rigid;                          // too large, but can only be turned as a whole
  std::vector<std::pair<std::string, size_t>> long_edges;  // mesh, and how many of its triangles
  size_t moving = 0;                                       // placements with tracks, left as they are
};

// Lays a flat scene down. tolerance_m (> 0): what a rigid placement may be off by, and an edge below the surface. Large
// groups are resolved into their parts, large meshes are copied for every placement; what is placed no more is dropped.
// Gives the draped maps their plane. Bounds are not touched. The scene has an origin, is checked and not curved yet.
// Error: something is further than 5000 km from the origin; more than 2^26 placements.
Curved curve_scene(Scene& scene, double tolerance_m);

// Gives the draped maps of a curved scene their plane; nothing for a flat scene.
void set_flat_plane(Scene& scene);

}  // namespace suite
