#include "lidar/pulse_train.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace suite {

Quat rotation_from_down(Dir to) {
  const Dir down{0, 0, -1};
  const Vec3 both = to + down, axis = cross(down, to);
  const double w = 0.5 * dot(both, both);  // 1 + cosine, with its digits near straight up
  if (w == 0) return {0, 0, 1, 0};         // straight up: about the forward axis
  return normalized(Quat{w, axis.x, axis.y, axis.z});
}

Pose LidarCarrier::at(double t) const {
  Pose pose = track->at(t);
  if (jitter) pose = pose * jitter->pose(t);
  for (const Attachment& a : chain) pose = a.at(t, pose, nullptr);
  return pose;
}

TimeSpan LidarCarrier::covered() const {
  TimeSpan all = track->covered();
  for (const Attachment& a : chain) {
    if (!a.mount) continue;
    const TimeSpan s = a.mount->covered();
    all.begin = std::max(all.begin, s.begin), all.end = std::min(all.end, s.end);
  }
  return all;
}

ClockedTrain::ClockedTrain(TrainSpec spec) : spec_(std::move(spec)) {
  channels_.resize(spec_.deflector->channels());
  std::iota(channels_.begin(), channels_.end(), size_t{0});
  std::ranges::stable_sort(channels_, {}, [&](size_t c) { return spec_.deflector->delay(c); });
  for (const PulseClock::Task& task : spec_.clock.tasks) {
    first_.push_back(size_);
    size_ += task.shots * spec_.clock.burst * channels_.size();
  }
}

double ClockedTrain::interval() const {
  const PulseClock& c = spec_.clock;
  double least = std::numeric_limits<double>::infinity();
  if (c.burst > 1) least = 1 / c.burst_rate;
  for (size_t k = 0; k < c.tasks.size(); ++k) {
    const double rest = 1 / c.rate - (c.burst > 1 ? (c.burst - 1) / c.burst_rate : 0);
    if (c.tasks[k].shots > 1) least = std::min(least, rest);
    // The last tick of a task and the first of the next one.
    if (k > 0) least = std::min(least, c.tasks[k].begin - (c.end(c.tasks[k - 1]) - rest));
  }
  return least;
}

TimeSpan ClockedTrain::span() const {
  const PulseClock& c = spec_.clock;
  const PulseClock::Task& last = c.tasks.back();
  return {c.tasks.front().begin, last.begin + shot_time(last.shots * c.burst * channels_.size() - 1).since};
}

ClockedTrain::Shot ClockedTrain::shot_time(uint64_t in_task) const {
  const PulseClock& c = spec_.clock;
  const size_t channel = channels_[in_task % channels_.size()];
  const uint64_t shot = in_task / channels_.size();
  // Ticks are counted from the task's start, so that times keep their digits.
  return {channel, static_cast<double>(shot / c.burst) / c.rate +
                       (c.burst > 1 ? static_cast<double>(shot % c.burst) / c.burst_rate : 0) +
                       spec_.deflector->delay(channel)};
}

uint64_t ClockedTrain::lit() const {
  uint64_t n = 0;
  for (const PulseClock::Task& task : spec_.clock.tasks)
    for (uint64_t k = 0; k < task.shots * spec_.clock.burst * channels_.size(); ++k) {
      const Shot shot = shot_time(k);
      n += spec_.deflector->direction(shot.since, shot.channel).has_value();
    }
  return n;
}

std::optional<ResponsePulse> ClockedTrain::pulse(uint64_t i, double round_trip) const {
  const size_t task = static_cast<size_t>(std::upper_bound(first_.begin(), first_.end(), i) - first_.begin()) - 1;
  const auto [channel, since] = shot_time(i - first_[task]);
  const std::optional<Dir> out = spec_.deflector->direction(since, channel);
  if (!out) return std::nullopt;
  const double time = spec_.clock.tasks[task].begin + since, back = time + round_trip;
  const Pose turned{rotation_from_down(*out), {}};
  Pose turned_back = turned;
  if (spec_.scan_lag)
    if (const auto in = spec_.deflector->direction(since + round_trip, channel))
      turned_back.rotation = rotation_from_down(*in);
  ResponsePulse p;
  p.time = time, p.wavelength_um = spec_.wavelength_um, p.energy = spec_.energy, p.start = spec_.start;
  p.emission = (spec_.laser ? *spec_.laser : spec_.carrier).at(time) * spec_.laser_place * turned;
  p.reception = spec_.carrier.at(back) * spec_.receiver_place;
  if (!spec_.laser) p.reception = p.reception * turned_back;
  return p;
}

}  // namespace suite
