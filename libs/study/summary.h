// What the rows of a study say together: error against budget with its scatter and slope, bias, coverage, efficiency.
#pragma once
#include <string>
#include <vector>

#include "study/rows.h"

namespace suite {

struct StudyPoint {
  double budget = 0;
  int runs = 0;
  double seconds = 0, paths = 0;  // means: rendering time; paths of a run
  double rmse = 0, low = 0,
         high = 0;                  // geometric mean, and its 95 % interval over the seeds (Student; equal = one run)
  double bias = 0, bias_error = 0;  // mean over the seeds; the reference's part is not averaged away
  double bias_p = 1;                // two-sided
  double coverage = 0;              // share of the counted problems of all runs; NaN when none was counted
  double zero_share = 0, flagged_share = 0;
  double exceeding_share = 0;  // errors beyond what a missing flag promises
  double found_share = 0;      // of these, flagged; NaN when there was none
  double false_share = 0;      // flagged, and the error within the promise
  double efficiency = 0, rays_per_second = 0, paths_per_second = 0;
  double share_in_embree = 0, share_sample = 0, share_shade = 0, share_sensor = 0, build_seconds = 0, file_seconds = 0;
};
struct StudySeries {
  std::string name;
  bool by_time = false;
  std::vector<StudyPoint> points;  // budgets ascending
  // Slope of log error against log seconds and log paths, least squares over the runs, with its standard error.
  double slope_seconds = 0, slope_seconds_error = 0, slope_paths = 0, slope_paths_error = 0;
};
struct StudySummary {
  std::vector<StudySeries> series;
  double smallest_p = 1;  // of all bias tests
  size_t tests = 0;
  bool unbiased = true;  // no test below 1 % family-wise (Bonferroni)
};
StudySummary summarise(const std::vector<StudyRow>& rows);

}  // namespace suite
