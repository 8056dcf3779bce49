#include "lidar/range_sink.h"

#include "spectral/planck.h"

namespace suite {

size_t RangeSink::tag(uint32_t p) const {
  if (channel_of_object_.empty() || !kernel_->record(p).met) return 0;
  const uint32_t object = kernel_->first(p).object;
  return object < channel_of_object_.size() ? channel_of_object_[object] : 0;
}

void RangeSink::add(std::span<const Contribution> stage, SpectralThroughputs& throughputs) {
  constexpr double kMost = 1e30;
  for (const Contribution& c : stage) {
    const Lane& lane = lanes_[c.path];
    const bool active = c.light == end_;
    const double photons = active ? lane.active : lane.passive;
    if (!c.arrived() || photons == 0 || (active && c.order > orders_)) continue;
    double L = double{throughputs.throughput(c.path)[0]} * c.factor.scale * c.scale * photons;
    if (c.factor.spectrum) L *= double{c.factor.spectrum[0]};
    if (c.radiance) L *= double{c.radiance[0]};
    if (!(L > -kMost && L < kMost) || (active && L < 0)) {
      ++failures_;
      continue;
    }
    const bool multiple = c.order > 1;
    RangeBins& row = lane.rows[active && receiver_ ? receiver_->pixel_of(c.radiance) : 0];
    if (active)
      row.deposit(lane.scramble, c.arrival / kSpeedOfLight, L, multiple, tag(c.path));
    else
      row.passive(lane.scramble, L, multiple, tag(c.path));
  }
}

}  // namespace suite
