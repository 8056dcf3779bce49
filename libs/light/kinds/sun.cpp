#include "light/kinds/sun.h"

#include "math/warps.h"

namespace suite {

Sun::Sun(const SunSpec& spec, const SpectralState& state)
    : frame_(Frame::around(normalized(spec.direction))),
      spectrum_(state.sample(spec.irradiance)),
      irradiance_(spectrum_) {
  if (!(spec.half_angle >= 0 && spec.half_angle <= kPi / 2))
    throw Error(strf("the half angle %g rad of a disk is not between 0 and pi/2", spec.half_angle));
  if (spec.irradiance.min() < 0) throw Error("the irradiance of the sun or moon is negative");
  drop_ = one_minus_cos(spec.half_angle);
  density_ = drop_ > 0 ? 1 / (2 * kPi * drop_) : 0;
  // Radiance = irradiance / projected solid angle of the disk, pi sin^2.
  const double s = std::sin(spec.half_angle);
  if (drop_ > 0)
    for (float& v : spectrum_) v = static_cast<float>(v / (kPi * s * s));
  nature_.far = true;
  nature_.delta = collimated();
  nature_.disk = !collimated();
}

std::optional<LightSample> Sun::sample(const LightReceiver& at, const std::array<double, 4>& u, double time) const {
  return sample_member(0, 1, at, {0, u[0], u[1], 0}, time);
}

std::optional<LightSample> Sun::sample_member(size_t, double probability, const LightReceiver&,
                                              const std::array<double, 4>& u, double) const {
  const DirectionSample drawn = draw({u[1], u[2]});
  LightSample s;
  s.direction = drawn.direction;
  s.density = drawn.density * probability;
  s.scale = collimated() ? 1 / probability : 1;
  s.spectrum = spectrum();
  return s;
}

std::optional<LightMet> Sun::met_outside(Dir direction, double) const {
  if (!contains(direction)) return std::nullopt;
  return LightMet{1, spectrum(), density_};
}

DirectionSample Sun::draw(Vec2 u) const {
  if (drop_ == 0) return {frame_.z, 0};
  return {frame_.to_world(uniform_cone(u, drop_)), density_};
}

bool Sun::contains(Dir d) const {
  // 1 - cos of the angle as half the squared chord: no cancellation for a disk of milliradians.
  const Vec3 chord = d - frame_.z;
  return drop_ > 0 && 0.5 * dot(chord, chord) < drop_;
}

}  // namespace suite
