// How deep in the air a place lies for a beam from far outside: the Sun's or the Moon's, at any height and any angle to
// the local vertical, below the horizon of the plane as well.
//
// Layers are homogeneous and the source is a point. The beam is straight, or bent where a refractivity is given: with n
// linear in a layer, a bent ray is a straight one in a world whose radii are n r, and whose layers are as much denser
// as they are thinner there (from ds = d(n r) / cos(theta) / (n + r n')), so that one table serves both. Directions are
// the true ones, as without air; what is seen is found from the bending, a depth like the others. Scattering
// angles are not bent (less than a degree).
//
// Within the layer of a place the way is exact; from its upper boundary on, the depth is interpolated by cubics over
// the beam's angle there. A beam that comes from below the local horizon is twice the way from its lowest point to the
// outside less the way up from its place, and depths from lowest points are tabulated over their height. Depths agree
// with the exact sums to 2e-5 of themselves and transmittances to 2e-6 with the default number of nodes (seen over 1e5
// places in molecules, haze, a thin cloud and ozone; tests/unit/air/beam_table_test.cpp). A straight beam has 11 % too
// much air at 90 degrees from the ground, and 18 % at 92 degrees from 10 km.
// Based on: S. Chapman, "The absorption and dissociative or ionizing effect of monochromatic radiation in an
// atmosphere on a rotating Earth", Proc. Phys. Soc. 43, 1931, in layers; L. H. Auer, E. M. Standish, "Astronomical
// refraction: computational method for all zenith angles", Astron. J. 119, 2000.
#pragma once
#include <array>
#include <optional>
#include <span>
#include <vector>

#include "air/shells.h"

namespace suite {

// Depth of the straight line from a place outwards, per bin, by summing up: extinction[layer * bins + bin], 1/m. False
// when it meets the sphere of the height `ground` (m), in the shadow of the Earth; in a flat world, when the direction
// does not rise. depth is then untouched.
bool beam_depth(const Shells& shells, double ground, std::span<const float> extinction, Vec3 from, Dir to_source,
                std::span<double> depth);

class BeamTable {
 public:
  // extinction[layer * bins + bin], 1/m; ground: height of the sphere that casts the Earth's shadow, m. refractivity: n
  // - 1 at each height of the shells, or nothing for straight beams (and in a flat world). nodes: over the angle at
  // each boundary and over each layer of lowest points, 4 at least. Bytes: 4 per bin, node and layer, twice. Error: a
  // refractivity that falls so fast that it would lead light around the Earth.
  BeamTable(const Shells& shells, double ground, std::span<const float> extinction, size_t bins,
            std::span<const double> refractivity = {}, size_t nodes = 64);

  // Depth per bin of the beam at a height, m; cosine: of the angle between the local vertical there and the true
  // direction to the source. False: in the shadow of the Earth, depth is untouched.
  bool depth(double height, double cosine, std::span<float> depth) const;
  // The same for what the air scatters: bent rays lie further apart than outside, and what the irradiance across the
  // beam loses by it is part of the depth. With a and t the angles at which the source is seen and stands, it is
  // sin(a) da / (sin(t) dt) of that outside (as radiance is kept and n - 1 left out), the slope over 0.2 degrees.
  bool spread_depth(double height, double cosine, std::span<float> depth) const;
  // The cosine of the angle at which the source is seen; nothing in the shadow of the Earth.
  std::optional<double> seen(double height, double cosine) const;
  size_t bytes() const { return 4 * (up_.size() + low_.size() + extinction_.size()); }

 private:
  // Bins first to first + depth.size(); the last of all is the bending.
  struct Part {
    size_t first;
    std::span<float> depth;
  };
  // Of a direction in the world of straight rays.
  bool straight_depth(double height, double cosine, Part part) const;
  double bending(double height, double zenith) const;
  double horizon(double height) const;
  bool bent_depth(double height, double cosine, bool spread, std::span<float> depth) const;
  double straightened(double height) const;
  void tabulate();
  std::optional<double> seen_from(double height, double cosine) const;
  // The depth upwards, cosine not negative; times `factor`, added.
  void add_up(double height, double cosine, float factor, Part part) const;
  struct Nodes {
    const float* first;  // of four that follow each other
    std::array<float, 4> weight;
  };
  Nodes nodes_at(const std::vector<float>& table, size_t row, double x, double factor) const;
  void add_nodes(const Nodes& nodes, Part part) const;
  // From a lowest point to the outside, added.
  void add_lowest(double height, float factor, Part part) const;
  // The lower end of the lowest points within a layer.
  double bottom(size_t layer) const { return layer == 0 ? ground_ : std::max(shells_.heights()[layer], ground_); }

  std::vector<double> heights_;  // true ones
  Shells shells_;                // where rays are straight
  bool bent_;
  double ground_;  // there
  size_t bins_, nodes_;
  // Of each boundary the cosine within which the curvature of the layer above shows, and its place among the nodes.
  std::vector<double> scale_, stretch_;
  std::vector<float> extinction_;
  std::vector<float> up_;   // [boundary][node][bin]: depth times hypot(cosine, scale)
  std::vector<float> low_;  // [layer][node][bin]
};

}  // namespace suite
