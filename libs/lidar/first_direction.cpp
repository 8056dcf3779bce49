#include "lidar/first_direction.h"

#include <algorithm>
#include <cmath>

namespace suite {

FirstDirection::FirstDirection(const LaserBeam& beam, const ReceiverField& field, double near, double far,
                               InField in_field)
    : beam_(beam), field_(field), near_(near), far_(far) {
  constexpr double kBeside = 0.25;
  const bool narrow = beam.solid_angle() < field.solid_angle();
  field_share_ = !narrow ? 1 : in_field == InField::spared ? 0 : kBeside;
}

auto FirstDirection::planes(const PulseAtWork& pulse) const -> Planes {
  constexpr double kLeast = 1e-3;  // m
  constexpr double kShift = 0.05;  // of the beam's width
  const double baseline = length(pulse.receiver.translation - pulse.laser.translation);
  const double near = std::max(near_, kLeast), far = std::max(far_, near);
  Planes s;
  s.distance[s.count++] = std::max(pulse.range, kLeast);
  if (baseline * (1 / near - 1 / far) < kShift * beam_.width()) return s;
  for (size_t k = 0; k + 1 < kMostPlanes; ++k)
    s.distance[s.count++] = near * std::pow(far / near, static_cast<double>(k) / (kMostPlanes - 2));
  return s;
}

double FirstDirection::beam_density(const PulseAtWork& pulse, const Planes& planes, Dir direction) const {
  const Vec3 from = pulse.at_laser(pulse.receiver.translation - pulse.laser.translation);
  const Dir along = pulse.at_laser(direction);
  const double cosine = -along.z;
  if (!(cosine > 0)) return 0;
  double sum = 0;
  for (size_t k = 0; k < planes.count; ++k) {
    const double z = planes.distance[k], s = (z + from.z) / cosine;
    if (!(s > 0)) continue;
    const Vec3 spot = from + along * s;
    const double distance = length(spot), c = z / distance;
    sum += planes.share(k) * beam_.density(spot / distance, z) * c * c * c * s * s / (z * z * cosine);
  }
  return sum;
}

auto FirstDirection::draw(const PulseAtWork& pulse, size_t pixel, const std::array<double, 4>& u) const -> Drawn {
  Drawn d;
  const Planes at = field_share_ < 1 ? planes(pulse) : Planes{};
  if (u[2] < field_share_) {
    d.direction = pulse.receiver.vector(field_.sample(pixel, {u[0], u[1]}));
  } else {
    const double z = at.distance[at.choose((u[2] - field_share_) / (1 - field_share_))];
    const Dir in_beam = beam_.sample({u[0], u[1]}, z);
    const Vec3 spot = pulse.laser.point(in_beam * (z / -in_beam.z));
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
