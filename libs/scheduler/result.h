// From accumulators to what a sensor receives, and the figures of merit that the report gathers on the way.
#pragma once
#include <array>
#include <string>

#include "radiometry/truth/truth.h"
#include "scheduler/scheduler.h"

namespace suite {

// reference_band: whose samples decide about the heavy-tail flag. bands of the sensor, channels that were accumulated.
CaptureResult to_result(const Capture& capture, const Accumulators& sums, size_t bands, size_t channels, size_t reference_band, const TruthPlan& truth);

// Correlation of the errors of the first `bands` values of each problem, [band][band], from the deviations of the scrambles of up to 4096 problems:
// all bands ride on the same paths. 1 on the diagonal, 0 where a band has no error.
std::vector<double> error_correlation(const Accumulators& sums, size_t bands);

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
