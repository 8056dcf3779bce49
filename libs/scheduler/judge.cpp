#include "scheduler/judge.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "sensor/quality.h"

namespace suite {

std::vector<JudgedBand> judged_bands(const Capture& capture, const Budget& budget, const Kit::Bands& bands) {
  if (!capture.detector_noise.empty() && !budget.relative_error) {
    std::vector<JudgedBand> judged;
    for (size_t b = 0; b < capture.detector_noise.size(); ++b)
      if (const BandNoise& noise = capture.detector_noise[b]; noise.constant > 0 || noise.linear > 0)
        judged.push_back({b, 1, noise});
    return judged;
  }
  const std::vector<double>& targets = capture.band_targets;
  if (targets.empty() && !budget.all_bands) return {{bands.reference}};
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

void Judge::add(size_t sensor, const CaptureWork& work, size_t reference, const CaptureResult& r, JobReport& report,
                CaptureLog& log) {
  const size_t values = r.values_per_problem();
  report.quality[sensor].counts.add(r.quality);
  ErrorHistogram errors;
  for (size_t i = 0; i < work.capture.problems(); ++i) {
    if (const double mean = r.radiance[i * values + reference]; mean > 0)
      errors.add(r.standard_error[i * values + reference] / mean);
    double worst = 0;
    const Convergence goal = work.goals.of(i);
    for (const JudgedBand& judge : work.judged) {
      const double square = judge.square_scale(r.radiance[i * values + judge.band], goal.absolute_floor);
      if (square > 0)
        worst = std::max(worst, std::sqrt(judge.weight / square) * r.standard_error[i * values + judge.band]);
    }
    if (worst > report.worst.relative_error)
      report.worst = {work.sensor.name(), work.capture.name, static_cast<uint32_t>(i % work.capture.columns),
                      static_cast<uint32_t>(i / work.capture.columns), worst};
    if (!(goal.relative_error > 0)) continue;
    if (!work.judged.empty() && work.judged.front().noise) {
      add_to_saved(r.radiance[i * values + reference], r.standard_error[i * values + reference], r.paths[i]);
      noise_target_ = std::max(noise_target_, goal.relative_error);
    } else {
      target_ = std::max(target_, goal.relative_error);
    }
    with_target_ += 1;
    at_target_ += worst <= goal.relative_error ? 1 : 0;
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
  std::string s = "stopped by the plan for ";
  if (target_ > 0) s += strf("a target of %g %%", 100 * target_);
  if (noise_target_ > 0)
    s += strf("%sa standard error of %g %% of the detectors' noise", target_ > 0 ? " and " : "", 100 * noise_target_);
  return s;
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
  const WorstProblem& w = report.worst;
  if (w.relative_error > 0)
    s += strf("; the worst is column %u, row %u of '%s' with %.2g %%", w.column, w.row, w.capture.c_str(),
              100 * w.relative_error);
}

}  // namespace suite
