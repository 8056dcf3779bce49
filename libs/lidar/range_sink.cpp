#include "lidar/range_sink.h"

#include "spectral/planck.h"

namespace suite {

namespace {
constexpr double kMost = 1e30;
}

size_t RangeSink::tag(uint32_t p) const {
  if (!tags_ || lanes_[p].orders > 0 || !kernel_->record(p).met) return 0;
  const FirstMeeting& first = kernel_->first(p);
  if (const size_t channel = first.object < tags_->of_object.size() ? tags_->of_object[first.object] : 0)
    return channel;
  const uint32_t material = first.at ? first.at->material : kNone;
  return material < tags_->of_material.size() ? tags_->of_material[material] : 0;
}

void RangeSink::add_single(const Lane& lane, double arrival, double light, const float* spectrum) {
  const double photons = lane.active * light;
  if (!(photons >= 0 && photons < kMost)) {
    ++failures_;
    return;
  }
  lane.rows[receiver_ ? receiver_->pixel_of(spectrum) : 0].deposit(lane.scramble, arrival / kSpeedOfLight, photons,
                                                                   false);
}

void RangeSink::add(std::span<const Contribution> stage, SpectralThroughputs& throughputs) {
  for (const Contribution& c : stage) {
    const Lane& lane = lanes_[c.path];
    const bool active = c.light == end_;
    const double photons = active ? lane.active : lane.passive;
    const uint32_t order = lane.orders + c.order - c.smooth;
    if (!c.arrived() || photons == 0 || (active && order > orders_)) continue;
    double L = double{throughputs.throughput(c.path)[0]} * c.factor.scale * c.scale * photons;
    if (c.factor.spectrum) L *= double{c.factor.spectrum[0]};
    if (c.radiance) L *= double{c.radiance[0]};
    if (active && lane.first_elsewhere && kernel_->record(c.path).scattered_first) continue;
    if (active && lane.orders + c.order == 1) {
      if (!(c.events & by_medium))
        L *= lane.once_at_surface;
      else if (without_first_)
        continue;
    }
    if (!(L > -kMost && L < kMost) || (active && L < 0)) {
      ++failures_;
      continue;
    }
    const bool multiple = order > 1;
    RangeBins& row = lane.rows[active && receiver_ ? receiver_->pixel_of(c.radiance) : 0];
    if (active)
      row.deposit(lane.scramble, (lane.arrival + c.arrival) / kSpeedOfLight, L, multiple, tag(c.path));
    else
      row.passive(lane.scramble, L, multiple, tag(c.path));
  }
}

}  // namespace suite
