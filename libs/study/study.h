// Drives a study: which runs, in which order, against which reference, and what comes out of them.
#pragma once
#include <functional>
#include <string>
#include <vector>

#include "base/json.h"
#include "page/page.h"
#include "scheduler/scheduler.h"
#include "study/rows.h"
#include "study/summary.h"

namespace suite {

struct StudyPlan {
  bool by_time = false;
  std::vector<double> budgets;  // paths a problem, or seconds; ascending
  int seeds = 4;                // runs at each budget: seeds first_seed, first_seed + 1, ...
  uint64_t first_seed = 1;
  static constexpr double kReferenceFactor = 32;  // budget of the reference run by the largest of the candidates
  static constexpr uint64_t kReferenceSeed = 0x7265666572ull;
};
// "4,8,16" paths or "1s,2s,4s". Error: not ascending, zero, negative, mixed, more than 32.
StudyPlan plan_of(const std::string& budgets, long long seeds, uint64_t first_seed);
// Paths a problem and seconds that the plan takes at least: what is known before anything runs.
double forecast_paths_per_problem(const StudyPlan& plan, bool with_reference);

// One run of the whole simulation.
struct StudyRun {
  Budget budget;
  uint64_t seed = 0;
  bool reference = false;  // never with a stop rule that is biased
};
struct StudyOutput {
  StudyImage image;
  JobReport report;
  double file_seconds = 0, peak_bytes = 0;
};

struct StudyTools {
  std::function<StudyOutput(const StudyRun&)> run;
  std::function<void(const std::vector<StudyRow>&)> save;  // after every run
  std::function<void(double fraction_done, const std::string& what)> progress;
};

StudyRun reference_run(const StudyPlan& plan);
// Runs what `rows` does not hold yet and adds to it. Error as compare.
void run_study(const StudyPlan& plan, const StudyImage& reference, const StudyTools& tools,
               std::vector<StudyRow>& rows);

// The three results besides the CSV.
Page page_of(const StudySummary& summary, const std::vector<StudyRow>& rows, const std::string& title,
             const std::vector<std::string>& paragraphs);
Json json_of(const StudySummary& summary, const std::vector<StudyRow>& rows);

}  // namespace suite
