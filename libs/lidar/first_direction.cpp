#include "lidar/first_direction.h"

#include <algorithm>
#include <cmath>

namespace suite {

FirstDirection::FirstDirection(const LaserBeam& beam, const ReceiverField& field, double near, double far, InField in_field)
    : beam_(beam), field_(field), near_(near), far_(far) {
  constexpr double kBeside = 0.25;
  const bool narrow = beam.solid_angle() < field.solid_angle();
  field_share_ = !narrow ? 1 : in_field == InField::spared ? 0 : kBeside;
}

auto FirstDirection::spheres(const PulseAtWork& pulse) const -> Spheres {
  constexpr double kClear = 1.5;   // times the baseline: from within, a sphere is met once
  constexpr double kShift = 0.05;  // of the beam's width
  const double baseline = length(pulse.receiver.translation - pulse.laser.translation);
  Spheres s;
  const double least = std::max(kClear * baseline, 1e-6), near = std::max(near_, least), far = std::max(far_, near);
  s.radius[s.count++] = std::max(pulse.range, least);
  if (baseline * (1 / near - 1 / far) < kShift * beam_.width()) return s;
  for (size_t k = 0; k + 1 < kMostSpheres; ++k)
    s.radius[s.count++] = near * std::pow(far / near, static_cast<double>(k) / (kMostSpheres - 2));
  return s;
}

double FirstDirection::beam_density(const PulseAtWork& pulse, const Spheres& spheres, Dir direction) const {
  const Vec3 from = pulse.receiver.translation - pulse.laser.translation;
  double sum = 0;
  for (size_t k = 0; k < spheres.count; ++k) {
    const double R = spheres.radius[k], along = dot(from, direction);
    const double s = -along + std::sqrt(along * along + R * R - dot(from, from));
    const Dir seen = (from + direction * s) / R;
    const double cosine = dot(seen, direction);
    if (cosine > 0) sum += beam_.density(pulse.at_laser(seen), R) * s * s / (R * R * cosine);
  }
  return sum / static_cast<double>(spheres.count);
}

auto FirstDirection::draw(const PulseAtWork& pulse, size_t pixel, const std::array<double, 4>& u) const -> Drawn {
  Drawn d;
  const Spheres at = field_share_ < 1 ? spheres(pulse) : Spheres{};
  if (u[2] < field_share_) {
    d.direction = pulse.receiver.vector(field_.sample(pixel, {u[0], u[1]}));
  } else {
    const double which = (u[2] - field_share_) / (1 - field_share_) * static_cast<double>(at.count);
    const double R = at.radius[std::min(at.count - 1, static_cast<size_t>(which))];
    const Vec3 spot = pulse.laser.translation + pulse.laser.vector(beam_.sample({u[0], u[1]}, R)) * R;
    d.direction = normalized(spot - pulse.receiver.translation);
  }
  const Dir local = pulse.at_receiver(d.direction);
  const auto seen = field_.at(local);
  if (!seen || seen->pixel != pixel) return d;
  double density = field_share_ * field_.density(local);
  if (field_share_ < 1) density += (1 - field_share_) * beam_density(pulse, at, d.direction);
  if (density > 0) d.importance = seen->importance / density;
  return d;
}

}  // namespace suite
