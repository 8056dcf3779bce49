#include "scheduler/judge.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "sensor/degree_target.h"
#include "sensor/polarimetry.h"
#include "sensor/quality.h"

namespace suite {

namespace {

// Bands whose radiance decides.
std::vector<JudgedBand> judged_radiances(const Capture& capture, const Budget& budget, const Kit::Bands& bands) {
  if (!capture.detector_noise.empty() && !budget.relative_error) {
    std::vector<JudgedBand> judged;
    for (size_t b = 0; b < capture.detector_noise.size(); ++b)
      if (const BandNoise& noise = capture.detector_noise[b]; noise.constant > 0 || noise.linear > 0)
        judged.push_back({b, 1, noise});
    return judged;
  }
  const std::vector<double>& targets = capture.band_targets;
  // Where only the degree of polarisation has a target, the one of a budget is for radiance.
  const bool none = std::ranges::all_of(targets, [](double target) { return target == 0; });
  if ((targets.empty() || (none && budget.relative_error)) && !budget.all_bands) return {{bands.reference}};
  std::vector<JudgedBand> judged;
  for (size_t b = 0; b < bands.projection.bands(); ++b) {
    const double target = b < targets.size() ? targets[b] : 0;
    if (budget.all_bands)
      judged.push_back({b});
    else if (target > 0)
      judged.push_back({b, std::pow(capture.convergence.relative_error / target, 2)});
  }
  return judged;
}

// Standard error of the degree of linear polarisation, times the radiance.
double error_of_degree(const CaptureResult& r, size_t problem, const JudgedBand& judge) {
  const size_t first = problem * r.values_per_problem();
  const size_t values[3] = {first + judge.band, first + judge.degree->q, first + judge.degree->u};
  double S[3], error[3], C[6];
  for (size_t c = 0; c < 3; ++c) S[c] = r.radiance[values[c]], error[c] = r.standard_error[values[c]];
  covariances(r, problem, judge.band, error, C);
  return S[0] > 0 ? linear_polarisation(S, C).degree_error * S[0] : 0;
}

}  // namespace

std::vector<JudgedBand> judged_bands(const Sensor& sensor, const Capture& capture, const Budget& budget,
                                     const Kit::Bands& bands) {
  std::vector<JudgedBand> judged = judged_radiances(capture, budget, bands);
  const double degree = degree_target_of(sensor, capture);
  if (!(degree > 0)) return judged;
  const auto channels = sensor.channels();
  const size_t n = bands.projection.bands(), q = channel_of(channels, "stokes_q"), u = channel_of(channels, "stokes_u");
  SUITE_CHECK(std::max(q, u) < channels.size() && capture.bins == 1);
  const double weight = std::pow(goal_of(capture, budget).relative_error / degree, 2);
  for (size_t b = 0; b < n; ++b) judged.push_back({b, weight, {}, JudgedBand::Degree{q * n + b, u * n + b, degree}});
  return judged;
}

void Judge::add(size_t sensor, const CaptureWork& work, size_t reference, const CaptureResult& r, JobReport& report,
                CaptureLog& log) {
  const size_t values = r.values_per_problem();
  report.quality[sensor].counts.add(r.quality);
  ErrorHistogram errors;
  const double degree_goal = work.judged.empty() || !work.judged.back().degree ? 0 : work.judged.back().degree->target;
  if (work.goals.all.relative_error > 0) degree_target_ = std::max(degree_target_, degree_goal);
  for (size_t i = 0; i < work.capture.problems(); ++i) {
    if (const double mean = r.radiance[i * values + reference]; mean > 0)
      errors.add(r.standard_error[i * values + reference] / mean);
    double worst = 0, degree = 0;
    const Convergence goal = work.goals.of(i);
    for (const JudgedBand& judge : work.judged) {
      const double square = judge.square_scale(r.radiance[i * values + judge.band], goal.absolute_floor);
      if (!(square > 0)) continue;
      if (judge.degree)
        degree = std::max(degree, error_of_degree(r, i, judge) / std::sqrt(square));
      else
        worst = std::max(worst, std::sqrt(judge.weight / square) * r.standard_error[i * values + judge.band]);
    }
    const auto keep = [&](double error, WorstProblem& most) {
      if (error > most.relative_error)
        most = {work.sensor.name(), work.capture.name, static_cast<uint32_t>(i % work.capture.columns),
                static_cast<uint32_t>(i / work.capture.columns), error};
    };
    keep(worst, report.worst), keep(degree, worst_degree_);
    if (!(goal.relative_error > 0)) continue;
    if (!work.judged.empty() && work.judged.front().noise) {
      add_to_saved(r.radiance[i * values + reference], r.standard_error[i * values + reference], r.paths[i]);
      noise_target_ = std::max(noise_target_, goal.relative_error);
    } else if (!work.judged.empty() && !work.judged.front().degree) {
      target_ = std::max(target_, goal.relative_error);
    }
    with_target_ += 1;
    at_target_ += worst <= goal.relative_error && degree <= degree_goal ? 1 : 0;
    at_maximum_ += r.paths[i] >= goal.max_paths ? 1 : 0;
  }
  log.median_relative_error = errors.median();
  errors_.merge(errors);
}

void Judge::add_to_saved(double radiance, double error, uint32_t paths) {
  if (!std::isfinite(error)) return;  // of a single group of samples
  paths_by_noise_ += paths;
  // Variances fall as one over the number of paths, at the slowest.
  const double share = radiance > 0 ? error / (kUsualTarget * radiance) : 1;
  paths_by_radiance_ += paths * share * share;
}

std::string Judge::target_text() const {
  std::string s;
  const auto add = [&](const std::string& one) { s += (s.empty() ? "" : " and ") + one; };
  if (target_ > 0) add(strf("a target of %g %%", 100 * target_));
  if (noise_target_ > 0) add(strf("a standard error of %g %% of the detectors' noise", 100 * noise_target_));
  if (degree_target_ > 0) add(strf("a standard error of %g of the degree of linear polarisation", degree_target_));
  return "stopped by the plan for " + s;
}

std::string Judge::saved_text() const {
  if (!(noise_target_ > 0) || !(paths_by_noise_ > 0)) return {};
  return strf(
      "; by the detectors' noise %.3g paths were run, where a standard error of %g %% of the radiance would "
      "take %.3g (%.3g times as many)",
      paths_by_noise_, 100 * kUsualTarget, paths_by_radiance_, paths_by_radiance_ / paths_by_noise_);
}

void Judge::finish(const JobOptions& options, uint32_t cap, JobReport& report) const {
  report.median_relative_error = errors_.median();
  if (with_target_ > 0) report.share_at_target = at_target_ / with_target_;
  for (const auto& [sensor, counts] : report.quality)
    if (counts.problems)
      report.share_flagged += static_cast<double>(counts.flagged) / static_cast<double>(report.problems);
  std::string& s = report.stopped_by;
  if (report.stopped)
    s = strf("stopped from outside after %zu of %zu captures", report.captures, report.captures_asked);
  else if (options.share && options.share->runs())
    s = options.share->text() + " has run its share";
  else if (report.captures_waiting)
    s = strf("%zu of %zu captures wait for paths that other parts have to run", report.captures_waiting,
             report.captures_asked);
  else if (options.pipeline.stop == StopRule::change)
    s = strf(
        "each problem stopped when one more path changed its mean by less than %g of it, which is biased low where "
        "rare events carry the light",
        options.pipeline.change);
  else if (with_target_ > 0)
    s = strf("%s, or by its maximum of paths (%.1f %% of the problems); %.1f %% of the problems are at the target%s",
             target_text().c_str(), 100 * at_maximum_ / with_target_, 100 * report.share_at_target,
             saved_text().c_str());
  else
    s = "every problem ran the paths it was given";
  if (report.time_cap)
    s +=
        strf("; the time was worth %u paths a problem (--paths %u repeats this run)", report.time_cap, report.time_cap);
  else if (cap)
    s += strf("; at most %u paths a problem, as the time was found to be worth", cap);
  if (const WorstProblem& w = report.worst; w.relative_error > 0)
    s += strf("; the worst is column %u, row %u of '%s' with %.2g %%", w.column, w.row, w.capture.c_str(),
              100 * w.relative_error);
  if (const WorstProblem& w = worst_degree_; w.relative_error > 0)
    s += strf("; the worst degree of linear polarisation is that of column %u, row %u of '%s' with an error of %.2g",
              w.column, w.row, w.capture.c_str(), w.relative_error);
}

}  // namespace suite
