// Whether light from a direction comes through the only refracting surface of a scene to a place behind it in one way
// at most, so that nobody needs to look for more: flat water, and calm waves.
//
// Let all normals of the surface, true and interpolated, lie within an angle a of an axis, and let it lie once over a
// plane across the axis. Light from more than 3 a above that plane has come straight to where it passes the surface: a
// ray that meets it from outside, or was mirrored there, runs less than a, or 3 a, above the plane; and one that has
// gone in leaves no more, if it is bent to more than a below the plane (index). Behind the surface the light that
// passes it at x lands, d below, at x + d T(n(x)), T the tangent of the bent direction; if that displacement changes by
// less than the way in x (Lipschitz), no two places x send light to one place.
#pragma once
#include <algorithm>
#include <cmath>
#include <optional>

#include "surface/surface.h"

namespace suite {

class RefractingSheet {
 public:
  // Of an object of the tracer; nothing when it is no such surface, or not known to be one: it moves, is repeated, has
  // no vertex normals, or is of a kind other than a plane or a mesh.
  static std::optional<RefractingSheet> of(const Tracer& tracer, uint32_t number, const TracedObject& object);

  enum class Ways : uint8_t { none, one, unknown };
  // How many ways at most lead from a place to light of direction `to` (unit). index: behind the surface over in front.
  Ways ways(Vec3 place, Dir to, double index) const;
  // The same between two places, of a flat one: a ray that has passed it never meets it again, and of all ways from one
  // side to the other the refracted one is the shortest in time (Fermat), which there is one of.
  Ways ways_between(Vec3 one, Vec3 other) const;
  // m, below its nearest height, on either side; 0 between its heights.
  double deep(Vec3 place) const { return std::max({0.0, low_ - dot(place, axis_), dot(place, axis_) - high_}); }
  double steepness(Dir direction) const { return std::fabs(dot(direction, axis_)); }
  Dir axis() const { return axis_; }  // towards its front
  // In which direction flat water would have one leave; nothing at total reflection.
  std::optional<Dir> guess(Dir to, double index) const;

 private:
  bool add(const Mesh& mesh, const Affine3& place);
  bool lies_once(const Mesh& mesh, const Affine3& place) const;
  Dir axis_{0, 0, 1};          // front
  double low_ = 0, high_ = 0;  // along it, m
  double least_cosine_ = 1;    // of normals to it
  double turn_ = 0;            // of the normal, per m across the axis
};

}  // namespace suite
