#include "light/light.h"

#include "base/error.h"

namespace suite {

void Light::sample_all(const LightReceiver& at, std::span<const std::array<double, 4>> u, double time,
                       std::span<std::optional<LightSample>> drawn) const {
  for (size_t k = 0; k < u.size(); ++k) drawn[k] = sample(at, u[k], time);
}

std::optional<Vec3> Light::point_of(size_t, double) const { return std::nullopt; }

std::optional<LightMet> Light::met_outside(Dir, double) const { return std::nullopt; }

std::optional<LightPlace> Light::draw_place(const LightReceiver&, const std::array<double, 4>&, double) const {
  return std::nullopt;
}

std::optional<LightMet> Light::met_surface(const LightReceiver&, const Hit&, uint32_t, Dir, double, double,
                                           double) const {
  return std::nullopt;
}

Stokes Light::stokes(uint32_t, Dir, double) const {
  SUITE_CHECK(!"a light that is not polarised");
  return {1, 0, 0, 0};
}
void Light::add(Dir, double, float, std::span<float>) const {
  throw Bug("a light that has a spectrum was asked to add it");
}

}  // namespace suite
