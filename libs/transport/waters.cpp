#include "transport/waters.h"

#include "optics/interface.h"

namespace suite {

Waters::Waters(const KernelContext& context) {
  if (!context.waters) return;
  for (const Material& m : context.surface.tracer().scene().materials) {
    kind_.push_back(m.surface.model == "sea" ? Kind::opaque : is_interface(m.surface) ? Kind::body : Kind::none);
  }
}

WaterSeen Waters::behind_surface(WaterSeen seen, uint32_t material, Dir normal, Dir out, Dir in) const {
  if (seen != WaterSeen::nothing && seen != WaterSeen::mirrored) return seen;
  const Kind kind = material == kNone ? Kind::none : kind_[material];
  const double from = dot(out, normal), to = dot(in, normal);
  if (kind == Kind::none || (kind == Kind::body && from < 0)) return WaterSeen::other;
  return from * to > 0 ? WaterSeen::mirrored : WaterSeen::entered;
}

WaterSeen Waters::behind_scattering(WaterSeen seen) {
  return seen == WaterSeen::nothing ? WaterSeen::other : seen == WaterSeen::mirrored ? WaterSeen::air : seen;
}

}  // namespace suite
