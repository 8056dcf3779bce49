#include "study/summary.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "math/stats.h"

namespace suite {

namespace {

StudyPoint point_of(const std::vector<const StudyRow*>& runs) {
  StudyPoint p;
  p.budget = runs[0]->budget;
  p.runs = static_cast<int>(runs.size());
  const double n = static_cast<double>(runs.size());
  RunningStats logs;
  double scatter = 0, shared = 0, covered = 0, counted = 0, exceeding = 0, found = 0;
  for (const StudyRow* r : runs) {
    const Comparison& f = r->figures;
    const double pixels = static_cast<double>(f.counted + f.zero_variance + f.flagged);
    logs.add(std::log(std::max(f.relative_rmse, 1e-300)));
    p.seconds += r->seconds / n;
    p.paths += r->paths / n;
    p.bias += f.bias / n;
    // What a repetition has of its own, and what the reference brings to all of them.
    scatter += std::max(0.0, f.bias_error * f.bias_error - f.reference_bias_error * f.reference_bias_error) / n;
    shared = std::max(shared, f.reference_bias_error * f.reference_bias_error);
    covered += f.coverage * static_cast<double>(f.counted);
    counted += static_cast<double>(f.counted);
    p.zero_share += static_cast<double>(f.zero_variance) / pixels / n;
    p.flagged_share += static_cast<double>(f.flagged) / pixels / n;
    p.exceeding_share += static_cast<double>(f.exceeding) / pixels / n;
    p.false_share += static_cast<double>(f.flagged - f.found) / pixels / n;
    exceeding += static_cast<double>(f.exceeding);
    found += static_cast<double>(f.found);
    p.efficiency += r->efficiency() / n;
    p.rays_per_second += r->rays / r->seconds / n;
    p.paths_per_second += r->paths / r->seconds / n;
    p.share_in_embree += r->share_in_embree / n;
    p.share_sample += r->share_sample / n;
    p.share_shade += r->share_shade / n;
    p.share_sensor += r->share_sensor / n;
    p.build_seconds += r->build_seconds / n;
    p.file_seconds += r->file_seconds / n;
  }
  p.found_share = exceeding > 0 ? found / exceeding : std::numeric_limits<double>::quiet_NaN();
  p.coverage = counted > 0 ? covered / counted : std::numeric_limits<double>::quiet_NaN();
  const double wide = p.runs > 1 ? student_t_quantile(0.95, p.runs - 1) * logs.stderr_of_mean() : 0;
  p.rmse = std::exp(logs.mean());
  p.low = std::exp(logs.mean() - wide);
  p.high = std::exp(logs.mean() + wide);
  p.bias_error = std::sqrt(scatter / n + shared);
  p.bias_p = p.bias_error > 0 ? normal_two_sided(p.bias / p.bias_error) : p.bias == 0 ? 1 : 0;
  return p;
}

// Least squares of log error over log x.
void fit_slope(const std::vector<const StudyRow*>& runs, double (*x_of)(const StudyRow&), double& slope,
               double& error) {
  double n = 0, sx = 0, sy = 0, sxx = 0, sxy = 0, syy = 0;
  for (const StudyRow* r : runs) {
    const double x = std::log(x_of(*r)), y = std::log(std::max(r->figures.relative_rmse, 1e-300));
    n += 1, sx += x, sy += y, sxx += x * x, sxy += x * y, syy += y * y;
  }
  const double xx = sxx - sx * sx / n, xy = sxy - sx * sy / n, yy = syy - sy * sy / n;
  if (!(xx > 1e-12)) return;
  slope = xy / xx;
  error = n > 2 ? std::sqrt(std::max(0.0, (yy - slope * xy) / (n - 2) / xx)) : 0;
}

}  // namespace

StudySummary summarise(const std::vector<StudyRow>& rows) {
  StudySummary s;
  std::vector<std::pair<std::string, bool>> names;
  for (const StudyRow& r : rows)
    if (std::find(names.begin(), names.end(), std::pair{r.figures.series, r.by_time}) == names.end())
      names.emplace_back(r.figures.series, r.by_time);
  for (const auto& [name, by_time] : names) {
    StudySeries series;
    series.name = name;
    series.by_time = by_time;
    std::map<double, std::vector<const StudyRow*>> budgets;
    std::vector<const StudyRow*> all;
    for (const StudyRow& r : rows)
      if (r.figures.series == name && r.by_time == by_time) budgets[r.budget].push_back(&r), all.push_back(&r);
    for (const auto& [budget, runs] : budgets) {
      series.points.push_back(point_of(runs));
      ++s.tests;
      s.smallest_p = std::min(s.smallest_p, series.points.back().bias_p);
    }
    fit_slope(
        all, [](const StudyRow& r) { return r.seconds; }, series.slope_seconds, series.slope_seconds_error);
    fit_slope(
        all, [](const StudyRow& r) { return r.paths; }, series.slope_paths, series.slope_paths_error);
    s.series.push_back(std::move(series));
  }
  s.unbiased = s.smallest_p * static_cast<double>(s.tests) >= 0.01;
  return s;
}

}  // namespace suite
