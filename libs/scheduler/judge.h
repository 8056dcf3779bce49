// How good the results of a job are: medians, worst problems, shares at the target, and the sentence about what ended
// it.
#pragma once
#include "estimate/error_histogram.h"
#include "scheduler/planner.h"
#include "scheduler/scheduler.h"

namespace suite {

// The bands whose errors decide about a capture, and how much stricter than theirs the strictest target is; those of
// radiance first.
std::vector<JudgedBand> judged_bands(const Sensor& sensor, const Capture& capture, const Budget& budget,
                                     const Kit::Bands& bands);

class Judge {
 public:
  // Takes a capture of a sensor (its number in the report). reference: band.
  void add(size_t sensor, const CaptureWork& work, size_t reference, const CaptureResult& result, JobReport& report,
           CaptureLog& log);
  // Fills what the report says about errors. cap: maximum of paths that a time budget is worth; 0 = none.
  void finish(const JobOptions& options, uint32_t cap, JobReport& report) const;

 private:
  // What a problem that was planned by its detector's noise took, and would take for kUsualTarget of its radiance.
  void add_to_saved(double radiance, double error, uint32_t paths);
  std::string target_text() const;
  std::string saved_text() const;

  static constexpr double kUsualTarget = 0.01;
  ErrorHistogram errors_;
  double with_target_ = 0, at_target_ = 0, at_maximum_ = 0;  // problems
  double target_ = 0, noise_target_ = 0;                     // the largest, beside radiance and beside noise
  double degree_target_ = 0;                                 // and of the degree of linear polarisation
  WorstProblem worst_degree_;                                // its error is absolute
  double paths_by_noise_ = 0, paths_by_radiance_ = 0;
};

}  // namespace suite
