// Places in the air where light is scattered: for what the field over an even ground leaves out, which is shadows that
// the scene throws into the air, and light that its single places send there (adjacency).
//
// With L the radiance in the scene and E that over the even ground, both obey the equation of transfer, so their
// difference D = L - E obeys it without what is the same in both, the air's emission and the beams from outside:
//   D(x, d) = integral along the ray up to its end of T(x, y) sum over directions of s(y) P(d, w) D(y, w)
//             + T(x, end) D(end, d),
// where D(end, d) = 0 when the ray leaves the scene, what the end sends minus E when it meets something, and, towards a
// beam's source, minus the beam when something stands in its way. Paths estimate D: they go to a place on a way that
// they have passed (draw), are scattered there as in any medium, and what they meet counts less what the even ground
// would have sent (beyond). Nothing is left to be added where the scene is the even ground; where it is not, D is exact
// in all orders, whatever ground E was made for, but for what is not asked: air whose scattering depth is less than
// kLeastDepth from the ground up at every knot (D / cos of the view is then less than 1e-4 of the brightest thing in
// the scene), and flights on which a path scatters less than 1e-5 of what it still carries
// (transport/techniques/air_residual.h; each less than 1e-5 of the same).
#pragma once
#include <array>
#include <optional>
#include <span>
#include <vector>

#include "air/column.h"
#include "light/atmosphere.h"
#include "optics/medium.h"

namespace suite {

class AirVertices {
 public:
  // ground: radiance that the even ground sends up, per bin. air: whose path() and skylight() are E along a way; it and
  // the column must outlive this.
  AirVertices(std::shared_ptr<const AirColumn> column, const SpectralState& state, const Atmosphere& air,
              std::vector<float> ground);
  // Whether anything is scattered that could be seen.
  static constexpr double kLeastDepth = 1e-4;
  bool any() const { return depth_ > kLeastDepth; }

  // The probabilities, one a knot, with which light is scattered on a way if nothing is absorbed, within 1e-6. length:
  // m, infinity allowed: then the way leaves the scene and ends at the even ground, if it comes there.
  using PerKnot = std::array<double, kMaxKnots>;
  PerKnot chances(Vec3 from, Dir d, double length) const;
  // The same in a fraction of the time, within 10 %: where a weight is wanted that need not be exact.
  PerKnot about_chances(Vec3 from, Dir d, double length) const;
  // A place on such a way, drawn as light of a knot would be scattered there (on a steep way: if layers were flat). u:
  // in [0, 1). Nothing where nothing scatters.
  struct Place {
    double distance;  // m
    size_t layer;
    PerKnot density;  // with which it would have been drawn for each knot, 1/m
  };
  std::optional<Place> draw(Vec3 from, Dir d, double length, double u, size_t knot) const;
  // What scatters in a layer: density 1.
  const BakedMedium& medium(size_t layer) const { return media_[layer]; }

  // A ray from a place in the air has met something after `length` (m, finite). T: of that way; more: E that the end is
  // to be less by, times -T. scratch: memory. Per bin.
  void beyond(Vec3 from, Dir d, double length, std::span<float> T, std::span<float> more,
              std::span<float> scratch) const;
  // How far it is to the even ground, m; infinite where the sky lies beyond.
  double to_ground(Vec3 from, Dir d) const;
  // E along a way that nothing of the scene ends. scratch: memory. Per bin.
  void even(Vec3 from, Dir d, std::span<float> scratch, std::span<float> radiance) const;

 private:
  double end_of(Vec3 from, Dir d, double length) const;
  // Scattering depth over a height, vertically.
  void depth_over(double height, double sign, PerKnot& sums) const;
  // The layer that a way does not leave; nothing: it may, or is long.
  std::optional<size_t> one_layer(Vec3 from, Dir d, double length) const;
  PerKnot chances_in(size_t layer, double length) const;
  std::optional<Place> draw_in(size_t layer, double length, double u, size_t knot) const;
  // A way all along which height rises or falls with nearly the same slope.
  struct Steep {
    double cosine, near_height, far_height;  // the cosine is positive
    PerKnot near, far;                       // depths over its ends
  };
  std::optional<Steep> steep(Vec3 from, Dir d, double length) const;
  std::optional<Place> draw_steep(const Steep& way, Vec3 from, Dir d, double length, double u, size_t knot) const;

  std::shared_ptr<const AirColumn> column_;
  const Atmosphere& air_;
  std::vector<float> ground_;
  double ground_height_;            // m, of the scene
  std::vector<BakedMedium> media_;  // one a layer
  size_t knots_;
  std::vector<PerKnot> scattering_;  // of each layer, 1/m
  std::vector<PerKnot> over_;        // depth over each level, vertically
  double depth_ = 0;                 // of all of them, vertically: the largest
};

}  // namespace suite
