#include <algorithm>

#include "math/warps.h"
#include "radiometry/sources/source.h"

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
}

DirectionSample Sun::sample(Vec2 u) const {
  if (drop_ == 0) return {frame_.z, 0};
  return {frame_.to_world(uniform_cone(u, drop_)), density_};
}

bool Sun::contains(Dir d) const {
  // 1 - cos of the angle as half the squared chord: no cancellation for a disk of milliradians.
  const Vec3 chord = d - frame_.z;
  return drop_ > 0 && 0.5 * dot(chord, chord) < drop_;
}

}  // namespace suite
