#include "light/light.h"

#include "base/error.h"

namespace suite {

std::optional<LightMet> Light::met_outside(Dir, double) const { return std::nullopt; }

std::optional<LightMet> Light::met_surface(const LightReceiver&, const Hit&, uint32_t, Dir, double, double,
                                           double) const {
  return std::nullopt;
}

void Light::add(Dir, double, float, std::span<float>) const {
  throw Bug("a light that has a spectrum was asked to add it");
}

}  // namespace suite
