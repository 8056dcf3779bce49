// Sums contributions to radiance: all of it, what was scattered or emitted once, and, kept apart, the same of light
// that is known to be missed. Of many suns each has sums of its own.
#pragma once
#include <limits>
#include <vector>

#include "transport/throughput.h"

namespace suite {

class RadianceSink final : public Sink<SpectralThroughputs> {
 public:
  // groups: 1, or the number of lights that are told apart by their index; single: Channel::single is wanted; lost:
  // light may be lost.
  RadianceSink(size_t width, size_t groups, bool single, bool lost)
      : groups_(groups), single_(single), lost_(lost), missed_(width, kNothing) {}

  // Sums of a path (SpectralThroughputs::light).
  size_t targets() const { return (lost_ ? 2 : 1) * (single_ ? 2 : 1) * groups_; }
  size_t target(size_t group, bool once, bool lost) const {
    return ((lost ? (single_ ? 2u : 1u) : 0u) + (once ? 1u : 0u)) * groups_ + group;
  }
  void begin(uint32_t p) { missed_[p] = kNothing; }
  // Of the light that a path has missed, the least chance of having met it; infinite where there is none.
  double missed(uint32_t p) const { return missed_[p]; }
  static constexpr double kNothing = std::numeric_limits<double>::infinity();

  void add(std::span<const Contribution> stage, SpectralThroughputs& throughputs) override {
    for (const Contribution& c : stage) {
      const size_t group = groups_ == 1 ? 0 : c.light;
      const bool lost = !c.arrived();
      if (lost) missed_[c.path] = std::min(missed_[c.path], double{c.missed});
      throughputs.shine(
          c.path, c.factor, c.scale, c.radiance, static_cast<uint16_t>(target(group, false, lost)),
          single_ && c.order <= 1 ? static_cast<uint16_t>(target(group, true, lost)) : SpectralThroughputs::kNone);
    }
  }

 private:
  size_t groups_;
  bool single_, lost_;
  std::vector<double> missed_;
};

}  // namespace suite
