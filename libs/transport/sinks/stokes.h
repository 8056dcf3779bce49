// Sums contributions of paths that carry polarisation: the channels of intensity as radiance.h has them, and those of
// Q, U and V. The sums are those of a RadianceSink, which says where what goes.
#pragma once
#include "transport/sinks/radiance.h"
#include "transport/stokes_throughputs.h"

namespace suite {

class StokesSink final : public Sink<StokesThroughputs> {
 public:
  explicit StokesSink(RadianceSink& sums) : sums_(sums) {}
  void add(std::span<const Contribution> stage, StokesThroughputs& throughputs) override {
    for (const Contribution& given : stage) {
      Contribution c = given;
      c.unknown = throughputs.unknown(given);
      const size_t group = sums_.group(c);
      const bool lost = sums_.note(c);
      const ChannelPlan& channels = sums_.channels();
      const auto to = [&](size_t channel) { return static_cast<uint16_t>(sums_.target(group, channel, lost)); };
      StokesThroughputs::Targets targets{{to(0), kNone, kNone, kNone}};
      for (size_t channel = 1; channel < channels.size(); ++channel)
        if (const int component = channels.component(channel)) targets.of[component] = to(channel);
      throughputs.shine_stokes(given, c.scale, targets);
      for (size_t channel = 1; channel < channels.size(); ++channel) {
        if (channels.component(channel)) continue;
        if (const float share = channels.share(channel, c); share != 0)
          throughputs.shine_stokes(given, c.scale * share, {{to(channel), kNone, kNone, kNone}});
      }
    }
  }

 private:
  static constexpr uint16_t kNone = SpectralThroughputs::kNone;
  RadianceSink& sums_;
};

}  // namespace suite
