// From accumulators to what a sensor receives, and the figures of merit that the report gathers on the way.
#pragma once
#include <array>
#include <string>

#include "estimate/budget.h"
#include "estimate/tails.h"
#include "scheduler/scheduler.h"
#include "scheduler/shortfall.h"
#include "spectral/band_bias.h"
#include "transport/truth/truth.h"

namespace suite {

// Degrees of freedom of the standard errors of a capture whose problems take up to so many paths: one less than
// scrambles, and what the problems beside add (pooled_errors.h).
double error_degrees(const Capture& capture, uint32_t most_paths);

// The result of a capture, taken from accumulators problem by problem, so that these need not all be there at once.
class ResultBuilder {
 public:
  // bands: of the sensor; reference_band: whose samples decide about the heavy-tail flag; goals: of the problems, kept
  // by reference; bias: what is known of the bands' bins (SpectralState::bias).
  ResultBuilder(const Capture& capture, size_t bands, size_t channels, size_t reference_band, const TruthPlan& truth,
                const Goals& goals, std::span<const BandBias> bias = {});
  // The channels of Q and U, whose errors' covariances are to be told. Before take().
  void tell_stokes(size_t q, size_t u);
  // Takes problem `problem`, which stands at `slot` of the accumulators. Thread-safe for distinct problems.
  void take(size_t problem, const Accumulators& sums, size_t slot);
  CaptureResult finish();
  // What the results lack, as far as that is known.
  Shortfall shortfall() const { return shortfall_of(lacks_); }

 private:
  Lack lack_of(size_t problem, const Accumulators& sums, size_t slot) const;
  std::vector<TailSums> tail_sums() const;  // with errors as the scrambles tell them
  void pool(std::span<const TailSums> tails);
  void widen();
  void add_bias();
  void flag_unknown(std::span<const TailSums> tails);
  std::vector<float> deviations(const Accumulators& sums, size_t slot, const double* means) const;
  void correlate();
  void take_stokes(size_t problem, const Accumulators& sums, size_t slot);
  size_t stokes_[3] = {0, 0, 0};  // channels of I, Q, U; of Q 0: none
  CaptureResult result_;
  std::vector<double> scatter_;             // [problem] variance of the mean if samples were independent
  std::vector<Lack> lacks_;                 // [problem]
  std::vector<std::vector<double>> light_;  // [problem] what its means lack; empty = nothing
  size_t reference_band_, correlated_every_;
  bool neighbours_;  // problems beside each other look at neighbouring places
  const TruthPlan& truth_;
  const Goals& goals_;
  std::vector<BandBias> bias_;
  std::vector<float> largest_;  // sample of each problem
  std::vector<uint8_t> empty_;  // [problem] no sample was accepted
  // The bands' deviations from their means, relative, of the scrambles of every so many problems (1024 at most):
  // [scramble][band], one behind the other. All bands ride on the same paths, so they err together. Kept per problem,
  // because sums of their products must not depend on who comes first.
  std::vector<std::vector<float>> deviations_;
};

}  // namespace suite
