#include "lidar/range_sink.h"

#include <algorithm>

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

void RangeSink::analyse(std::span<const Analyser> analysers, size_t first_channel) {
  analysers_ = analysers;
  for (size_t k = 0; k < analysers.size(); ++k) parts_.push_back({first_channel + k, 0.5});
}

std::span<const RangeBins::Part> RangeSink::parts(const Stokes& seen) {
  constexpr size_t kComponent[] = {1, 2, 1, 2, 3, 3};
  constexpr int kSign[] = {1, 1, -1, -1, 1, -1};
  for (size_t k = 0; k < parts_.size(); ++k) {
    const auto a = static_cast<size_t>(analysers_[k]);
    const double along = seen[0] > 0 ? seen[kComponent[a]] / seen[0] : 0;
    parts_[k].share = 0.5 * (1 + kSign[a] * std::clamp(along, -1.0, 1.0));
  }
  return parts_;
}

void RangeSink::add_single(const Lane& lane, double arrival, double light, const float* spectrum, const Stokes& seen) {
  const double photons = lane.active * light * seen[0];
  if (!(photons >= 0 && photons < kMost)) {
    ++failures_;
    return;
  }
  photons_ += photons;
  lane.rows[receiver_ ? receiver_->pixel_of(spectrum) : 0].deposit(lane.scramble, arrival / kSpeedOfLight, photons,
                                                                   false, 0, parts(seen));
}

void RangeSink::add(const Contribution& c, SpectralThroughputs& throughputs, const Stokes& seen, double unknown) {
  const Lane& lane = lanes_[c.path];
  const bool active = c.light == end_;
  const double photons = active ? lane.active : lane.passive;
  const uint32_t order = lane.orders + c.order - c.smooth;
  if (!c.arrived() || photons == 0 || (active && order > orders_)) return;
  double L = double{throughputs.throughput(c.path)[0]} * c.factor.scale * c.scale * photons * seen[0];
  if (c.factor.spectrum) L *= double{c.factor.spectrum[0]};
  if (c.radiance) L *= double{c.radiance[0]};
  if (active && lane.first_elsewhere && kernel_->record(c.path).scattered_first) return;
  if (active && lane.orders + c.order == 1) {
    if (!(c.events & by_medium))
      L *= lane.once_at_surface;
    else if (without_first_)
      return;
  }
  if (!(L > -kMost && L < kMost) || (active && L < 0)) {
    ++failures_;
    return;
  }
  const bool multiple = order > 1;
  RangeBins& row = lane.rows[active && receiver_ ? receiver_->pixel_of(c.radiance) : 0];
  if (!active) return row.passive(lane.scramble, L, multiple, tag(c.path), parts(seen));
  photons_ += L, unknown_ += L * unknown;
  row.deposit(lane.scramble, (lane.arrival + c.arrival) / kSpeedOfLight, L, multiple, tag(c.path), parts(seen));
}

void StokesRangeSink::add(std::span<const Contribution> stage, StokesThroughputs& throughputs) {
  for (const Contribution& c : stage) {
    const bool active = laser_ && c.light == sums_.end();
    const Stokes light = active ? LaserEnd::stokes_of(c.radiance) : c.source ? *c.source : Stokes{1, 0, 0, 0};
    sums_.add(c, throughputs, throughputs.seen(c, 0, light), throughputs.unknown(c));
  }
}

}  // namespace suite
