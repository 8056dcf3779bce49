// The radiometry pipeline (paper, section IV-A): each pass takes a few rays of each of a few neighbouring problems,
// constructs their paths, and turns the paths into radiance, which is added to the problems' accumulators.
#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <mutex>
#include <span>
#include <vector>

#include "estimate/accumulators.h"
#include "estimate/block.h"
#include "estimate/statistics.h"
#include "radiometry/path.h"
#include "radiometry/sources/environment.h"
#include "radiometry/truth/truth.h"
#include "sensor/sensor.h"
#include "surface/surface.h"

namespace suite {

inline constexpr int kMaxNodes = 64;

// When a problem stops taking samples.
enum class StopRule : uint8_t {
  plan,    // at the count that was planned for it beforehand: unbiased
  change,  // the paper's: when one more sample changes the running mean at the reference band by less than a threshold.
           // It looks at the samples that it keeps and is biased low where rare events carry the light.
};

// How light is estimated.
enum class Method : uint8_t {
  standard,  // path_generator.h: every kind of source at every node, shared with the continuations (multiple importance
             // sampling), directions drawn at several wavelengths, low-discrepancy numbers, Russian roulette
  paper,     // Goodenough & Brown, sections III-C-2 and IV-A as written, for comparison: independent random numbers;
             // one explicit source a node out of sun, moon and all lamps, divided by its probability (the paper leaves
             // that open: here all have the same, and no lamp is left out for being far); what is asked explicitly does
             // not count when a continuation meets it; the sky is met by continuations only; directions are drawn at
  // the reference wavelength; paths end at max_nodes. Not for media. Its rule of stopping is StopRule::change.
};

struct PipelineOptions {
  uint64_t seed = 1;
  int max_nodes = 16;                // 1..kMaxNodes: consecutive scattering events
  uint32_t max_scatterings = 10000;  // consecutive scattering events of a path inside media, beside the nodes
  int roulette_after = 3;            // nodes before paths may end by chance
  bool explicit_sources = true;      // sample sun and sky at every node (off only for comparisons)
  Method method = Method::standard;
  int lamp_draws = kLampDraws;  // 1..kLampDraws: lamps asked at the first node of a path, where there are as many
  StopRule stop = StopRule::plan;
  uint32_t change_after = 20;  // StopRule::change: samples before the first test
  double change = 1e-3;        // StopRule::change: relative change that counts as convergence
  bool specialise = true;      // use kernels made for what a state really contains (off only for comparisons)
};

class Pipeline {
 public:
  // Keeps references; all must outlive it.
  Pipeline(const Surface& surface, const Optics& optics, const Environment& environment, const SpectralState& state,
           const BandProjection& projection, size_t reference_band, const TruthPlan& truth,
           const PipelineOptions& options);
  ~Pipeline();

  // Continues each problem of a block, in the scrambles that the block has, from what its accumulators hold up to the
  // first to[problem] samples. Thread-safe for distinct blocks.
  void run(const Sensor& sensor, const Capture& capture, uint64_t capture_id, const Block& block,
           std::span<const uint32_t> to, Accumulators& sums, Slots slots, RunStatistics& statistics) const;
  // Whether paths of a capture may know of light that they miss (lost_light.h).
  bool may_miss(const Capture& capture) const;
  // The kernel that paths of this state run in: "general", or "matte" (matte_kernel.h).
  const char* kernel() const { return matte_ ? "matte" : "general"; }

 private:
  const Surface& surface_;
  const Optics& optics_;
  const Environment& environment_;
  const SpectralState& state_;
  const BandProjection& projection_;
  size_t reference_band_;
  const TruthPlan& truth_;
  PipelineOptions options_;
  bool matte_ = false, loses_light_ = false;
  // Working memory goes from block to block; as many as threads have been at work at once.
  struct Workspace;
  class BlockRun;
  std::unique_ptr<Workspace> borrow() const;
  mutable std::mutex mutex_;
  mutable std::vector<std::unique_ptr<Workspace>> idle_;
};

}  // namespace suite
