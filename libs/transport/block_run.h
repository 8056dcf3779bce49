// The problems of one block while they run.
#pragma once
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "transport/pipeline.h"
#include "transport/workspace.h"

namespace suite {

inline constexpr uint32_t kWaveWidth = 64;

class BlockRun {
 public:
  BlockRun(const Pipeline& pipeline, const Sensor& sensor, const Capture& capture, uint64_t capture_id,
           const Block& block, std::span<const uint32_t> to, Accumulators& sums, Slots slots, RunStatistics& statistics,
           Pipeline::Workspace& workspace);
  // Every problem takes its samples in order, and before the next one does: their rays run so close together that a
  // packet of eight costs the ray tracer little more than one, and its sums stay in the cache.
  void run();

 private:
  size_t slot_of(size_t i) const { return slots_ == Slots::by_place ? i : problems_[i]; }
  bool wants(size_t i, uint32_t sample) const;
  double reference_sum(size_t slot) const;
  void put(uint32_t i, uint32_t sample);
  void run_wave();
  std::pair<SampleStream, uint32_t> stream_of(const WaveLane& lane) const;
  void draw(uint32_t paths);
  void start(uint32_t p);
  Mueller sensor_matrix(const SensorRay& ray) const;
  bool stands_on_surface(size_t i);
  void take(uint32_t p);
  bool add(uint32_t p, size_t slot, int scramble);
  float lowest(size_t channel) const;
  static bool good(std::span<const float> light, float lowest);
  bool acceptable(uint32_t p, bool lost);
  void add_light(uint32_t p, size_t bin, bool lost, double* sums);
  void add_missing(uint32_t p, size_t slot, int scramble, size_t bin);

  const Pipeline& pipeline_;
  const Sensor& sensor_;
  const Capture& capture_;
  const Block block_;
  Accumulators& sums_;
  const Slots slots_;
  RunStatistics& statistics_;
  Pipeline::Workspace& workspace_;
  const bool watched_;                 // a rule looks at every sample
  const bool plain_;                   // one sum a band
  const float scale_;                  // that all samples of the capture have: the number of bins of time
  std::vector<size_t> problems_;       // by place in the block
  std::vector<uint32_t> next_, end_;   // samples of each problem
  std::vector<uint8_t> whole_;         // it wants all samples from next_ on
  std::vector<int8_t> on_surface_;     // its first sample starts there; -1 = not asked
  std::optional<Ray> clear_;           // the last one that was found to start on no surface
  std::optional<Dir> sun_;             // towards it, where there is one
  std::vector<uint64_t> keys_;         // of its sample streams
  std::vector<SampleStream> streams_;  // [problem][scramble]
};

}  // namespace suite
