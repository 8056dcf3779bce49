// Concentric spherical layers about the local centre of curvature, or flat ones, and straight lines through them.
//
// Points are scene ENU, m. Heights are z above the scene's zero: in a round world the distance from the sphere of
// height zero, m, positive outside. Layer l lies between heights l and l + 1; the lowest goes on below the first height
// (what is solid there is the scene's matter), nothing lies above the last. A flat world is the same with curvature 0,
// so that one arithmetic serves both and large radii go over into it.
//
// A ray crosses height h where k t^2 / 2 + s t + (h0 - h) (1 + k (h0 + h) / 2) = 0, with the curvature k = 1 / radius
// and h0, s the height and slope where it starts. Differences of heights stand in place of differences of squared
// radii, and of the two roots each is taken in its form without cancellation: what is found is exact for heights
// displaced by less than 4 nm, from anywhere, at any angle. Lines are straight: nothing here is refracted
// (refraction.h is).
// Based on: the half-b form of the quadratic, e.g. W. Kahan, "On the cost of floating-point computation without
// extra-precise arithmetic", 2004.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include "math/vec.h"

namespace suite {

class Shells {
 public:
  // heights: at least two, finite, ascending. Error when they are not.
  static Shells flat(std::vector<double> heights);
  // radius: of the sphere of height zero about `centre`, positive; the heights lie above -radius. Error as above. The
  // scene's zero has height 0 when centre = (0, 0, -radius).
  static Shells round(Vec3 centre, double radius, std::vector<double> heights);

  std::span<const double> heights() const { return heights_; }
  size_t layers() const { return heights_.size() - 1; }
  double curvature() const { return curvature_; }  // 1/m; 0 = flat
  double height(Vec3 p) const { return height_of(level(p - zero_)); }
  // The layer of a height, the upper one of two that touch there; layers() above the last height and on it.
  size_t layer_of(double height) const {
    if (height < heights_[1]) return 0;
    return static_cast<size_t>(std::upper_bound(heights_.begin() + 1, heights_.end(), height) - heights_.begin()) - 1;
  }
  // The local vertical. Undefined at the centre.
  Dir up(Vec3 p) const {
    const Vec3 q = p - zero_;
    return curvature_ == 0 ? Dir{0, 0, 1} : normalized(q * curvature_ + Vec3{0, 0, 1});
  }
  // A point at this height: the one on the vertical of the point of height zero above the centre.
  Vec3 above_zero(double height) const { return zero_ + Vec3{0, 0, height}; }
  // Cosine of a direction with the local vertical of a point, whose height is known. 0 at the centre, where every line
  // is at its lowest point.
  double cosine(Vec3 p, double height, Dir d) const {
    const double radius = 1 + curvature_ * height;
    return radius > 0 ? (d.z + curvature_ * dot(p - zero_, d)) / radius : 0;
  }
  // Least height on a straight segment; distance may be infinite (minus infinity where a flat world is left downwards).
  double lowest_height(Vec3 from, Dir d, double distance) const;
  // How far it is from a point in the air down to a height below it, m; infinite when a ray does not come there.
  double way_down_to(Vec3 from, Dir d, double height) const;
  // The same up to a height above it, on a ray that rises there.
  double way_up_to(Vec3 from, Dir d, double height) const;

  // A part of a segment within one layer. Height rises or falls all along it, as pieces end at the lowest point, too.
  struct Piece {
    size_t layer = 0;
    double near = 0, far = 0;                // along the ray, m; near < far
    double near_height = 0, far_height = 0;  // m
    double length = 0;                       // far - near, and more exactly that for rays that come from afar, m
  };
  // The segment of `distance` (m, infinity allowed) from a point in a unit direction: visit(const Piece&) for what lies
  // in layers, in order and without gaps. In a flat world a walk ends after kLongestLevel of air.
  template <class Visit>
  void walk(Vec3 from, Dir d, double distance, Visit&& visit) const;
  static constexpr double kLongestLevel = 1e9;  // m

 private:
  // A ray as heights see it; t from its origin.
  struct Line {
    double curvature, level, height, slope;
    double turn;  // where it is lowest; -infinity when it never was, infinity when it never will be

