// Rays that smooth interfaces bend or reflect, with their derivatives: how far rays beside spread, of which light that
// has passed the interface is strong or weak.
//
// A ray carries the change of its place and direction with two parameters. Its way to a surface moves the place along
// the surface; Snell's law with the normal's turn there (surface/normal_turn.h) gives the new direction's change.
// Based on: H. Igehy, "Tracing ray differentials", SIGGRAPH 1999; Born & Wolf, section 1.5.
#pragma once
#include <array>
#include <optional>
#include <vector>

#include "surface/normal_turn.h"

namespace suite {

// Which materials of a state pass light as smooth interfaces, by Snell's law, and with which index at each knot. Those
// whose model differs from place to place by maps are none of them; bump and normal maps are allowed.
class SmoothInterfaces {
 public:
  SmoothInterfaces(const Scene& scene, const Optics& optics);
  bool any() const { return any_; }
  bool has(uint32_t material) const { return material != kNone && !index_[material].empty(); }
  // Index of refraction behind the surface over that in front of it.
  double index(uint32_t material, size_t knot) const { return index_[material][knot]; }
  // The lobe of the model that transmits or reflects; kNoLobe: it does not reflect.
  static constexpr int kNoLobe = -1;
  int lobe(uint32_t material, bool reflects) const { return lobe_[material][reflects]; }
  // Sets of knots, by their first one, that all of these materials bend alike; of every knot its set's first one.
  const std::vector<size_t>& set_of() const { return set_of_; }

 private:
  bool probe(const ScatterModel& model, uint32_t material, size_t knots);
  std::vector<std::vector<double>> index_;  // [material][knot]; empty = no smooth interface
  std::vector<std::array<int, 2>> lobe_;
  std::vector<size_t> set_of_;
  bool any_ = false;
};

struct BentRay {
  Vec3 origin;
  Dir direction;
  Vec3 d_origin[2], d_direction[2];  // m and rad per unit of each parameter
  // From a point, with the parameters along the axes x and y of `across` (z: the direction).
  static BentRay from(Vec3 origin, const Frame& across);
};

// Takes a ray through the smooth interface at `hit`, which it has met; on return it starts there, on the other side.
// at: of the hit, seen from -direction. index: behind over in front. turn: of the normal there. False, with the ray as
// it was, at total reflection and where the new direction would not lie behind the real surface.
bool bend(BentRay& ray, const Hit& hit, const Interaction& at, double index, const NormalTurn& turn);

// The same of a ray that the interface reflects. False where the new direction would lie behind the real surface.
bool reflect(BentRay& ray, const Hit& hit, const Interaction& at, const NormalTurn& turn);

// The direction in which light must leave the front or back of a plane interface of normal n, on the side of `in_side`,
// to go on along `beyond` behind it; nothing at total reflection. ratio: index on the side of `beyond` over that of the
// other side.
std::optional<Dir> unbent(Dir beyond, Dir n, double ratio);

}  // namespace suite
