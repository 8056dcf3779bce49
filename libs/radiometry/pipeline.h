// The radiometry pipeline (paper, section IV-A): each pass takes a few rays of each of a few neighbouring problems,
// constructs their paths, and turns the paths into radiance, which is added to the problems' accumulators.
#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <mutex>
#include <span>
#include <vector>

#include "light/environment.h"
#include "radiometry/path.h"
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

// Samples are dealt to independent scrambles of the sequence, from whose spread the standard error comes. The rule
// depends on the sample's number alone, so that a run that is continued deals like one that never stopped: four
// scrambles share the first 256 samples, four more the next 256, all eight take turns from there on.
struct Deal {
  uint32_t scramble, index;
};
constexpr Deal deal(uint32_t sample) {
  if (sample < 256) return {sample % 4, sample / 4};
  if (sample < 512) return {4 + sample % 4, (sample - 256) / 4};
  return {sample % 8, 64 + (sample - 512) / 8};
}
// How many of the first n samples went to a scramble.
constexpr uint32_t dealt(uint32_t n, uint32_t scramble) {
  const uint32_t begin = scramble < 4 ? 0 : 256, lane = scramble % 4;
  const uint32_t early = n <= begin ? 0 : n - begin < 256 ? n - begin : 256;
  const uint32_t late = n > 512 ? n - 512 : 0;
  return (early + 3 - lane) / 4 + (late + 7 - scramble) / 8;
}

struct RunStatistics {
  uint64_t paths = 0, nodes = 0, failures = 0;
  double truncated = 0;  // sum over paths of the throughput cut at max_nodes
  TraceStatistics trace;
  uint64_t cycles = 0;         // all cycles spent in run(), all threads; of these:
  uint64_t sensor_cycles = 0;  // asking the sensor for rays
  uint64_t path_cycles = 0;    // building paths, the ray tracer (trace.cycles) included
  uint64_t shade_cycles = 0;   // turning paths into radiance and truth, adding up
  void merge(const RunStatistics& o);
};

// Accumulators of the problems of one capture. Sums are kept per independent scramble, which is where standard errors
// come from. bands: values a problem ([channel][bin][band]); truth_slots: doubles of truth a problem; missing: light
// may be lost (lost_light.h), and what is known of it is kept.
class Accumulators {
 public:
  Accumulators(size_t problems, size_t bands, int scrambles, size_t truth_slots = 0, bool missing = false);
  // Number of scrambles that `paths` samples are dealt to.
  static int scrambles_for(uint32_t paths) { return paths > 256 ? 8 : 4; }

