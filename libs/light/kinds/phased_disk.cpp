#include "light/kinds/phased_disk.h"

#include <algorithm>
#include <cmath>

namespace suite {

PhasedDisk::PhasedDisk(const FarDisk& disk, Dir to_sun, double even, const SpectralState& state)
    : disk_(disk, state),
      frame_(Frame::around(normalized(disk.direction))),
      sine_(std::sin(disk.half_angle)),
      to_sun_(frame_.to_local(to_sun)),
      even_(even) {
  if (disk_.collimated()) throw Error("a disk with a phase has a width", "a half angle above 0, or no phase");
  nature_ = disk_.nature();
  nature_.disk = false;  // not even
  // The phase function of the law, over a full disk's 1/2.
  const double half = std::acos(std::clamp(-to_sun_.z, -1.0, 1.0)) / 2;
  const double mean = half > 0 ? 0.5 * (1 - std::sin(half) * std::tan(half) * std::log(1 / std::tan(half / 2))) : 0.5;
  if (mean > 1e-9)
    scale_ = (1 - even_) / mean;
  else
    even_ = 1, scale_ = 0;
}

double PhasedDisk::lit(double x, double y) const {
  const double mu = std::sqrt(std::max(0.0, 1 - x * x - y * y)), mu0 = x * to_sun_.x + y * to_sun_.y - mu * to_sun_.z;
  return mu0 > 0 ? mu0 / (mu0 + mu) : 0;
}

double PhasedDisk::shade(Dir d) const {
  if (!disk_.contains(d)) return 0;
  const Vec3 p = frame_.to_local(d);
  return even_ + scale_ * lit(p.x / sine_, p.y / sine_);
}

std::optional<LightSample> PhasedDisk::sample(const LightReceiver& at, const std::array<double, 4>& u,
                                              double time) const {
  return sample_member(0, 1, at, {0, u[0], u[1], 0}, time);
}

std::optional<LightSample> PhasedDisk::sample_member(size_t member, double probability, const LightReceiver& at,
                                                     const std::array<double, 4>& u, double time) const {
  auto s = disk_.sample_member(member, probability, at, u, time);
  if (s) s->scale *= shade(s->direction);
  return s && s->scale > 0 ? s : std::nullopt;
}

std::optional<LightMet> PhasedDisk::met_outside(Dir direction, double time) const {
  auto met = disk_.met_outside(direction, time);
  if (met) met->scale *= shade(direction);
  return met;
}

}  // namespace suite
