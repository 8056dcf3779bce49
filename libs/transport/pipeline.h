// The radiometry pipeline (paper, section IV-A): each pass takes the next rays of a problem, or of a few beside each
// other, runs their paths (kernel.h), and adds the light that they have gathered to the problems' accumulators.
#pragma once
#include <memory>
#include <mutex>
#include <vector>

#include "estimate/accumulators.h"
#include "estimate/block.h"
#include "estimate/statistics.h"
#include "sensor/sensor.h"
#include "transport/channels.h"
#include "transport/flat_mirrors.h"
#include "transport/gloss_guide.h"
#include "transport/path_tracing.h"
#include "transport/truth/truth.h"

namespace suite {

class Pipeline {
 public:
  // Keeps references; all must outlive it. Error: options out of range, or the paper's estimator with media.
  Pipeline(const Surface& surface, const Optics& optics, const Environment& environment, const SpectralState& state,
           const BandProjection& projection, size_t reference_band, const TruthPlan& truth, const ChannelPlan& channels,
           const PipelineOptions& options);
  ~Pipeline();

  // sensor: of the truth and the channels. Continues each problem of a block, in the scrambles that the block has, from
  // what its accumulators hold up to the first to[problem] samples. Thread-safe for distinct blocks.
  void run(const Sensor& sensor, const Capture& capture, uint64_t capture_id, const Block& block,
           std::span<const uint32_t> to, Accumulators& sums, Slots slots, RunStatistics& statistics) const;
  // Whether paths of a capture may know of light that they miss (lost_light.h).
  bool may_miss(const Capture& capture) const;
  // The kernel that paths of this state run in: KernelChoice::name().
  const char* kernel() const { return choice_.name(); }
  // Whether samples may be negative: differences from an even ground (light/air_vertices.h).
  bool is_signed() const { return choice_.goes_back(); }
  // Whether paths carry polarisation.
  bool of_stokes() const { return channels_.of_stokes(); }
  // Whether paths leave points to sensors that ask for it (SensorRay::points_apart): media weaken points along flights.
  bool leaves_points() const { return !choice_.in_media(); }
  // Flat smooth surfaces in which paths leave them likewise; null = none.
  const FlatMirrors* mirrors() const { return mirrors_.get(); }
  const Tracer& tracer() const { return surface_.tracer(); }

 private:
  friend class BlockRun;
  struct Workspace;
  KernelContext context(const Environment& environment) const;
  // Error: what polarisation cannot be carried with.
  void check_stokes() const;
  std::unique_ptr<const GlossGuide> make_gloss() const;
  std::unique_ptr<const FlatMirrors> make_mirrors() const;
  std::unique_ptr<Workspace> borrow(const Capture& capture) const;

  const Surface& surface_;
  const Optics& optics_;
  const Environment& environment_;
  const SpectralState& state_;
  const BandProjection& projection_;
  size_t reference_band_;
  const TruthPlan& truth_;
  const ChannelPlan& channels_;
  PipelineOptions options_;
  KernelChoice choice_;
  std::unique_ptr<const GlossGuide> gloss_;  // null: nothing to be guided to
  std::unique_ptr<const FlatMirrors> mirrors_;
  // Working memory goes from block to block; as many as threads have been at work at once. All that are idle were made
  // for captures alike.
  mutable std::mutex mutex_;
  mutable std::vector<std::unique_ptr<Workspace>> idle_;
};

}  // namespace suite
