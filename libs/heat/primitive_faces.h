// Exact surfaces as faces with coordinates that keep areas: what elements on them are cut from.
//
// Every face is the image of the unit square; equal areas of the square are equal areas of the face, but for sinusoids,
// whose areas are those of the plane under them times `stretch`.
#pragma once
#include <array>

#include "scene/scene.h"

namespace suite {

class PrimitiveFaces {
 public:
  // reach: low and high x and y (m, local) of surfaces without end, which are cut off there.
  PrimitiveFaces(const Primitive& primitive, const Box3& reach);

  size_t size() const { return areas_.size(); }
  double area(size_t face) const { return areas_[face]; }  // m2, local, as a mean over stretches
  // Lengths along a and b in the middle of a face, m: what cells are made square by.
  std::array<double, 2> lengths(size_t face) const { return lengths_[face]; }

  struct Point {
    Vec3 position, normal;  // m, local; outward or upward, unit
    Vec2 uv;                // as rays find it (scene/primitives.h)
    double stretch = 1;     // area over that of the plane under a sinusoid
  };
  Point point(size_t face, double a, double b) const;  // 0 <= a, b <= 1
  double most_stretch() const { return most_stretch_; }

  struct Place {
    size_t face = 0;
    double a = 0, b = 0;  // 0..1; beyond the reach of surfaces without end their nearest edge
  };
  Place place(Vec3 local) const;  // of a point of the surface, or next to it

 private:
  void add(double area, double along_a, double along_b);
  void add_sinusoid();
  double cone_radius(double z) const;
  Point on_cone(size_t face, double a, double b) const;
  Place of_cone(Vec3 p) const;

  PrimitiveKind kind_;
  std::vector<double> p_;  // parameters
  bool endless_ = false;
  Box3 reach_;
  std::vector<double> areas_;
  std::vector<std::array<double, 2>> lengths_;
  double most_stretch_ = 1;
};

}  // namespace suite
