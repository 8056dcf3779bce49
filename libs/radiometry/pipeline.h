// The radiometry pipeline (paper, section IV-A): as wide as a block of problems, each pass takes one ray of each problem,
// constructs its path, and turns the path into radiance, which is added to the problem's accumulators.
#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <mutex>
#include <span>
#include <vector>

#include "radiometry/sources/source.h"
#include "radiometry/truth/truth.h"
#include "sensor/sensor.h"
#include "surface/surface.h"

namespace suite {

inline constexpr int kMaxNodes = 64;

struct PipelineOptions {
  uint64_t seed = 1;
  int max_nodes = 16;            // 1..kMaxNodes: consecutive scattering events
  int roulette_after = 3;        // nodes before paths may end by chance
  bool explicit_sources = true;  // sample sun and sky at every node (off only for comparisons)
};

struct RunStatistics {
  uint64_t paths = 0, nodes = 0, failures = 0;
  double truncated = 0;          // sum over paths of the throughput cut at max_nodes
  TraceStatistics trace;
  uint64_t cycles = 0;           // all cycles spent in run(), all threads
  void merge(const RunStatistics& o);
};

// Accumulators of the problems of one capture. Sums are kept per independent scramble, which is where standard errors
// come from. bands: values a problem ([channel][bin][band]); truth_slots: doubles of truth a problem.
class Accumulators {
 public:
  Accumulators(size_t problems, size_t bands, int scrambles, size_t truth_slots = 0);
  // Number of scrambles for a count of paths: 4 up to 256, 8 above (both cover 95-97 % at the nominal 95 %).
  static int scrambles_for(uint32_t paths) { return paths > 256 ? 8 : 4; }

  int scrambles() const { return scrambles_; }
  size_t bands() const { return bands_; }
  size_t problems() const { return paths_.size(); }
  double* sums(size_t problem, int scramble) { return &sums_[(problem * static_cast<size_t>(scrambles_) + static_cast<size_t>(scramble)) * bands_]; }
  const double* sums(size_t problem, int scramble) const { return &sums_[(problem * static_cast<size_t>(scrambles_) + static_cast<size_t>(scramble)) * bands_]; }
  uint32_t paths(size_t problem) const { return paths_[problem]; }
  void set_paths(size_t problem, uint32_t n) { paths_[problem] = n; }
  uint32_t& failures(size_t problem) { return failures_[problem]; }
  uint32_t failures(size_t problem) const { return failures_[problem]; }
  float& truncated(size_t problem) { return truncated_[problem]; }
  float truncated(size_t problem) const { return truncated_[problem]; }
  // Largest single sample at the reference band, for the tail indicator.
  float& largest(size_t problem) { return largest_[problem]; }
  float largest(size_t problem) const { return largest_[problem]; }
  double* truth(size_t problem) { return truth_.data() + problem * truth_slots_; }
  const double* truth(size_t problem) const { return truth_.data() + problem * truth_slots_; }

  // Mean and standard error of one band of one problem.
  void estimate(size_t problem, size_t band, double& mean, double& standard_error) const;

 private:
  size_t bands_;
  int scrambles_;
  std::vector<double> sums_;     // [problem][scramble][band]
  std::vector<uint32_t> paths_, failures_;
  std::vector<float> truncated_, largest_;
  size_t truth_slots_;
  std::vector<double> truth_;    // [problem][slot]
};

// A rectangle of problems that run together.
struct Block {
  uint32_t column = 0, row = 0, columns = 0, rows = 0;
};
// Square blocks (8 x 8) that cover a capture, row by row.
std::vector<Block> blocks_of(const Capture& capture);

class Pipeline {
 public:
  // Keeps references; all must outlive it.
  Pipeline(const Surface& surface, const Optics& optics, const Environment& environment, const SpectralState& state,
           const BandProjection& projection, size_t reference_band, const TruthPlan& truth, const PipelineOptions& options);
  ~Pipeline();

  // Runs the samples [from, to[problem]) of each problem of a block and adds them to the accumulators; sample s goes to
  // scramble s % scrambles. Problems whose `to` is not above `from` are left alone. Thread-safe for distinct blocks.
  void run(const Sensor& sensor, const Capture& capture, uint64_t capture_id, const Block& block, uint32_t from,
           std::span<const uint32_t> to, Accumulators& sums, RunStatistics& statistics) const;

 private:
  const Surface& surface_;
  const Optics& optics_;
  const Environment& environment_;
  const SpectralState& state_;
  const BandProjection& projection_;
  size_t reference_band_;
  const TruthPlan& truth_;
  PipelineOptions options_;
  // Working memory goes from block to block; as many as threads have been at work at once.
  struct Workspace;
  std::unique_ptr<Workspace> borrow(size_t width) const;
  mutable std::mutex mutex_;
  mutable std::vector<std::unique_ptr<Workspace>> idle_;
};

}  // namespace suite
