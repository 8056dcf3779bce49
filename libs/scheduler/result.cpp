#include "scheduler/result.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace suite {

CaptureResult to_result(const Capture& capture, const Accumulators& sums, size_t bands, size_t channels,
                        size_t reference_band, const TruthPlan& truth) {
  CaptureResult r;
  r.columns = capture.columns;
  r.rows = capture.rows;
  r.bands = bands;
  r.channels = channels;
  r.time_bins = capture.time_bins;
  r.truth_names = truth.columns();
  const size_t n = capture.problems(), values = r.values_per_problem();
  r.radiance.resize(n * values);
  r.standard_error.resize(n * values);
  r.paths.resize(n);
  r.quality.resize(n);
  r.truth.resize(n * r.truth_names.size());
  for (size_t i = 0; i < n; ++i) {
    for (size_t b = 0; b < values; ++b)
      sums.estimate(i, b, r.radiance[i * values + b], r.standard_error[i * values + b]);
    r.paths[i] = sums.paths(i);
    const double mean = r.radiance[i * values + reference_band];
    // One sample that carries a tenth of a problem's sum: too few such events were seen for the interval to be trusted.
    if (sums.paths(i) >= 16 && sums.largest(i) > 0.1 * mean * sums.paths(i)) r.quality[i] |= quality_heavy_tail;
    if (sums.failures(i)) r.quality[i] |= quality_failures;
    if (sums.truncated(i) > 0.01f * static_cast<float>(sums.paths(i))) r.quality[i] |= quality_truncated;
    truth.finish(sums.truth(i), sums.paths(i), r.truth.data() + i * r.truth_names.size());
  }
  r.error_correlation = error_correlation(sums, bands);
  return r;
}

std::vector<double> error_correlation(const Accumulators& sums, size_t bands) {
  const size_t n = sums.problems(), step = std::max<size_t>(1, n / 4096);
  std::vector<double> products(bands * bands, 0.0), means(bands), deviation(bands);
  for (size_t i = 0; i < n; i += step) {
    double error = 0;
    for (size_t b = 0; b < bands; ++b) sums.estimate(i, b, means[b], error);
    for (int s = 0; s < sums.scrambles(); ++s) {
      const uint32_t count = dealt(sums.paths(i), static_cast<uint32_t>(s));
      if (!count) continue;
      for (size_t b = 0; b < bands; ++b) deviation[b] = means[b] > 0 ? sums.sums(i, s)[b] / count / means[b] - 1 : 0;
      for (size_t a = 0; a < bands; ++a)
        for (size_t b = a; b < bands; ++b) products[a * bands + b] += deviation[a] * deviation[b];
    }
  }
  std::vector<double> correlation(bands * bands, 0.0);
  for (size_t a = 0; a < bands; ++a)
    for (size_t b = a; b < bands; ++b) {
      const double scale = std::sqrt(products[a * bands + a] * products[b * bands + b]);
      correlation[a * bands + b] = correlation[b * bands + a] = a == b      ? 1
                                                                : scale > 0 ? products[a * bands + b] / scale
                                                                            : 0;
    }
  return correlation;
}

void ErrorHistogram::add(double relative_error) {
  const double octave = std::log2(std::max(relative_error, 1e-9) / 1e-9);
  ++counts_[std::min(kBins - 1, static_cast<size_t>(octave * 64))];
  ++total_;
}

void ErrorHistogram::merge(const ErrorHistogram& o) {
  for (size_t i = 0; i < kBins; ++i) counts_[i] += o.counts_[i];
  total_ += o.total_;
}

double ErrorHistogram::median() const {
  uint64_t seen = 0;
  for (size_t i = 0; i < kBins; ++i)
    if ((seen += counts_[i]) * 2 >= total_ && total_)
      return i == 0 ? 0 : 1e-9 * std::exp2((static_cast<double>(i) + 0.5) / 64);
  return 0;
}

}  // namespace suite
