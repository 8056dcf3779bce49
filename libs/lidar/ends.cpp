#include "lidar/ends.h"

#include "math/instrument_frame.h"

namespace suite {

namespace {

// Towards a point, without its strength; nothing from the point itself.
std::optional<LightSample> towards(Vec3 end, Vec3 from) {
  LightSample s;
  s.end = end;
  s.distance = length(end - from);
  if (!(s.distance > 0)) return std::nullopt;
  s.direction = (end - from) / s.distance;
  return s;
}

}  // namespace

LidarEnd::LidarEnd(const PulsesAtWork& pulses) : pulses_(pulses) {
  nature_.delta = nature_.placed = nature_.moves = true;
}

std::optional<LightSample> LidarEnd::sample_member(size_t, double probability, const LightReceiver& at,
                                                   const std::array<double, 4>& u, double time) const {
  auto s = sample(at, u, time);
  if (s) s->scale /= probability;
  return s;
}

std::optional<LightPlace> LidarEnd::draw_place(const LightReceiver&, const std::array<double, 4>&, double time) const {
  const PulseAtWork* const pulse = pulses_.of(time);
  if (!pulse) return std::nullopt;
  return LightPlace{place(*pulse), true, 1, 0};
}

LaserEnd::LaserEnd(const LaserBeam& beam, const PulsesAtWork& pulses, size_t bins, const std::optional<Stokes>& stokes)
    : LidarEnd(pulses), beam_(beam), stokes_(stokes), ones_(bins, 1.0f) {
  SUITE_CHECK(!stokes || bins == 1);
}

std::optional<LightSample> LaserEnd::sample(const LightReceiver& at, const std::array<double, 4>&, double time) const {
  const PulseAtWork* const pulse = pulses_.of(time);
  auto s = pulse ? towards(place(*pulse), at.position) : std::nullopt;
  if (!s) return std::nullopt;
  s->scale = beam_.density(pulse->at_laser(-s->direction), s->distance) / (s->distance * s->distance);
  if (!(s->scale > 0)) return std::nullopt;
  s->spectrum = ones_.data();
  if (stokes_) {
    if (used_ == given_.size()) given_.emplace_back();
    Given& given = given_[used_++];
    const Dir way = -s->direction;
    given.stokes = frame_rotation(frame_about(way, pulse->laser.vector({1, 0, 0})), meridian_frame(way).e1) * *stokes_;
    s->spectrum = &given.one;
  }
  return s;
}

ReceiverEnd::ReceiverEnd(const ReceiverField& field, const PulsesAtWork& pulses, size_t bins)
    : LidarEnd(pulses), field_(field), bins_(bins), ones_(field.pixels() * bins, 1.0f) {}

std::optional<LightSample> ReceiverEnd::sample(const LightReceiver& at, const std::array<double, 4>&,
                                               double time) const {
  const PulseAtWork* const pulse = pulses_.of(time);
  auto s = pulse ? towards(place(*pulse), at.position) : std::nullopt;
  if (!s) return std::nullopt;
  const auto seen = field_.at(pulse->at_receiver(-s->direction));
  if (!seen || !(seen->importance > 0)) return std::nullopt;
  s->scale = seen->importance / (s->distance * s->distance);
  s->spectrum = &ones_[seen->pixel * bins_];
  return s;
}

}  // namespace suite
