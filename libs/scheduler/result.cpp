#include "scheduler/result.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/memory.h"
#include "estimate/plan.h"
#include "estimate/pooled_errors.h"
#include "sensor/quality.h"

namespace suite {

namespace {

double degrees(uint32_t most_paths, bool neighbours) {
  const double own = scrambles_for(most_paths) - 1;
  return neighbours ? pooled_degrees(own) : own;
}

}  // namespace

double error_degrees(const Capture& capture, uint32_t most_paths) {
  return degrees(most_paths, has_neighbours(capture));
}

ResultBuilder::ResultBuilder(const Capture& capture, size_t bands, size_t channels, size_t reference_band,
                             const TruthPlan& truth, const Goals& goals, std::span<const BandBias> bias)
    : reference_band_(reference_band),
      neighbours_(has_neighbours(capture)),
      truth_(truth),
      goals_(goals),
      bias_(bias.begin(), bias.end()) {
  SUITE_CHECK(bias_.empty() || bias_.size() == bands);
  CaptureResult& r = result_;
  r.columns = capture.columns;
  r.rows = capture.rows;
  r.bands = bands;
  r.channels = channels;
  r.bins = capture.bins;
  r.truth_names = truth.columns();
  const size_t n = capture.problems(), values = r.values_per_problem();
  resize_large(r.radiance, n * values);
  resize_large(r.standard_error, n * values);
  r.paths.resize(n);
  r.quality.resize(n);
  resize_large(largest_, n);
  empty_.resize(n);
  resize_large(scatter_, n);
  light_.resize(n);
  lacks_.resize(n);
  resize_large(r.truth, n * r.truth_names.size());
  // Few enough that bands^2 products of each take neither time nor memory.
  const size_t most = std::clamp<size_t>((size_t{4} << 20) / (bands * bands), 16, 1024);
  correlated_every_ = std::max<size_t>(1, (n + most - 1) / most);
  deviations_.resize((n + correlated_every_ - 1) / correlated_every_);
}

void ResultBuilder::tell_stokes(size_t q, size_t u) {
  if (result_.bins > 1) return;
  stokes_[1] = q, stokes_[2] = u;
  resize_large(result_.stokes_covariance, result_.problems() * result_.bands * 6);
}

void ResultBuilder::take_stokes(size_t problem, const Accumulators& sums, size_t slot) {
  double* to = &result_.stokes_covariance[problem * result_.bands * 6];
  for (size_t band = 0; band < result_.bands; ++band)
    for (size_t a = 0; a < 3; ++a)
      for (size_t b = a; b < 3; ++b)
        *to++ = sums.covariance(slot, stokes_[a] * result_.bands + band, stokes_[b] * result_.bands + band);
}

void ResultBuilder::take(size_t problem, const Accumulators& sums, size_t slot) {
  CaptureResult& r = result_;
  const size_t values = r.values_per_problem();
  const std::span<double> means(&r.radiance[problem * values], values),
      errors(&r.standard_error[problem * values], values);
  sums.estimate(slot, means, errors);
  if (stokes_[1]) take_stokes(problem, sums, slot);
  empty_[problem] = sums.accepted(slot) == 0;
  if (empty_[problem]) std::fill(errors.begin(), errors.end(), INFINITY);
  scatter_[problem] = sums.scatter(slot, means[reference_band_]);
  lacks_[problem] = lack_of(problem, sums, slot);
  light_[problem] = sums.lacking(slot, means);
  const uint32_t paths = r.paths[problem] = sums.paths(slot);
  largest_[problem] = sums.largest(slot);
  uint8_t& quality = r.quality[problem];
  if (lacks_[problem].rejected) quality |= quality_failures;
  if (lacks_[problem].truncated()) quality |= quality_truncated;
  if (lacks_[problem].unresolved()) quality |= quality_unresolved;
  truth_.finish(sums.truth(slot), paths, r.truth.data() + problem * r.truth_names.size());
  if (problem % correlated_every_ == 0)
    deviations_[problem / correlated_every_] = deviations(sums, slot, &r.radiance[problem * values]);
}

Lack ResultBuilder::lack_of(size_t problem, const Accumulators& sums, size_t slot) const {
  const uint32_t accepted = sums.accepted(slot);
  const size_t first = problem * result_.values_per_problem();
  const double radiance = result_.radiance[first + reference_band_];
  Lack lack{0, 0, 0, sums.failures(slot)};
  if (radiance > 0) lack.error = result_.standard_error[first + reference_band_] / radiance;
  if (!accepted) return lack;
  const Accumulators::Shortfall of = sums.shortfall(slot);
  lack.cut = of.cut / (1 + of.cut);
  if (!(of.missing > 0)) return lack;
  // Of the bin that lacks most.
  const double* means = &result_.radiance[first];
  for (size_t at = reference_band_; at < result_.bins * result_.bands; at += result_.bands) {
    const double missing = of.missing * sums.missing_light(slot, at) / accepted;
    if (missing > 0) lack.missing = std::max(lack.missing, missing / (means[at] + missing));
  }
  return lack;
}

std::vector<float> ResultBuilder::deviations(const Accumulators& sums, size_t slot, const double* means) const {
  const size_t bands = result_.bands;
  std::vector<float> of;
  for (int s = 0; s < sums.scrambles(); ++s) {
    const uint32_t count = sums.accepted(slot, s);
    if (!count) continue;
    const double* const sum = sums.sums(slot, s);
    of.resize(of.size() + bands);
    float* const to = &of[of.size() - bands];
    for (size_t b = 0; b < bands; ++b) to[b] = means[b] > 0 ? static_cast<float>(sum[b] / count / means[b] - 1) : 0.0f;
  }
  return of;
}

std::vector<TailSums> ResultBuilder::tail_sums() const {
  const CaptureResult& r = result_;
  const size_t values = r.values_per_problem();
  std::vector<TailSums> of(r.problems());
  for (size_t i = 0; i < of.size(); ++i) {
    const Convergence goal = goals_.of(i);
    const double error = r.standard_error[i * values + reference_band_];
    of[i] = {r.radiance[i * values + reference_band_],
             error,
             error,
             largest_[i],
             r.paths[i],
             goal.relative_error > 0 ? goal.relative_error : kTailShare,
             goal.absolute_floor};
  }
  return of;
}

void ResultBuilder::pool(std::span<const TailSums> tails) {
  CaptureResult& r = result_;
  const uint32_t most = r.paths.empty() ? 0 : *std::max_element(r.paths.begin(), r.paths.end());
  r.error_degrees = degrees(most, neighbours_);
  if (!neighbours_) return;
  const std::vector<double> around = errors_around(tails, r.columns);
  pool_errors({r.columns, r.values_per_problem(), reference_band_, scatter_, around}, degrees(most, false),
              r.standard_error);
}

// What the means are known to lack enlarges the errors: the root of the sum of squares.
void ResultBuilder::widen() {
  const size_t values = result_.values_per_problem();
  for (size_t i = 0; i < light_.size(); ++i)
    for (size_t v = 0; v < light_[i].size(); ++v) {
      double& error = result_.standard_error[i * values + v];
      error = std::hypot(error, light_[i][v]);
    }
}

// So does what the bins do to bands that are not within the spectral error that is wanted, and what dark lights lack.
void ResultBuilder::add_bias() {
  const size_t bands = result_.bands;
  for (size_t b = 0; b < bias_.size(); ++b) {
    if (bias_[b].within && !(bias_[b].absolute > 0)) continue;
    for (size_t v = b; v < result_.standard_error.size(); v += bands) {
      double& error = result_.standard_error[v];
      error = std::hypot(error, bias_[b].within ? bias_[b].absolute : bias_[b].of(std::fabs(result_.radiance[v])));
    }
  }
}

// The correlation of the bands' errors.
void ResultBuilder::correlate() {
  const size_t bands = result_.bands;
  std::vector<double> sum(bands * bands, 0.0);
  for (const std::vector<float>& of : deviations_)
    for (size_t row = 0; row < of.size(); row += bands)
      for (size_t a = 0; a < bands; ++a) {
        const double own = of[row + a];
        for (size_t b = a; b < bands; ++b) sum[a * bands + b] += own * of[row + b];
      }
  std::vector<double>& correlation = result_.error_correlation;
  correlation.assign(bands * bands, 0.0);
  for (size_t a = 0; a < bands; ++a)
    for (size_t b = a; b < bands; ++b) {
      const double scale = std::sqrt(sum[a * bands + a] * sum[b * bands + b]);
      correlation[a * bands + b] = correlation[b * bands + a] = a == b ? 1 : scale > 0 ? sum[a * bands + b] / scale : 0;
    }
}

// Problems whose own samples tell nothing about their value or its error, whatever those beside them say.
void ResultBuilder::flag_unknown(std::span<const TailSums> tails) {
  constexpr double kAll = 1 - 1e-6;  // of the light, in one of the scrambles: the error is as large as the value then
  const size_t values = result_.values_per_problem();
  for (size_t i = 0; i < tails.size(); ++i) {
    const TailSums& s = tails[i];
    // (The first of several bins is not all that a problem shows.)
    const bool lone = result_.bins == 1 && s.mean > 0 && s.sampled >= kAll * s.mean;
    if (empty_[i]) std::fill_n(&result_.standard_error[i * values], values, INFINITY);
    if (lone || !std::isfinite(s.sampled)) result_.quality[i] |= quality_no_information;
  }
}

CaptureResult ResultBuilder::finish() {
  std::vector<TailSums> tails = tail_sums();
  pool(tails);
  flag_unknown(tails);
  for (size_t i = 0; i < tails.size(); ++i)
    tails[i].error = result_.standard_error[i * result_.values_per_problem() + reference_band_];
  flag_heavy_tails(tails, result_.columns, neighbours_, result_.quality);
  widen();
  add_bias();
  correlate();
  return std::move(result_);
}

}  // namespace suite
