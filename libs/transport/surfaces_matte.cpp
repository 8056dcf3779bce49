#include "transport/surfaces_matte.h"

#include <cmath>

#include "math/warps.h"

namespace suite {

namespace {

bool plain(const BakedMaterial& m) {
  return m.model->diffuse() && m.blackbody.empty() && !(m.maps && (m.maps->varies() || m.maps->bends()));
}

}  // namespace

bool MatteSurfaces::serve(const Surface& surface, const Optics& optics) {
  if (optics.state().knots.size() != 1) return false;
  for (uint32_t i = 0; i < surface.tracer().scene().materials.size(); ++i)
    if (const BakedMaterial& m = optics.material(i); m.model && !plain(m)) return false;
  return true;
}

MatteSurfaces::MatteSurfaces(const Surface& surface, const Optics& optics, size_t width, bool keep_first)
    : surface_(surface),
      optics_(optics),
      keep_first_(keep_first),
      meshes_(surface.tracer().scene().meshes),
      places_(width),
      first_(keep_first ? width : 0),
      x_((width + 3) / 4 * 4),
      y_(x_.size()),
      z_(x_.size()) {
  for (uint32_t i = 0; i < surface.tracer().scene().materials.size(); ++i) {
    const ScatterModel* model = optics.material(i).model;
    rho_.push_back(model ? model->diffuse() : nullptr);
  }
}

bool MatteSurfaces::meet_earth(uint32_t p, const Hit& hit, uint32_t material, bool first) {
  places_[p] = {hit.normal, rho_[material], material};
  if (first && keep_first_) keep(p, hit);
  return rho_[material];
}

// What truth looks at.
void MatteSurfaces::keep(uint32_t p, const Hit& hit) {
  Interaction& at = first_[p];
  const uint32_t material = places_[p].material;
  at.position = hit.position;
  at.geometric_normal = hit.normal;
  at.frame = Frame::around(places_[p].shading);
  at.material = material;
  at.baked = material == kNone ? nullptr : &optics_.material(material);
}

void MatteSurfaces::prepare_all(size_t n) { cosine_hemispheres(n, x_.data(), y_.data(), z_.data()); }

}  // namespace suite
