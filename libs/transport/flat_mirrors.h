// Flat smooth surfaces at rest, in which far points (stars) have images whose places on a focal plane are known:
// mirrors, calm water, panes. A path that leaves the scene after smooth surfaces alone knows by its line whether it
// looks along such an image: a line of sight, turned by one flat mirror at most, to which all else that it passed was
// parallel.
//
// Assumes: surfaces of mesh or exact planes and boxes without vertex normals and bump maps, at rest, whose normals have
// few directions in all (kMost); images in what is curved, moves or has more are left to chance, and so are those that
// two mirrors make.
#pragma once
#include <array>
#include <cmath>
#include <vector>

#include "surface/surface.h"

namespace suite {

class FlatMirrors {
 public:
  static constexpr size_t kMost = 8;
  // Keeps a reference to the tracer.
  FlatMirrors(const Tracer& tracer, const Optics& optics);

  // Whether a smooth surface is among them at all.
  bool any() const { return any_; }
  // Directions of their normals, of which no two are parallel, unit, ENU.
  const std::vector<Dir>& normals() const { return normals_; }
  // The image of a direction in the mirror of a normal.
  static Dir mirrored(Dir d, Dir normal) { return d - normal * (2 * dot(d, normal)); }
  // Whether a hit lies on one of them.
  bool has(const Hit& hit) const { return hit.object < flat_.size() && flat_[hit.object]; }

  // Of a path: begins its line of sight; takes it over a surface that it leaves towards `in` before path.direction is
  // turned, false where no image is known; and whether it still runs along the line.
  template <class Path>
  static void begin(Path& path) {
    path.line = line_of(path.direction), path.mirrored = false;
  }
  template <class Path>
  bool follow(Path& path, const Hit& hit, bool passed, bool dirac) const {
    if (!dirac) return false;
    if (passed) return true;
    if (path.mirrored || !has(hit)) return false;
    const Dir line{double{path.line[0]}, double{path.line[1]}, double{path.line[2]}};
    path.line = line_of(mirrored(line, hit.normal)), path.mirrored = true;
    return true;
  }
  template <class Path>
  static bool is_along(const Path& path) {
    const Vec3 off = path.direction - Vec3{double{path.line[0]}, double{path.line[1]}, double{path.line[2]}};
    return dot(off, off) < kAlong * kAlong;
  }
  static constexpr double kAlong = 1e-5;  // rad

 private:
  static std::array<float, 3> line_of(Dir d) {
    return {static_cast<float>(d.x), static_cast<float>(d.y), static_cast<float>(d.z)};
  }
  bool add(const Tracer& tracer, uint32_t number, const TracedObject& object);
  bool add_normal(Dir normal);
  std::vector<Dir> normals_;
  std::vector<uint8_t> flat_;  // by object
  bool any_ = false;
};

}  // namespace suite
