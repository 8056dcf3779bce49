// Layers of the upper air that shine, seen from above and edge on: shells about the Earth's ellipsoid.
//
// Assumes: a layer shines evenly between two heights and weakens nothing; its shells are ellipsoids whose semi-axes are
// those of WGS84 plus a height (at most 30 m from true heights). Light grows with the way within a shell, over its
// thickness: at the zenith it is that of the thin layer of airglow.h, 1 / cosine of the slant elsewhere, and finite
// along the limb.
#pragma once
#include <span>
#include <vector>

#include "motion/scene_frame.h"

namespace suite {

class GlowShells {
 public:
  // heights: of the middles of layers, m.
  GlowShells(const SceneFrame& frame, std::span<const double> heights);
  // Whether a place (scene ENU) is so high that what shines, and the air, must be looked for along its rays: 60 km.
  bool is_below(Vec3 place) const;
  bool meets_earth(Vec3 from, Dir direction) const;
  // m of a ray's first `length` m within a layer over the layer's thickness, before and behind its lowest point.
  struct Share {
    double near = 0, far = 0;
  };
  Share share(size_t layer, Vec3 from, Dir direction, double length) const;
  // m, of a layer with its middle at a height: 10 km about 90 km, a third of the height from 200 km on.
  static double thickness(double height);

 private:
  std::vector<double> heights_;
  SceneFrame frame_;
};

}  // namespace suite
