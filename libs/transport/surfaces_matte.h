// Surfaces of states in which everything that a path can meet is an opaque Lambert surface at no temperature that
// shows: fields, canopies of opaque leaves, cities in the reflective range. The same sample points and decisions as
// surfaces_any.h at the same nodes, without models to be called, frames to be made, or knots; directions of a stage are
// drawn together.
#pragma once
#include <cmath>
#include <vector>

#include "light/light.h"
#include "transport/surfaces_any.h"

namespace suite {

class MatteSurfaces {
 public:
  static constexpr int kKnots = 1;
  static constexpr uint32_t kDense = 0;
  // Whether a state shows no others: only opaque Lambert materials without varying maps or blackbody radiance, one
  // knot.
  static bool serve(const Surface& surface, const Optics& optics);

  MatteSurfaces(const Surface& surface, const Optics& optics, size_t width, bool keep_first);

  // As of AnySurfaces. There are no receivers.
  bool meet(uint32_t p, const Hit& hit, Dir out, double time, bool first);
  bool meet_earth(uint32_t p, const Hit& hit, uint32_t material, bool first);
  uint32_t material(uint32_t p) const { return places_[p].material; }
  const Interaction& interaction(uint32_t p) const { return first_[p]; }  // of the first surface
  LightReceiver receiver(uint32_t p, const Hit& hit, Dir out) const {
    const Dir n = places_[p].shading;
    return {hit.position, dot(out, hit.normal) < 0 ? -n : n, false};
  }
  bool takes(uint32_t p, const Hit& hit, Dir out, Dir in) const {
    // Light reaches the side that is looked at, by the geometric and by the shading normal.
    const double to_light = dot(in, places_[p].shading), in_side = dot(in, hit.normal);
    return in_side * dot(out, hit.normal) > 0 && in_side * to_light > 0 && to_light * dot(out, places_[p].shading) > 0;
  }
  Factor evaluate(uint32_t p, Dir, Dir in, std::span<float>) const {
    return {static_cast<float>(std::fabs(dot(in, places_[p].shading)) / kPi), places_[p].rho};
  }
  void densities(uint32_t p, Dir, Dir in, std::span<float> density) const {
    density[0] = static_cast<float>(std::fabs(dot(in, places_[p].shading)) / kPi);
  }
  bool needs_lobe(uint32_t) const { return false; }
  void prepare(size_t i, Vec2 u) { x_[i] = u.x, y_[i] = u.y; }
  void prepare_all(size_t n);
  bool sample(size_t i, uint32_t p, const Hit& hit, Dir out, Vec2, double, int, std::span<float>,
              Continuation& on) const;

 private:
  struct Place {
    Dir shading;
    const float* rho;
    uint32_t material;
  };
  void keep(uint32_t p, const Hit& hit);

  const Surface& surface_;
  const Optics& optics_;
  const bool keep_first_;
  const std::span<const Mesh> meshes_;
  std::vector<const float*> rho_;  // by material; null = nothing scatters
  std::vector<Place> places_;
  std::vector<Interaction> first_;
  std::vector<double> x_, y_, z_;  // by node of the stage: the points of the continuations, then their directions
  Interaction interaction_;
};

// Parts of the inner loop, so that they stand in it.

inline bool MatteSurfaces::meet(uint32_t p, const Hit& hit, Dir out, double time, bool first) {
  Place& place = places_[p];
  const TracedObject object = surface_.tracer().object(hit.object);
  if (object.mesh != kNone && meshes_[object.mesh].normals.empty()) {
    place.material = surface_.material(object, hit);
    place.shading = hit.normal;
  } else {
    surface_.interact(hit, out, interaction_, time);
    place.material = interaction_.material;
    place.shading = interaction_.frame.z;
  }
  if (first && keep_first_) keep(p, hit);
  place.rho = place.material == kNone ? nullptr : rho_[place.material];
  return place.rho;
}

inline bool MatteSurfaces::sample(size_t i, uint32_t p, const Hit& hit, Dir out, Vec2, double, int, std::span<float>,
                                  Continuation& on) const {
  const Place& place = places_[p];
  const double side = dot(out, place.shading);
  Dir in{x_[i], y_[i], z_[i]};
  if (side == 0 || !(in.z > 0)) return false;
  on.density[0] = static_cast<float>(in.z / kPi);
  on.weight = {on.density[0], place.rho};
  on.dirac = false;
  if (side < 0) in.z = -in.z;
  on.in = Frame::around(place.shading).to_world(in);
  return dot(on.in, hit.normal) * in.z > 0;  // else it would leak through the real surface
}

}  // namespace suite