    double above(double h) const { return (height - h) * (1 + 0.5 * curvature * (height + h)); }
    // Of the crossings of a height: positive when there are two.
    double discriminant(double above_it) const { return slope * slope - 2 * curvature * above_it; }
    double on_the_way_down(double above_it, double root) const {
      return slope < 0 ? 2 * above_it / (root - slope) : -(slope + root) / curvature;
    }
    double on_the_way_up(double above_it, double root) const {
      return slope < 0 ? (root - slope) / curvature : -2 * above_it / (slope + root);
    }
    double height_at(double t) const { return height_of(level + t * (slope + 0.5 * curvature * t), curvature); }
    double lowest() const { return height_of(level - 0.5 * slope * slope / curvature, curvature); }
  };

  Shells(Vec3 zero, double curvature, std::vector<double> heights);
  // Half the difference of the squared radii over the radius: z where the world is flat.
  double level(Vec3 q) const { return q.z + 0.5 * curvature_ * dot(q, q); }
  static double height_of(double level, double curvature) {
    return 2 * level / (1 + std::sqrt(std::max(0.0, 1 + 2 * curvature * level)));
  }
  double height_of(double lev) const { return height_of(lev, curvature_); }
  Line line(Vec3 from, Dir d) const;
  // The same from a point `t` further on, rounded once, so that nothing of a far origin's coarse grid is left.
  Line line_from(Vec3 from, Dir d, double t) const {
    return line({std::fma(t, d.x, from.x), std::fma(t, d.y, from.y), std::fma(t, d.z, from.z)}, d);
  }
  // From above the last height: how far it is, not exactly, to the air or to the lowest point.
  double approach(const Line& l) const {
    const double above = l.above(heights_.back());
    return l.on_the_way_down(above, std::sqrt(std::max(0.0, l.discriminant(above))));
  }

  Vec3 zero_;  // the point of height zero above the centre
  double curvature_;
  std::vector<double> heights_;
};

inline Shells::Line Shells::line(Vec3 from, Dir d) const {
  const Vec3 q = from - zero_;
  const double lev = level(q), slope = d.z + curvature_ * dot(q, d), inf = std::numeric_limits<double>::infinity();
  return {curvature_, lev, height_of(lev), slope, curvature_ > 0 ? -slope / curvature_ : slope < 0 ? inf : -inf};
}

template <class Visit>
void Shells::walk(Vec3 from, Dir d, double distance, Visit&& visit) const {
  Line l = line(from, d);
  size_t layer = layer_of(l.height);
  double t = 0, shift = 0, near_height = l.height;
  if (layer == layers()) {
    // Enter from above, seen from a point close to the entrance, which may lie a little before or behind it.
    if (!(l.slope < 0)) return;
    shift = approach(l);
    if (!(shift < distance)) return;
    l = line_from(from, d, shift);
    const double above = l.above(heights_.back()), disc = l.discriminant(above);
    if (!(disc > 0) || (above > 0 && l.slope >= 0)) return;
    t = l.on_the_way_down(above, std::sqrt(disc));
    near_height = heights_[layer--];
  }
  const double end = std::min(distance - shift, curvature_ > 0 ? distance : t + kLongestLevel);
  bool down = t < l.turn;
  while (t < end) {
    double next, next_height;
    size_t next_layer = layer;
    if (down) {
      const double above = l.above(heights_[layer]), disc = l.discriminant(above);
      if (layer > 0 && disc > 0) {
        next = std::min(l.on_the_way_down(above, std::sqrt(disc)), l.turn);
        next_height = heights_[layer];
        --next_layer;
      } else {
        next = l.turn;
        next_height = curvature_ > 0 ? l.lowest() : -std::numeric_limits<double>::infinity();
        down = false;
      }
    } else {
      const double above = l.above(heights_[layer + 1]);
      next = l.on_the_way_up(above, std::sqrt(std::max(0.0, l.discriminant(above))));
      next_height = heights_[++next_layer];
    }
    const bool last = next >= end;
    if (last) {
      const double h = l.height_at(end);
      next = end;
      next_height = std::clamp(h, std::min(near_height, next_height), std::max(near_height, next_height));
    }
    // What is too short to have a length belongs to the next piece.
    if (const double near = shift + t, far = shift + next; far > near) {
      visit(Piece{layer, near, far, near_height, next_height, next - t});
      t = next;
      near_height = next_height;
    }
    if (last || next_layer == layers()) return;
    layer = next_layer;
  }
}

}  // namespace suite
