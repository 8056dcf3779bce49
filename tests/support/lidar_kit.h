// A laser radar that stands still, and what it gets from a scene.
#pragma once
#include <memory>
#include <vector>

#include "lidar/trace.h"
#include "spectral/planck.h"
#include "tests/support/media_kit.h"

namespace suite::test {

// Pulses from one pose each; a receiver that moves with `velocity` (m/s) is elsewhere at reception.
struct StillTrain final : PulseTrain {
  uint64_t count = 1;
  ResponsePulse like;
  Vec3 velocity;
  double spacing = 1e-6;  // s
  uint64_t size() const override { return count; }
  std::optional<ResponsePulse> pulse(uint64_t i, double round_trip) const override {
    ResponsePulse p = like;
    p.time = spacing * static_cast<double>(i);
    p.emission.translation += velocity * p.time;
    p.reception = p.emission;
    p.reception.translation += velocity * round_trip;
    return p;
  }
};

// Straight down from (0, 0, height); 1 mJ at 1.064 um.
struct DownLidar : LidarInstrument {
  explicit DownLidar(double height, uint64_t count = 1) : train(std::make_shared<StillTrain>()) {
    train->count = count;
    train->like.wavelength_um = 1.064;
    train->like.energy = 1e-3;
    train->like.emission.translation = {0, 0, height};
    name = "down";
    pulses = train;
  }
  // Bins of `bin` s between two ranges (m, one way).
  void gate_of(double low, double high, double bin) {
    gate = {2 * low / kSpeedOfLight, 2 * high / kSpeedOfLight, bin};
    train->like.start = gate.start;
  }
  double photons() const {
    return train->like.energy * train->like.wavelength_um * 1e-6 / (kPlanckConstant * kSpeedOfLight);
  }
  std::shared_ptr<StillTrain> train;
};

// Keeps everything.
struct Received final : ResponseSink {
  ResponseHead head;
  std::vector<ResponseBlock> blocks;
  PulseReport report;
  void take(ResponseBlock&& block) override {
    if (const std::string wrong = fault_of(head, block); !wrong.empty()) throw Error("a block " + wrong);
    blocks.push_back(std::move(block));
  }
  // Over all rows: photons of a bin (0 = passive) and the variance of their sum.
  struct Sum {
    double photons = 0, variance = 0;
    double error() const { return std::sqrt(variance); }
  };
  template <class Wanted>
  Sum sum(const Wanted& wanted, int channel = -1) const {
    Sum all;
    const size_t channels = head.channels.size();
    for (const ResponseBlock& b : blocks)
      for (size_t e = 0; e < b.entries(); ++e) {
        if (!wanted(b.bin[e])) continue;
        for (size_t c = 0; c < channels; ++c)
          if (channel < 0 ? c < 2 : c == static_cast<size_t>(channel))
            all.photons += b.value[e * channels + c], all.variance += b.variance[e * channels + c];
      }
    return all;
  }
  Sum total(int channel = -1) const {
    return sum([](uint32_t bin) { return bin > 0; }, channel);
  }
  Sum bin(uint32_t wanted, int channel = -1) const {
    return sum([&](uint32_t b) { return b == wanted; }, channel);
  }
  // Mean of totals of rows, which are independent, and the standard error of the mean.
  RunningStats rows() const {
    RunningStats stats;
    for (const ResponseBlock& b : blocks)
      for (size_t r = 0; r < b.row_count(); ++r) {
        double sum = 0;
        for (uint64_t e = b.begin[r]; e < b.begin[r + 1]; ++e)
          if (b.bin[e] > 0) sum += b.value[e * head.channels.size()] + b.value[e * head.channels.size() + 1];
        stats.add(sum);
      }
    return stats;
  }
};

inline Received receive(const std::shared_ptr<const Scene>& scene, const LidarInstrument& instrument,
                        const SourceSpecs& passive = {}, const TraceOptions& options = {}) {
  Received r;
  r.head = response_head(*scene, instrument);
  r.report = trace_pulses(scene, passive, instrument, options, r);
  return r;
}

}  // namespace suite::test
