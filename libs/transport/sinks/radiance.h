// Sums contributions to radiance and the other channels of a result, and, kept apart, the same of light that is known
// to be missed. Of many suns each has sums of its own.
#pragma once
#include <limits>
#include <vector>

#include "transport/channels.h"
#include "transport/throughput.h"

namespace suite {

class RadianceSink final : public Sink<SpectralThroughputs> {
 public:
  // groups: 1, or the number of lights that are told apart by their index; lost: light may be lost.
  RadianceSink(size_t width, size_t groups, ChannelPlan channels, bool lost)
      : groups_(groups), channels_(std::move(channels)), lost_(lost), missed_(width, kNothing) {}

  // Sums of a path (SpectralThroughputs::light).
  size_t targets() const { return (lost_ ? 2 : 1) * channels_.size() * groups_; }
  size_t target(size_t group, size_t channel, bool lost) const {
    return ((lost ? channels_.size() : 0) + channel) * groups_ + group;
  }
  const ChannelPlan& channels() const { return channels_; }
  // Which light is told apart; whether it is lost, which is then noted.
  size_t group(const Contribution& c) const { return groups_ == 1 ? 0 : c.light; }
  bool note(const Contribution& c) {
    if (c.arrived()) return false;
    missed_[c.path] = std::min(missed_[c.path], double{c.missed});
    return true;
  }
  void begin(uint32_t p) { missed_[p] = kNothing; }
  // Of the light that a path has missed, the least chance of having met it; infinite where there is none.
  double missed(uint32_t p) const { return missed_[p]; }
  static constexpr double kNothing = std::numeric_limits<double>::infinity();

  void add(std::span<const Contribution> stage, SpectralThroughputs& throughputs) override {
    for (const Contribution& c : stage) {
      const size_t group = this->group(c);
      const bool lost = note(c);
      const auto to = [&](size_t channel) { return static_cast<uint16_t>(target(group, channel, lost)); };
      // What a channel takes whole goes there with the radiance; most results have one channel or two.
      size_t with = 1;
      while (with < channels_.size() && channels_.share(with, c) != 1) ++with;
      throughputs.shine(c.path, c.factor, c.scale, c.radiance, to(0),
                        with < channels_.size() ? to(with) : SpectralThroughputs::kNone);
      for (size_t channel = 1; channel < channels_.size(); ++channel)
        if (const float share = channel == with ? 0 : channels_.share(channel, c); share != 0)
          throughputs.shine(c.path, c.factor, c.scale * share, c.radiance, to(channel));
    }
  }

 private:
  size_t groups_;
  ChannelPlan channels_;
  bool lost_;
  std::vector<double> missed_;
};

}  // namespace suite