  int scrambles() const { return scrambles_; }
  size_t bands() const { return bands_; }
  size_t problems() const { return paths_.size(); }
  double* sums(size_t problem, int scramble) {
    return &sums_[(problem * static_cast<size_t>(scrambles_) + static_cast<size_t>(scramble)) * bands_];
  }
  const double* sums(size_t problem, int scramble) const {
    return &sums_[(problem * static_cast<size_t>(scrambles_) + static_cast<size_t>(scramble)) * bands_];
  }
  uint32_t paths(size_t problem) const { return paths_[problem]; }
  void set_paths(size_t problem, uint32_t n) { paths_[problem] = n; }
  // Rejected samples: of one scramble, of all.
  uint32_t& failures(size_t problem, int scramble) {
    return failures_[problem * static_cast<size_t>(scrambles_) + static_cast<size_t>(scramble)];
  }
  uint32_t failures(size_t problem, int scramble) const {
    return failures_[problem * static_cast<size_t>(scrambles_) + static_cast<size_t>(scramble)];
  }
  uint32_t failures(size_t problem) const;
  // Samples that were averaged in: of one scramble, of all.
  uint32_t accepted(size_t problem, int scramble) const {
    return dealt(paths_[problem], static_cast<uint32_t>(scramble)) - failures(problem, scramble);
  }
  uint32_t accepted(size_t problem) const { return paths_[problem] - failures(problem); }
  float& truncated(size_t problem) { return truncated_[problem]; }
  float truncated(size_t problem) const { return truncated_[problem]; }
  // What single samples are at the reference band (of the first bin): the largest of them, for the tail indicator, and
  // the sum of their squares, from which their scatter follows.
  void note_sample(size_t problem, double value) {
    largest_[problem] = std::max(largest_[problem], static_cast<float>(value));
    squares_[problem] += value * value;
  }
  float& largest(size_t problem) { return largest_[problem]; }
  float largest(size_t problem) const { return largest_[problem]; }
  double& squares(size_t problem) { return squares_[problem]; }
  double squares(size_t problem) const { return squares_[problem]; }
  // The variance that the mean of a problem would have at the reference band if its accepted samples were independent:
  // their variance over their number; 0 for fewer than two. mean: of the reference band.
  double scatter(size_t problem, double mean) const;
  // Light that samples are known to have missed, with what they carried. light: its sums, bands() values. reference:
  // its sum at the reference band, and that of its squares over the chance of having met it, which is the square that
  // meeting it by chance would have summed to; infinite where nothing but an explicit sample finds it.
  struct Missing {
    double* light;
    double* reference;
    double* square;
  };
  bool keeps_missing() const { return !missing_of_.empty(); }
  Missing missing(size_t problem) {
    return {&missing_[problem * bands_], &missing_of_[2 * problem], &missing_of_[2 * problem + 1]};
  }
  const double* missing_light(size_t problem) const { return &missing_[problem * bands_]; }
  // Its reference and its square, side by side with those of the next problem.
  const double* missing_of(size_t problem) const { return &missing_of_[2 * problem]; }
  // How much lower than they should be the means of a problem are, as far as that is known.
  //
  // cut: what is cut at the maximum number of nodes, relative to the mean. A share T of the throughput is cut where
  // paths end; if what lies beyond shines as the problem itself does, L = mean + T L and the mean lacks T / (1 - T) of
  // itself. That is exact where every node sees the same light (cavities, isothermal boxes), too much where paths lose
  // themselves in the dark, too little where they are on their way to the light. T is known at the reference
  // wavelength and taken for all bands; 0.999 at most, where paths lose nothing at all.
  // missing: what of the missing light (per value, missing_light() / accepted()) counts. Meeting it by chance h times
  // has a relative error of 1 / sqrt(h); with h expected meetings less than one, all of it is likely to be missing:
  // min(1, 1 / sqrt(h)). From kEnoughMeetings on the samples themselves tell their error, and 0 counts.
  struct Shortfall {
    double cut = 0, missing = 0;
  };
  static constexpr double kEnoughMeetings = 20;
  Shortfall shortfall(size_t problem) const;
  // What the means of a problem, bands() values, are known to lack, value by value; empty when that is nothing.
  std::vector<double> lacking(size_t problem, std::span<const double> means) const;
  size_t truth_slots() const { return truth_slots_; }
  double* truth(size_t problem) { return truth_.data() + problem * truth_slots_; }
  const double* truth(size_t problem) const { return truth_.data() + problem * truth_slots_; }

  // Mean and standard error of one band of one problem. The variance of the mean, sum of (share^2 variance) over the
  // scrambles, is estimated without bias for any shares and variances of the scrambles below one half each:
  //   V = sum a_s d_s^2 / (1 + sum a_s),  a = share^2 / (1 - 2 share),  d = deviation of the scramble's mean,
  // because E[d_s^2] = (1 - 2 share_s) variance_s + V. Infinite when fewer than two scrambles have samples. Means and
  // shares are those of accepted samples.
  void estimate(size_t problem, size_t band, double& mean, double& standard_error) const;
  // The same for all values of a problem at once; spans of bands() values.
  void estimate(size_t problem, std::span<double> means, std::span<double> standard_errors) const;
  // Forgets everything.
  void clear();

 private:
  size_t bands_;
  int scrambles_;
  std::vector<double> sums_;                // [problem][scramble][band]
  std::vector<uint32_t> paths_, failures_;  // [problem], [problem][scramble]
  std::vector<float> truncated_, largest_;
  std::vector<double> squares_;
  std::vector<double> missing_, missing_of_;  // [problem][band], [problem][reference, square]
  size_t truth_slots_;
  std::vector<double> truth_;  // [problem][slot]
};

// A rectangle of problems that run together.
struct Block {
  uint32_t column = 0, row = 0, columns = 0, rows = 0;
};
// Square blocks that cover a capture, row by row.
inline constexpr uint32_t kBlockEdge = 8;
std::vector<Block> blocks_of(const Capture& capture);

// Where the accumulators of a block's problems stand: at their own numbers, for accumulators of a whole capture, or at
// their places in the block, for accumulators of one block.
enum class Slots : uint8_t { by_problem, by_place };

class Pipeline {
 public:
  // Keeps references; all must outlive it.
  Pipeline(const Surface& surface, const Optics& optics, const Environment& environment, const SpectralState& state,
           const BandProjection& projection, size_t reference_band, const TruthPlan& truth,
           const PipelineOptions& options);
  ~Pipeline();

  // Continues each problem of a block from the paths that its accumulators hold up to to[problem]. Thread-safe for
  // distinct blocks.
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
