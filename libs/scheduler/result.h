// From accumulators to what a sensor receives, and the figures of merit that the report gathers on the way.
#pragma once
#include <array>
#include <string>

#include "radiometry/truth/truth.h"
#include "scheduler/budget.h"
#include "scheduler/scheduler.h"
#include "scheduler/shortfall.h"

namespace suite {

// The result of a capture, taken from accumulators problem by problem, so that these need not all be there at once.
class ResultBuilder {
 public:
  // bands: of the sensor; reference_band: whose samples decide about the heavy-tail flag; goals: of the problems, kept
  // by reference.
  ResultBuilder(const Capture& capture, size_t bands, size_t channels, size_t reference_band, const TruthPlan& truth,
                const Goals& goals);
  // Takes problem `problem`, which stands at `slot` of the accumulators. Thread-safe for distinct problems.
  void take(size_t problem, const Accumulators& sums, size_t slot);
  CaptureResult finish();
  // What the results lack, as far as that is known.
  Shortfall shortfall() const { return shortfall_of(lacks_); }

 private:
  Lack lack_of(size_t problem, const Accumulators& sums, size_t slot) const;
  void flag_tails();
  void correlate(const Accumulators& sums, size_t slot, const double* means, std::vector<double>& products) const;
  CaptureResult result_;
  std::vector<double> sampled_error_;  // [problem] standard error at the reference band, as the samples tell it
  std::vector<Lack> lacks_;            // [problem]
  size_t reference_band_, correlated_every_;
  bool neighbours_;  // problems beside each other look at neighbouring places
  const TruthPlan& truth_;
  const Goals& goals_;
  std::vector<float> largest_;  // sample of each problem
  // Products of the bands' deviations, summed over the scrambles of every so many problems (1024 at most): all bands
  // ride on the same paths, so they err together. Kept per problem, because sums must not depend on who comes first.
  std::vector<std::vector<double>> products_;
};

// Medians of relative errors without keeping them: a histogram over 1e-9 .. 1e3, 64 bins an octave, so within 1.1 %.
class ErrorHistogram {
 public:
  void add(double relative_error);
  void merge(const ErrorHistogram& o);
  double median() const;  // 0 when empty

 private:
  static constexpr size_t kBins = 64 * 40;
  std::array<uint64_t, kBins> counts_{};
  uint64_t total_ = 0;
};

}  // namespace suite
