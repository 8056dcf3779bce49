#include "study/compare.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "math/stats.h"
#include "sensor/quality.h"
#include "transport/pipeline.h"

namespace suite {

void append(StudyImage& image, const Delivery& delivery) {
  const CaptureResult& result = delivery.result;
  const bool cells = delivery.sensor.tasks()[0].captures[0].bin_by == Capture::BinBy::escape;
  const size_t values = result.values_per_problem();
  for (size_t t = 0; t < result.bins; ++t)
    for (size_t b = 0; b < result.bands; ++b) {
      std::string name = delivery.sensor.name() + ": " + delivery.bands[b].name;
      if (result.bins > 1 && !cells) name += strf(" [%zu]", t);
      auto found =
          std::find_if(image.series.begin(), image.series.end(), [&](const auto& s) { return s.name == name; });
      if (found == image.series.end()) found = image.series.insert(image.series.end(), {name, {}, {}});
      for (size_t i = 0; i < result.problems(); ++i) {
        found->radiance.push_back(result.radiance[i * values + t * result.bands + b]);
        found->standard_error.push_back(result.standard_error[i * values + t * result.bands + b]);
      }
    }
  for (size_t copy = 0; copy < (cells ? result.bins : 1); ++copy) {
    for (size_t i = 0; i < result.problems(); ++i)
      image.flagged.push_back(result.quality[i] & quality_heavy_tail ? 1 : 0);
    image.paths.insert(image.paths.end(), result.paths.begin(), result.paths.end());
  }
  image.degrees = result.error_degrees;
}

namespace {

// Quantiles of Student's distribution for 1..100 degrees of freedom, beyond that the last; between whole numbers linear
// in 1 / degrees, in which they hardly bend.
double quantile_95(double degrees) {
  static const std::vector<double> table = [] {
    std::vector<double> t;
    for (int n = 1; n <= 100; ++n) t.push_back(student_t_quantile(0.95, n));
    return t;
  }();
  degrees = std::clamp(degrees, 1.0, 100.0);
  const double low = std::min(std::floor(degrees), 99.0);
  const double share = (1 / low - 1 / degrees) / (1 / low - 1 / (low + 1));
  const auto i = static_cast<size_t>(low) - 1;
  return table[i] + share * (table[i + 1] - table[i]);
}

Comparison compare_series(const StudyImage::Series& run, const StudyImage::Series& reference, const StudyImage& image,
                          double reference_degrees) {
  const size_t n = run.radiance.size();
  Comparison c;
  c.series = run.name;
  RunningStats difference;
  double square = 0, mean = 0, reference_variance = 0;
  size_t covered = 0;
  for (size_t i = 0; i < n; ++i) {
    const double d = run.radiance[i] - reference.radiance[i], own = run.standard_error[i];
    const double theirs = reference.standard_error.empty() ? 0 : reference.standard_error[i];
    square += d * d;
    mean += reference.radiance[i];
    reference_variance += theirs * theirs;
    difference.add(d);
    const bool flagged = i < image.flagged.size() && image.flagged[i];
    const bool exceeds = std::fabs(d) > kTailFactor * own + kTailShare * std::fabs(reference.radiance[i]) + 2 * theirs;
    c.exceeding += exceeds;
    c.found += exceeds && flagged;
    if (flagged) {
      ++c.flagged;
    } else if (!(own > 0)) {
      ++c.zero_variance;
    } else {
      const double a = own * own, b = theirs * theirs;
      const double degrees = (a + b) * (a + b) / (a * a / image.degrees + b * b / reference_degrees);
      covered += std::fabs(d) <= quantile_95(degrees) * std::sqrt(a + b);
      ++c.counted;
    }
  }
  const double count = static_cast<double>(n);
  mean /= count;
  if (!(mean > 0)) throw Error("the reference of '" + run.name + "' is black: relative errors do not exist");
  c.relative_rmse = std::sqrt(square / count) / mean;
  c.bias = difference.mean() / mean;
  c.bias_error = difference.stderr_of_mean() / mean;
  c.reference_bias_error = std::sqrt(reference_variance) / count / mean;
  c.coverage = c.counted ? static_cast<double>(covered) / static_cast<double>(c.counted) : 0;
  return c;
}

}  // namespace

std::vector<Comparison> compare(const StudyImage& run, const StudyImage& reference) {
  if (run.series.size() != reference.series.size())
    throw Error(
        strf("the reference has %zu bands, the simulation gives %zu", reference.series.size(), run.series.size()));
  std::vector<Comparison> all;
  for (size_t s = 0; s < run.series.size(); ++s) {
    if (run.series[s].radiance.size() != reference.series[s].radiance.size())
      throw Error(strf("the reference has %zu pixels, the simulation gives %zu", reference.series[s].radiance.size(),
                       run.series[s].radiance.size()));
    all.push_back(compare_series(run.series[s], reference.series[s], run, reference.degrees));
  }
  return all;
}

}  // namespace suite
